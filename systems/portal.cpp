#include "systems/portal.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace metamer {

std::string_view set_portal(const glm::dvec3 (&corners)[4], Light& light) {
  constexpr double tolerance = 1e-3;  // of cosines and, relative to the diagonal, lengths: pbrt-v4's
  const glm::dvec3 x = corners[3] - corners[0], y = corners[1] - corners[0];
  const double width = glm::length(x), height = glm::length(y), diagonal = glm::length(corners[2] - corners[0]);
  if (!(width > 0 && height > 0)) return "two of its corners coincide";
  const bool is_right = std::abs(glm::dot(x, y)) <= tolerance * width * height;
  if (!is_right || !(glm::length(corners[0] + x + y - corners[2]) <= tolerance * diagonal))
    return "its corners are not those of a rectangle, one after the other";
  light.has_portal = 1;
  light.portal_corner = corners[0];
  light.portal_x = x;
  light.portal_y = y;
  return {};
}

}  // namespace metamer
