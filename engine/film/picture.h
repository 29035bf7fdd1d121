// What the film is developed into: linear colour in some display's primaries, and its 8-bit codes.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/simd/column.h"

namespace metamer {

// Linear R G B row by row from the top left; R = G = B = 1 is the display's white at 1 cd/m^2. Values outside
// the display's gamut are negative and kept.
struct Picture {
  uint32_t width = 0;
  uint32_t height = 0;
  Column<float> r, g, b;

  size_t pixel_count() const { return size_t{width} * height; }
};

// Display-encoded codes, red | green << 8 | blue << 16 in each pixel.
struct CodedPicture {
  uint32_t width = 0;
  uint32_t height = 0;
  Column<uint32_t> codes;
};

// CIE 1931 x, y of a display's primaries and white. The default is sRGB's (IEC 61966-2-1, ITU-R BT.709).
struct Chromaticities {
  std::array<float, 2> red = {0.64f, 0.33f};
  std::array<float, 2> green = {0.30f, 0.60f};
  std::array<float, 2> blue = {0.15f, 0.06f};
  std::array<float, 2> white = {0.3127f, 0.3290f};

  bool operator==(const Chromaticities&) const = default;
};

}  // namespace metamer
