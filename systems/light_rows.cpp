#include "systems/light_rows.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/simd/portable_math.h"

namespace metamer {
namespace {

using portable::cos, portable::sin;
constexpr double pi = 3.14159265358979323846;

LightRow row_of(LightShape shape, const Light& light) {
  LightRow row;
  row.shape = static_cast<uint32_t>(shape);
  row.spectrum = light.spectrum;
  row.scale = light.scale;
  row.two_sided = light.two_sided;
  row.cosine_power = light.cosine_power;
  return row;
}

void store(float* target, const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) target[i] = static_cast<float>(v[i]);
}

// Area of an ellipsoid with half axes as columns: the mean of its area element over the unit sphere, by the product
// midpoint rule, whose error is far below float precision at this size for smooth integrands.
double ellipsoid_area(const glm::dmat3& axes) {
  constexpr int rings = 128, spokes = 256;
  const glm::dmat3 cofactor = glm::transpose(glm::inverse(axes)) * std::abs(glm::determinant(axes));
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double z = -1 + (i + 0.5) * 2 / rings, r = std::sqrt(1 - z * z);
    for (int j = 0; j < spokes; ++j) {
      const double phi = (j + 0.5) * 2 * pi / spokes;
      sum += glm::length(cofactor * glm::dvec3(r * cos(phi), r * sin(phi), z));
    }
  }
  return 4 * pi * sum / (rings * spokes);
}

// 2 sin^2 of half the angle: without cancellation for narrow cones.
double one_minus_cos_deg(double degrees) {
  const double s = sin(degrees * pi / 360);
  return 2 * s * s;
}
// Where a spot's falloff starts at its edge: a width of 1 - cos that no two floats differ by.
constexpr double sharpest_falloff = 1e-30;

bool is_similarity(const glm::dmat3& m) {
  const double size = glm::dot(m[0], m[0]);
  const double tolerance = 1e-5 * size;
  return std::abs(glm::dot(m[1], m[1]) - size) < tolerance && std::abs(glm::dot(m[2], m[2]) - size) < tolerance &&
         std::abs(glm::dot(m[0], m[1])) < tolerance && std::abs(glm::dot(m[0], m[2])) < tolerance &&
         std::abs(glm::dot(m[1], m[2])) < tolerance;
}

}  // namespace

LightRow triangle_light(const glm::dvec3 (&vertex)[3], const Light& light) {
  LightRow row = row_of(LightShape::triangle, light);
  const glm::dvec3 edge1 = vertex[1] - vertex[0], edge2 = vertex[2] - vertex[0];
  const glm::dvec3 cross = glm::cross(edge1, edge2);
  const double length = glm::length(cross);
  store(row.p, vertex[0]);
  store(row.axes, edge1);
  store(row.axes + 3, edge2);
  if (length > 0) store(row.normal, cross / length);
  row.area = static_cast<float>(length / 2);
  return row;
}

LightRow sphere_light(const glm::dmat4& to_world, const Geometry& geometry, const Light& light) {
  const glm::dmat3 axes = glm::dmat3(to_world) * double{geometry.radius};
  const bool round = is_similarity(axes);
  LightRow row = row_of(round ? LightShape::sphere : LightShape::ellipsoid, light);
  store(row.p, glm::dvec3(to_world[3]));
  for (int i = 0; i < 3; ++i) store(row.axes + 3 * i, axes[i]);
  const glm::dmat3 inverse = glm::inverse(axes);
  for (int i = 0; i < 3; ++i) store(row.inverse + 3 * i, glm::transpose(inverse)[i]);
  row.area = static_cast<float>(round ? 4 * pi * glm::dot(axes[0], axes[0]) : ellipsoid_area(axes));
  row.normal_sign = geometry.flip_normal != 0 ? -1.0f : 1.0f;
  return row;
}

LightRow disk_light(const glm::dmat4& to_world, const Geometry& geometry, const Light& light) {
  LightRow row = row_of(LightShape::disk, light);
  const glm::dmat3 linear(to_world);
  const glm::dvec3 x = linear[0] * double{geometry.radius}, y = linear[1] * double{geometry.radius};
  const double inner = double{geometry.inner_radius} / double{geometry.radius};
  store(row.p, glm::dvec3(to_world * glm::dvec4(0, 0, geometry.height, 1)));
  store(row.axes, x);
  store(row.axes + 3, y);
  const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(linear));
  const glm::dvec3 normal = glm::normalize(normal_matrix[2]) * (geometry.flip_normal != 0 ? -1.0 : 1.0);
  store(row.normal, normal);
  row.area = static_cast<float>(pi * glm::length(glm::cross(x, y)) * (1 - inner * inner));
  row.inner = static_cast<float>(inner);
  return row;
}

LightRow abstract_light(const glm::dmat4& to_world, const Light& light) {
  const auto towards = [&] { return glm::normalize(glm::dvec3(to_world[2])); };  // light travels along -z
  LightRow row = row_of(LightShape::point, light);
  store(row.p, glm::dvec3(to_world[3]));
  if (light.kind == LightKind::spot) {
    const double cone = one_minus_cos_deg(double{light.cone_deg});
    const double width = cone - one_minus_cos_deg(double{light.falloff_deg});
    row.shape = static_cast<uint32_t>(LightShape::spot);
    store(row.normal, -towards());
    row.axes[0] = static_cast<float>(cone);
    row.axes[1] = static_cast<float>(1 / std::max(width, sharpest_falloff));
  } else if (light.kind == LightKind::directional) {
    row.shape = static_cast<uint32_t>(LightShape::directional);
    store(row.p, towards());
    if (light.angular_diameter_deg > 0) {
      // E = pi sin^2(half angle) L on a plane facing the disc.
      const double half = one_minus_cos_deg(double{light.angular_diameter_deg} / 2);
      row.shape = static_cast<uint32_t>(LightShape::distant_disk);
      row.scale = static_cast<float>(light.scale / (pi * half * (2 - half)));
      row.axes[0] = static_cast<float>(half);
    }
  } else if (light.kind == LightKind::environment) {
    row.shape = static_cast<uint32_t>(LightShape::environment);
  }
  return row;
}

bool spread_power(const Light& light, std::span<LightRow> rows) {
  double flux = 0;
  for (const LightRow& row : rows) flux += flux_per_unit(row);
  if (!(flux > 0)) return false;
  for (LightRow& row : rows) row.scale = static_cast<float>(light.scale / flux);
  return true;
}

double flux_per_unit(const LightRow& row) {
  switch (static_cast<LightShape>(row.shape)) {
    case LightShape::point: return 4 * pi;
    case LightShape::spot: return pi * (2 * double{row.axes[0]} - 1 / double{row.axes[1]});
    default: return 2 * pi * row.area / (double{row.cosine_power} + 2) * (row.two_sided != 0 ? 2 : 1);
  }
}

}  // namespace metamer
