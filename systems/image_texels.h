// Images as spectra: what environments and textures look up.
#pragma once
#include "engine/ecs/scene.h"

namespace metamer {

// A pixel as one number.
float pixel_number(const float* rgb, float alpha, TextureChannel channel);

// Four floats per pixel, row by row from the top. Spectral: the coefficients c0, c1, c2 of a sigmoid
// (engine/spectrum/rgb_fit.h) and a factor on it. albedo: channels are clamped to 0..1, the factor is 1. unbounded: the
// factor is twice the largest channel. On all threads; about 0.4 us a pixel and thread. RGB modes: the three
// coefficients (docs/rgb-mode.md) and 0.
Column<float> image_texels(const Image& image, RgbKind kind, ColorMode color);

}  // namespace metamer
