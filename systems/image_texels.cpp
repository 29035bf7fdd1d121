#include "systems/image_texels.h"

#include <algorithm>

#include "engine/schedule/workers.h"
#include "engine/spectrum/color_mode.h"
#include "engine/spectrum/rgb_columns.h"

namespace metamer {
namespace {

constexpr uint32_t texels_per_unit = 1 << 12;  // a multiple of column_lanes

struct Fit {
  const Image& image;
  RgbKind kind;
  Column<float>& texels;
};

// One unit of texels: few enough that their columns stay in a core's cache.
void fit_unit(void* context, uint32_t, size_t unit) {
  const Fit& fit = *static_cast<Fit*>(context);
  const size_t begin = unit * texels_per_unit;
  const size_t count = std::min<size_t>(texels_per_unit, fit.texels.size() / 4 - begin);
  alignas(column_alignment) float channel[3][texels_per_unit], coefficient[3][texels_per_unit], scale[texels_per_unit];
  for (size_t i = 0; i < padded_to_lanes(count); ++i) {
    const float* rgb = fit.image.rgb.data() + 3 * (begin + std::min(i, count - 1));
    scale[i] = fit.kind == RgbKind::albedo ? 1 : 2 * std::max({rgb[0], rgb[1], rgb[2], 0.0f});
    for (int c = 0; c < 3; ++c) channel[c][i] = scale[i] > 0 ? rgb[c] / scale[i] : 0.0f;
  }
  rgb_to_sigmoid(fit.image.color_space, {channel[0], channel[1], channel[2]},
                 {coefficient[0], coefficient[1], coefficient[2]}, count);
  for (size_t i = 0; i < count; ++i) {
    float* texel = fit.texels.data() + 4 * (begin + i);
    for (int c = 0; c < 3; ++c) texel[c] = coefficient[c][i];
    texel[3] = scale[i];
  }
}

// RGB mode: the three coefficients and 0. As for spectra, negative channels of the image count as 0, and an albedo's
// coefficients are from 0 to 1.
void store_coefficients(const Image& image, RgbKind kind, ColorMode color, Column<float>& texels) {
  const Matrix3 matrix = image_to_coefficients(color, image.color_space);
  const bool is_albedo = kind == RgbKind::albedo;
  for (size_t texel = 0; texel < texels.size() / 4; ++texel) {
    Color3 rgb;
    for (size_t c = 0; c < 3; ++c) rgb[c] = std::max(double{image.rgb[3 * texel + c]}, 0.0);
    const Color3 coefficients = multiply(matrix, rgb);
    for (size_t c = 0; c < 3; ++c)
      texels[4 * texel + c] = static_cast<float>(is_albedo ? std::clamp(coefficients[c], 0.0, 1.0) : coefficients[c]);
    texels[4 * texel + 3] = 0;
  }
}

}  // namespace

float pixel_number(const float* rgb, float alpha, TextureChannel channel) {
  switch (channel) {
    case TextureChannel::red: return rgb[0];
    case TextureChannel::green: return rgb[1];
    case TextureChannel::blue: return rgb[2];
    case TextureChannel::alpha: return alpha;
    case TextureChannel::average: break;
  }
  return (rgb[0] + rgb[1] + rgb[2]) / 3;
}

Column<float> image_texels(const Image& image, RgbKind kind, ColorMode color) {
  const size_t count = size_t{image.width} * image.height;
  Column<float> texels;
  texels.resize(4 * count);
  if (color != ColorMode::spectral) {
    store_coefficients(image, kind, color, texels);
    return texels;
  }
  Fit fit{image, kind, texels};
  run_units(available_threads(), (count + texels_per_unit - 1) / texels_per_unit, Cancellation(), fit_unit, &fit);
  return texels;
}

}  // namespace metamer
