#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/schedule/workers.h"
#include "engine/simd/portable_math.h"
#include "engine/spectrum/color_mode.h"
#include "engine/spectrum/rgb_columns.h"
#include "systems/freeze.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr uint32_t texels_per_unit = 1 << 14;  // a multiple of column_lanes

// The image's channels over twice the largest of a texel, which is the texel's scale: the unbounded kind of spectrum.
struct TexelColumns {
  Column<float> channel[3], coefficient[3], scale;
};

TexelColumns split_channels(const Image& image) {
  const size_t count = size_t{image.width} * image.height;
  TexelColumns columns;
  for (int c = 0; c < 3; ++c) {
    columns.channel[c].resize(count);
    columns.coefficient[c].resize(count);
  }
  columns.scale.resize(count);
  for (size_t texel = 0; texel < count; ++texel) {
    const float* rgb = image.rgb.data() + 3 * texel;
    const float scale = 2 * std::max({rgb[0], rgb[1], rgb[2], 0.0f});
    columns.scale[texel] = scale;
    for (int c = 0; c < 3; ++c) columns.channel[c][texel] = scale > 0 ? rgb[c] / scale : 0.0f;
  }
  return columns;
}

// The rotation (or mirrored one) in a matrix, by Gram and Schmidt: directions have no size to be scaled.
glm::dmat3 orthonormal(const glm::dmat3& m) {
  const glm::dvec3 x = glm::normalize(m[0]);
  const glm::dvec3 y = glm::normalize(m[1] - x * glm::dot(x, m[1]));
  const glm::dvec3 z = glm::cross(x, y);
  return {x, y, glm::dot(z, m[2]) < 0 ? -z : z};
}

struct FitContext {
  ColorSpace space;
  TexelColumns& columns;
};

void fit_unit(void* context, uint32_t, size_t unit) {
  const FitContext& fit = *static_cast<FitContext*>(context);
  const size_t begin = unit * texels_per_unit;
  const size_t count = std::min<size_t>(texels_per_unit, fit.columns.scale.size() - begin);
  const auto& in = fit.columns.channel;
  auto& out = fit.columns.coefficient;
  rgb_to_sigmoid(fit.space, {in[0].data() + begin, in[1].data() + begin, in[2].data() + begin},
                 {out[0].data() + begin, out[1].data() + begin, out[2].data() + begin}, count);
}

// Four floats per texel: a spectrum as coefficients of a sigmoid and its scale.
void store_spectra(const Image& image, Column<float>& texels) {
  TexelColumns columns = split_channels(image);
  const size_t count = columns.scale.size();
  FitContext context{image.color_space, columns};
  run_units(available_threads(), (count + texels_per_unit - 1) / texels_per_unit, Cancellation(), fit_unit, &context);
  for (size_t texel = 0; texel < count; ++texel) {
    for (int c = 0; c < 3; ++c) texels[4 * texel + c] = columns.coefficient[c][texel];
    texels[4 * texel + 3] = columns.scale[texel];
  }
}

// RGB mode: the three coefficients and 0. As for spectra, negative channels of the image count as 0.
void store_coefficients(const Image& image, ColorMode color, Column<float>& texels) {
  const Matrix3 matrix = image_to_coefficients(color, image.color_space);
  for (size_t texel = 0; texel < texels.size() / 4; ++texel) {
    Color3 rgb;
    for (size_t c = 0; c < 3; ++c) rgb[c] = std::max(double{image.rgb[3 * texel + c]}, 0.0);
    const Color3 coefficients = multiply(matrix, rgb);
    for (size_t c = 0; c < 3; ++c) texels[4 * texel + c] = static_cast<float>(coefficients[c]);
    texels[4 * texel + 3] = 0;
  }
}

// The solid angle of a row's texels, relative to the mean over the image's square.
double ring_weight(const Image& image, uint32_t y) {
  if (image.mapping != ImageMapping::latitude_longitude) return 1;
  const double top = portable::cos(pi * y / image.height), bottom = portable::cos(pi * (y + 1) / image.height);
  return (top - bottom) * image.height / 2;
}

}  // namespace

void build_environment(const Image* image, const glm::dmat4& to_world, ColorMode color, Environment& environment) {
  const glm::dmat3 rotation = orthonormal(glm::dmat3(to_world)), inverse = glm::transpose(rotation);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      environment.to_world[3 * row + column] = static_cast<float>(rotation[column][row]);
      environment.to_local[3 * row + column] = static_cast<float>(inverse[column][row]);
    }
  if (image == nullptr) return;
  environment.width = image->width;
  environment.height = image->height;
  environment.mapping = image->mapping;
  const size_t count = size_t{image->width} * image->height;
  environment.texels.resize(4 * count);
  environment.has_coefficients = color != ColorMode::spectral;
  if (environment.has_coefficients)
    store_coefficients(*image, color, environment.texels);
  else
    store_spectra(*image, environment.texels);
  std::vector<double> weights(count);
  const Color3 luminance = rgb_to_xyz(image->color_space)[1];
  double sum = 0;
  for (size_t texel = 0; texel < count; ++texel) {
    const float* rgb = image->rgb.data() + 3 * texel;
    const double level = luminance[0] * rgb[0] + luminance[1] * rgb[1] + luminance[2] * rgb[2];
    weights[texel] = std::max(level, 0.0) * ring_weight(*image, static_cast<uint32_t>(texel / image->width));
    sum += weights[texel];
  }
  environment.mean_luminance = sum / static_cast<double>(count);
  environment.density = make_distribution_2d(weights, image->width, image->height);
}

}  // namespace metamer
