#include "scenes/images/read_image.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/simd/portable_math.h"
#include "scenes/file_bytes.h"

namespace metamer {
namespace {

constexpr int64_t most_pixels = int64_t{1} << 31;

double decode(double encoded, const ImageEncoding& encoding) {
  if (encoding.gamma > 0) return encoding.gamma == 1 ? encoded : portable::pow(encoded, encoding.gamma);
  return encoded <= 0.04045 ? encoded / 12.92 : portable::pow((encoded + 0.055) / 1.055, 2.4);
}

// The decoded value of every code of 8 or 16 bits.
std::vector<float> decoding_table(bool is_wide, const ImageEncoding& encoding) {
  std::vector<float> table(is_wide ? 65536 : 256);
  const double last = static_cast<double>(table.size() - 1);
  for (size_t code = 0; code < table.size(); ++code)
    table[code] = static_cast<float>(decode(static_cast<double>(code) / last, encoding));
  return table;
}

// Which channels of the file are red, green and blue: by name, else the first three, or one for all of grey.
std::array<int, 3> color_channels(const OIIO::ImageSpec& spec) {
  const std::array<int, 3> named = {spec.channelindex("R"), spec.channelindex("G"), spec.channelindex("B")};
  if (named[0] >= 0 && named[1] >= 0 && named[2] >= 0) return named;
  const bool is_grey = spec.nchannels < 3;
  return is_grey ? std::array<int, 3>{0, 0, 0} : std::array<int, 3>{0, 1, 2};
}

// Of the file's alpha `nth` of each pixel's `channels` values; none where it is 1 everywhere.
std::vector<float> alpha_of(const std::vector<float>& all, size_t channels, int nth,
                            const std::vector<float>& decoded) {
  std::vector<float> alpha;
  if (nth < 0) return alpha;
  const float last_code = static_cast<float>(decoded.size()) - 1;
  bool is_one = true;
  for (size_t i = static_cast<size_t>(nth); i < all.size(); i += channels) {
    const float value = std::clamp(all[i], 0.0f, 1.0f);
    alpha.push_back(decoded.empty() ? value : decoded[static_cast<size_t>(value * last_code + 0.5f)]);
    is_one = is_one && alpha.back() == 1;
  }
  return is_one ? std::vector<float>() : alpha;
}

// The colour space whose primaries and white the file names, to a thousandth, which is what pbrt-v4 takes for the same;
// sRGB where it names none, and with a warning where it names others.
ColorSpace color_space_of(const OIIO::ImageSpec& spec, const std::string& path, Diagnostics& diagnostics) {
  float named[8];
  if (!spec.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), named)) return ColorSpace::srgb;
  for (size_t i = 0; i < color_space_count; ++i) {
    const auto space = static_cast<ColorSpace>(i);
    const Matrix3& to_xyz = rgb_to_xyz(space);
    double worst = 0;
    for (size_t c = 0; c < 4; ++c) {
      const auto [x, y] = chromaticity(c < 3 ? Color3{to_xyz[0][c], to_xyz[1][c], to_xyz[2][c]} : white_xyz(space));
      worst = std::max({worst, std::abs(x - double{named[2 * c]}), std::abs(y - double{named[2 * c + 1]})});
    }
    if (worst < 1e-3) return space;
  }
  diagnostics.warning({path, 0}, "its chromaticities are those of no known colour space; it is read as sRGB");
  return ColorSpace::srgb;
}

bool check_pixels(const Image& image, bool allows_negative, Diagnostics& diagnostics) {
  const float least = allows_negative ? -std::numeric_limits<float>::max() : 0;
  size_t count = 0, first = 0;
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    const bool good = image.rgb[i] >= least && image.rgb[i] <= std::numeric_limits<float>::max();
    if (!good && count++ == 0) first = i;
  }
  if (count == 0) return true;
  diagnostics.error(
      {image.name, 0},
      fmt::format("pixel ({}, {}) holds {}; expected finite values{} ({} such values in all)", first / 3 % image.width,
                  first / 3 / image.width, image.rgb[first], allows_negative ? "" : " of at least 0", count));
  return false;
}

}  // namespace

ImageEncoding texture_encoding(const std::string& path) {
  return {.allows_negative = true, .decodes_alpha = file_extension(path) == "png"};
}

bool read_image(const std::string& path, const SourceLocation& named_at, Image& image, Diagnostics& diagnostics,
                const ImageEncoding& encoding) {
  if (!check_readable(path, named_at, diagnostics)) return false;
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours as the file holds them, not multiplied by its alpha
  const auto input = OIIO::ImageInput::open(path, &wishes);
  const auto fail = [&](const std::string& why) {
    diagnostics.error({path, 0}, fmt::format("cannot read this as an image: {}", why));
    return false;
  };
  if (!input) return fail(OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  const int64_t pixels = int64_t{spec.width} * spec.height;
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.depth > 1 || pixels > most_pixels) {
    return fail(fmt::format("it has {} x {} pixels of {} channels", spec.width, spec.height, spec.nchannels));
  }
  const bool is_encoded =
      spec.format.basetype == OIIO::TypeDesc::UINT8 || spec.format.basetype == OIIO::TypeDesc::UINT16;
  const std::array<int, 3> channels = color_channels(spec);
  image = Image{};
  image.name = path;
  image.width = static_cast<uint32_t>(spec.width);
  image.height = static_cast<uint32_t>(spec.height);
  image.color_space = color_space_of(spec, path, diagnostics);
  const auto channel_count = static_cast<size_t>(spec.nchannels);
  std::vector<float> all;
  try {
    all.resize(static_cast<size_t>(pixels) * channel_count);
    image.rgb.resize(static_cast<size_t>(pixels) * 3);
  } catch (const std::bad_alloc&) {
    return fail(fmt::format("{} x {} pixels do not fit in memory", spec.width, spec.height));
  }
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, all.data())) return fail(input->geterror());
  std::vector<float> decoded;
  if (is_encoded) decoded = decoding_table(spec.format.basetype == OIIO::TypeDesc::UINT16, encoding);
  const float last_code = static_cast<float>(decoded.size()) - 1;
  for (size_t pixel = 0; pixel < static_cast<size_t>(pixels); ++pixel) {
    for (size_t c = 0; c < 3; ++c) {
      const float value = all[pixel * channel_count + static_cast<size_t>(channels[c])];
      image.rgb[3 * pixel + c] = is_encoded ? decoded[static_cast<size_t>(value * last_code + 0.5f)] : value;
    }
  }
  const int alpha = spec.alpha_channel >= 0 ? spec.alpha_channel : spec.channelindex("A");
  image.alpha = alpha_of(all, channel_count, alpha, encoding.decodes_alpha ? decoded : std::vector<float>());
  return check_pixels(image, encoding.allows_negative, diagnostics);
}

}  // namespace metamer
