#include "scenes/images/read_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/files/image_rows.h"
#include "scenes/file_bytes.h"

namespace metamer {
namespace {

// The colour space whose primaries and white the file names, to a thousandth, which is what pbrt-v4 takes for the same;
// sRGB where it names none, and with a warning where it names others.
ColorSpace color_space_of(const ImageRows& rows, const std::string& path, Diagnostics& diagnostics) {
  if (!rows.chromaticities()) return ColorSpace::srgb;
  const std::array<float, 8>& named = *rows.chromaticities();
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

// Values that no pixel may have.
struct WrongValues {
  size_t count = 0, x = 0, y = 0;  // the first of them
  float value = 0;

  void look_for(const float* rgb, size_t width, size_t row, bool allows_negative) {
    const float least = allows_negative ? -std::numeric_limits<float>::max() : 0;
    for (size_t i = 0; i < 3 * width; ++i) {
      if (rgb[i] >= least && rgb[i] <= std::numeric_limits<float>::max()) continue;
      if (count++ > 0) continue;
      x = i / 3;
      y = row;
      value = rgb[i];
    }
  }
};

}  // namespace

ImageEncoding texture_encoding(const std::string& path) {
  return {.allows_negative = true, .decodes_alpha = file_extension(path) == "png"};
}

bool read_image(const std::string& path, const SourceLocation& named_at, Image& image, Diagnostics& diagnostics,
                const ImageEncoding& encoding, Pixels pixels) {
  if (!check_readable(path, named_at, diagnostics)) return false;
  const auto fail = [&](const std::string& why) {
    diagnostics.error({path, 0}, fmt::format("cannot read this as an image: {}", why));
    return false;
  };
  ImageRows rows;
  if (!rows.open(path, encoding)) return fail(rows.error());
  const size_t width = rows.width(), height = rows.height();
  const bool keeps = pixels == Pixels::kept;
  image = Image{};
  image.name = path;
  image.width = rows.width();
  image.height = rows.height();
  image.color_space = color_space_of(rows, path, diagnostics);
  image.is_in_file = !keeps;
  image.encoding = encoding;
  std::vector<float> one_row;
  try {
    image.rgb.resize(keeps ? 3 * width * height : 0);
    if (rows.has_alpha() && keeps) image.alpha.resize(width * height);
    one_row.resize(4 * width);
  } catch (const std::bad_alloc&) {
    return fail(fmt::format("{} x {} pixels do not fit in memory", width, height));
  }
  WrongValues wrong;
  bool has_alpha = false;
  for (size_t y = 0; y < height; ++y) {
    float* rgb = keeps ? image.rgb.data() + 3 * width * y : one_row.data();
    float* alpha = keeps && rows.has_alpha() ? image.alpha.data() + width * y : one_row.data() + 3 * width;
    if (!rows.next(rgb, alpha)) return fail(rows.error());
    wrong.look_for(rgb, width, y, encoding.allows_negative);
    if (rows.has_alpha()) has_alpha = has_alpha || std::any_of(alpha, alpha + width, [](float a) { return a != 1; });
  }
  if (!has_alpha) std::vector<float>().swap(image.alpha);
  image.file_has_alpha = has_alpha;
  if (wrong.count == 0) return true;
  diagnostics.error({path, 0},
                    fmt::format("pixel ({}, {}) holds {}; expected finite values{} ({} such values in all)", wrong.x,
                                wrong.y, wrong.value, encoding.allows_negative ? "" : " of at least 0", wrong.count));
  return false;
}

}  // namespace metamer
