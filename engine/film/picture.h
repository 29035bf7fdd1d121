// What the film is developed into: linear colour in some display's primaries, and its 8-bit codes.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/simd/column.h"

namespace metamer {

// X Y Z, cd/m^2 as the CIE 1931 observer has it, row by row from the top left.
struct XyzPicture {
  uint32_t width = 0;
  uint32_t height = 0;
  Column<float> X, Y, Z;
};

// Mean radiances of bands, W m^-2 sr^-1 nm^-1, row by row from the top left.
struct SpectralPicture {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<double> edges_nm;      // ascending, one more than bands
  std::vector<Column<float>> bands;  // a column of all pixels each
};

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
