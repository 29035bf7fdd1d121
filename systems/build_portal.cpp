#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <vector>

#include "engine/schedule/workers.h"
#include "engine/simd/portable_math.h"
#include "systems/build_light_images.h"
#include "systems/light_rows.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr uint32_t least_side = 64, most_places = 8;

struct AngleGrid {
  const Image* image;
  ImageMapping mapping;
  glm::dmat3 to_image;    // from the portal's frame
  uint32_t side, places;  // cells of the square of angles, places per cell, both in each direction
  std::vector<double> weights;
};

double luminance_at(const Image& image, ImageMapping mapping, const glm::dvec3& direction) {
  const glm::dvec2 at = image_point(mapping, direction);
  const auto x = std::min(static_cast<uint32_t>(std::max(at.x, 0.0) * image.width), image.width - 1);
  const auto y = std::min(static_cast<uint32_t>(std::max(at.y, 0.0) * image.height), image.height - 1);
  const float* rgb = image.rgb.data() + 3 * (size_t{y} * image.width + x);
  const Color3 luminance = rgb_to_xyz(image.color_space)[1];
  return std::max(luminance[0] * double{rgb[0]} + luminance[1] * double{rgb[1]} + luminance[2] * double{rgb[2]}, 0.0);
}

// One row of cells: luminance times solid angle, which goes with (1 - x^2) (1 - y^2) / z per area of the square.
void fill_row(void* context, uint32_t, size_t row) {
  AngleGrid& grid = *static_cast<AngleGrid*>(context);
  const uint32_t lines = grid.side * grid.places;
  for (uint32_t line = 0; line < lines; ++line) {
    const double alpha = pi * ((line + 0.5) / lines - 0.5), sin_a = portable::sin(alpha), cos_a = portable::cos(alpha);
    double& weight = grid.weights[row * grid.side + line / grid.places];
    for (uint32_t place = 0; place < grid.places; ++place) {
      const double beta = pi * ((static_cast<double>(row * grid.places + place) + 0.5) / lines - 0.5);
      const double sin_b = portable::sin(beta), cos_b = portable::cos(beta);
      const glm::dvec3 d = glm::normalize(glm::dvec3(sin_a * cos_b, sin_b * cos_a, cos_a * cos_b));
      const double solid_angle = (1 - d.x * d.x) * (1 - d.y * d.y) / d.z;
      weight += solid_angle * (grid.image != nullptr ? luminance_at(*grid.image, grid.mapping, grid.to_image * d) : 1);
    }
  }
}

}  // namespace

void build_portal(const Light& light, const Image* image, Environment& environment) {
  Portal& portal = environment.portal;
  const glm::dvec3 x = glm::normalize(glm::dvec3(light.portal_x)), y = glm::normalize(glm::dvec3(light.portal_y));
  const glm::dvec3 rows[3] = {x, y, glm::normalize(glm::cross(x, y))};
  glm::dmat3 from_portal, to_local;
  for (int row = 0; row < 3; ++row)
    for (int c = 0; c < 3; ++c) {
      portal.frame[3 * row + c] = static_cast<float>(rows[row][c]);
      from_portal[row][c] = rows[row][c];
      to_local[c][row] = double{environment.to_local[3 * row + c]};
    }
  for (int c = 0; c < 3; ++c) portal.corner[c] = light.portal_corner[c];
  portal.width = static_cast<float>(glm::length(glm::dvec3(light.portal_x)));
  portal.height = static_cast<float>(glm::length(glm::dvec3(light.portal_y)));
  AngleGrid grid{image, environment.mapping, to_local * from_portal, least_side, 1, {}};
  if (image != nullptr) {
    const uint32_t finest = std::max(image->width, image->height);
    grid.side = std::clamp(finest, least_side, max_window_side);
    grid.places = std::clamp((2 * finest + grid.side - 1) / grid.side, 2u, most_places);
  }
  grid.weights.resize(size_t{grid.side} * grid.side);
  run_units(available_threads(), grid.side, Cancellation(), fill_row, &grid);
  portal.density = make_window_distribution(grid.weights, grid.side, grid.side);
}

}  // namespace metamer
