// The only file that knows Little CMS.
#include "engine/files/icc_profile.h"

#include <lcms2.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace metamer {
namespace {

struct Close {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};
struct FreeCurve {
  void operator()(cmsToneCurve* curve) const { cmsFreeToneCurve(curve); }
};
struct FreeText {
  void operator()(cmsMLU* text) const { cmsMLUfree(text); }
};

cmsCIExyY xyY(const std::array<float, 2>& xy) { return {xy[0], xy[1], 1.0}; }

bool write_text(cmsHPROFILE profile, cmsTagSignature tag, const std::string& ascii) {
  const std::unique_ptr<cmsMLU, FreeText> text(cmsMLUalloc(nullptr, 1));
  return text && cmsMLUsetASCII(text.get(), "en", "US", ascii.c_str()) && cmsWriteTag(profile, tag, text.get());
}

}  // namespace

std::vector<uint8_t> icc_profile(const Chromaticities& display, const std::string& description) {
  // Type 4: (a x + b)^g above d, c x below.
  const double parameters[5] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  const std::unique_ptr<cmsToneCurve, FreeCurve> curve(cmsBuildParametricToneCurve(nullptr, 4, parameters));
  const cmsCIExyY white = xyY(display.white);
  const cmsCIExyYTRIPLE primaries = {xyY(display.red), xyY(display.green), xyY(display.blue)};
  cmsToneCurve* curves[3] = {curve.get(), curve.get(), curve.get()};
  const std::unique_ptr<void, Close> profile(curve ? cmsCreateRGBProfile(&white, &primaries, curves) : nullptr);
  cmsUInt32Number size = 0;
  if (!profile || !write_text(profile.get(), cmsSigProfileDescriptionTag, description) ||
      !write_text(profile.get(), cmsSigCopyrightTag, "No copyright, use freely") ||
      !cmsSaveProfileToMem(profile.get(), nullptr, &size))
    throw std::runtime_error("no ICC profile can be made of the display '" + description + "'");
  std::vector<uint8_t> bytes(size);
  if (!cmsSaveProfileToMem(profile.get(), bytes.data(), &size))
    throw std::runtime_error("the ICC profile of the display '" + description + "' cannot be written");
  // Bytes 24 to 35 of the header are year, month, day, hour, minute and second, 16 bits each.
  constexpr uint8_t date[12] = {2000 >> 8, 2000 & 255, 0, 1, 0, 1};
  std::copy(std::begin(date), std::end(date), bytes.begin() + 24);
  return bytes;
}

}  // namespace metamer
