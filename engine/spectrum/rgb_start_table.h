// A coarse table of sigmoid coefficients over hue, saturation and lightness, from which Newton's method starts.
#pragma once
#include <cstddef>
#include <vector>

#include "engine/spectrum/color.h"
#include "engine/spectrum/rgb_quadrature.h"

namespace metamer {

// HSL: hi and lo are the largest and smallest channel, lightness = (hi + lo) / 2, saturation = (hi - lo) /
// (1 - |2 lightness - 1|), hue in 0..6 with red at 0. Unlike in RGB, all colours near black and near white are spread
// out, and every kink of the map lies on a node: hue is cut at its six corners, lightness at 1/2.
inline constexpr size_t start_hues = 24;  // wraps around
inline constexpr size_t start_saturations = 12;
inline constexpr size_t start_lightnesses = 9;

// Entries are c0, c1, c2 times sqrt(hi (1 - lo)), which stays finite towards black and white and is linear in
// lightness for greys.
struct RgbStartTable {
  std::vector<float> scaled_c;  // 3 per entry, lightness fastest, then saturation, then hue
  // The sums of reduced_quadrature in single precision: t, weight of red, green, blue, one node after another.
  std::vector<float> nodes;
};

constexpr size_t start_entry(size_t hue, size_t saturation, size_t lightness) {
  return ((hue % start_hues) * start_saturations + saturation) * start_lightnesses + lightness;
}

// hue in 0..6, saturation and lightness in 0..1.
Color3 rgb_of_hsl(double hue, double saturation, double lightness);

// Made at the first call for each space.
const RgbStartTable& rgb_start_table(ColorSpace space);

}  // namespace metamer
