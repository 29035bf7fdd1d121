// RGB to spectrum for many colours at once, as images need it.
#pragma once
#include <cstddef>

#include "engine/spectrum/color.h"

namespace metamer {

struct RgbColumns {
  const float* red;
  const float* green;
  const float* blue;
};

struct SigmoidColumns {
  float* c0;
  float* c1;
  float* c2;
};

// Coefficients of the sigmoid reflectance (rgb_fit.h) of each linear colour; channels are clamped to 0..1, NaN to 0.
// Columns hold `count` rows padded to whole vectors (padded_to_lanes); rows are independent of one another.
// For sRGB the reflectance's colour under the white illuminant differs from the one asked for by less than 5e-4 times
// min(largest channel, 1 - smallest channel) + 5e-5 per linear channel (tested on a dense grid); greys are flat, black
// and white exact. In wider spaces the same holds for colours that some reflectance has; the others come out less
// saturated. The first call for a space prepares a table, up to 0.1 s; then a colour takes about 0.4 us on AVX-512.
// Thread-safe. Multiples of a colour beyond 1 ("unbounded") are the caller's scale times the reflectance.
void rgb_to_sigmoid(ColorSpace space, const RgbColumns& rgb, const SigmoidColumns& out, size_t count);

}  // namespace metamer
