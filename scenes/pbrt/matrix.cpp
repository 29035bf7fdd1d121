#include "scenes/pbrt/matrix.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>
#include <string_view>

#include "engine/simd/portable_math.h"

namespace metamer::pbrt {

glm::dmat4 translation(glm::dvec3 by) {
  glm::dmat4 m(1.0);
  m[3] = glm::dvec4(by, 1.0);
  return m;
}

glm::dmat4 scaling(glm::dvec3 by) {
  glm::dmat4 m(1.0);
  for (int i = 0; i < 3; ++i) m[i][i] = by[i];
  return m;
}

std::optional<glm::dmat4> rotation(double angle_deg, glm::dvec3 axis) {
  const double length = glm::length(axis);
  if (!(length > 0)) return std::nullopt;
  const glm::dvec3 a = axis / length;
  const double radians = angle_deg * (std::numbers::pi / 180.0);
  const double s = portable::sin(radians), c = portable::cos(radians);
  glm::dmat4 m(1.0);
  for (int column = 0; column < 3; ++column) {
    glm::dvec3 e(0.0);
    e[column] = 1.0;
    m[column] = glm::dvec4(c * e + s * glm::cross(a, e) + (1.0 - c) * glm::dot(a, e) * a, 0.0);
  }
  return m;
}

std::optional<glm::dmat4> look_at(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 up) {
  const glm::dvec3 forward = target - eye;
  if (!(glm::length(forward) > 0) || !(glm::length(up) > 0)) return std::nullopt;
  const glm::dvec3 z = glm::normalize(forward);
  const glm::dvec3 right = glm::cross(glm::normalize(up), z);
  if (!(glm::length(right) > 1e-9)) return std::nullopt;
  const glm::dvec3 x = glm::normalize(right), y = glm::cross(z, x);
  glm::dmat4 m(1.0);
  for (int i = 0; i < 3; ++i) m[i] = glm::dvec4(x[i], y[i], z[i], 0.0);
  m[3] = glm::dvec4(-glm::dot(x, eye), -glm::dot(y, eye), -glm::dot(z, eye), 1.0);
  return m;
}

glm::dmat4 from_columns(std::span<const double> numbers) {
  glm::dmat4 m;
  // Homogeneous: all may be multiples of the last.
  const double w = numbers[15] != 0 ? numbers[15] : 1;
  for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = numbers[static_cast<size_t>(i)] / w;
  return m;
}

glm::dmat4 frame_of_z(glm::dvec3 w) {
  const glm::dvec3 helper = std::abs(w.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(helper, w)), y = glm::cross(w, x);
  return {glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(w, 0), glm::dvec4(0, 0, 0, 1)};
}

std::string_view transform_mistake(const glm::dmat4& m) {
  if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1) return "not affine: its last row is not 0 0 0 1";
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 3; ++row) {
      const bool finite = std::abs(m[column][row]) <= static_cast<double>(std::numeric_limits<float>::max());
      if (!finite) return "too large for single precision";
    }
  }
  const glm::dmat3 linear(m);
  const double size = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  // A determinant that is NaN or has underflown is as bad as a zero.
  if (!(std::abs(glm::determinant(linear)) > 1e-12 * size)) return "singular: it flattens space";
  return {};
}

glm::dmat4 affine_inverse(const glm::dmat4& m) {
  glm::dmat4 inverse = glm::inverse(m);
  for (int column = 0; column < 4; ++column) inverse[column][3] = column == 3 ? 1 : 0;
  return inverse;
}

Transform to_component(const glm::dmat4& m) {
  const auto row = [&](int i) {
    return glm::vec4(static_cast<float>(m[0][i]), static_cast<float>(m[1][i]), static_cast<float>(m[2][i]),
                     static_cast<float>(m[3][i]));
  };
  return {row(0), row(1), row(2)};
}

}  // namespace metamer::pbrt
