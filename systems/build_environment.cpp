#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/simd/portable_math.h"
#include "systems/freeze.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;

// The rotation (or mirrored one) in a matrix, by Gram and Schmidt: directions have no size to be scaled.
glm::dmat3 orthonormal(const glm::dmat3& m) {
  const glm::dvec3 x = glm::normalize(m[0]);
  const glm::dvec3 y = glm::normalize(m[1] - x * glm::dot(x, m[1]));
  const glm::dvec3 z = glm::cross(x, y);
  return {x, y, glm::dot(z, m[2]) < 0 ? -z : z};
}

// The solid angle of a row's texels, relative to the mean over the image's square.
double ring_weight(const Image& image, uint32_t y) {
  if (image.mapping != ImageMapping::latitude_longitude) return 1;
  const double top = portable::cos(pi * y / image.height), bottom = portable::cos(pi * (y + 1) / image.height);
  return (top - bottom) * image.height / 2;
}

}  // namespace

void build_environment(const Image* image, const glm::dmat4& to_world, Environment& environment) {
  const glm::dmat3 rotation = orthonormal(glm::dmat3(to_world)), inverse = glm::transpose(rotation);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      environment.to_world[3 * row + column] = static_cast<float>(rotation[column][row]);
      environment.to_local[3 * row + column] = static_cast<float>(inverse[column][row]);
    }
  if (image == nullptr) return;
  environment.mapping = image->mapping;
  std::vector<double> weights(size_t{image->width} * image->height);
  const Color3 luminance = rgb_to_xyz(image->color_space)[1];
  for (size_t texel = 0; texel < weights.size(); ++texel) {
    const float* rgb = image->rgb.data() + 3 * texel;
    const double level = luminance[0] * rgb[0] + luminance[1] * rgb[1] + luminance[2] * rgb[2];
    weights[texel] = std::max(level, 0.0) * ring_weight(*image, static_cast<uint32_t>(texel / image->width));
  }
  environment.density = make_distribution_2d(weights, image->width, image->height);
}

}  // namespace metamer
