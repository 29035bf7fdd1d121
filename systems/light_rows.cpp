#include "systems/light_rows.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/simd/portable_math.h"

namespace metamer {
namespace {

using portable::atan2, portable::cos, portable::sin;
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

double turns_of(const Geometry& geometry) { return double{geometry.phi_max_deg} / 360; }

// Area of an ellipsoid with half axes as columns, or of the part of it that is the image of the unit sphere between two
// heights and over some turns around z: the mean of its area element, by the product midpoint rule, whose error is far
// below float precision at this size for a whole ellipsoid and below 1e-5 for parts.
double ellipsoid_area(const glm::dmat3& axes, double z_min, double z_max, double turns) {
  constexpr int rings = 128, spokes = 256;
  const glm::dmat3 cofactor = glm::transpose(glm::inverse(axes)) * std::abs(glm::determinant(axes));
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double z = z_min + (i + 0.5) * (z_max - z_min) / rings, r = std::sqrt(1 - z * z);
    for (int j = 0; j < spokes; ++j) {
      const double phi = (j + 0.5) * 2 * pi * turns / spokes;
      sum += glm::length(cofactor * glm::dvec3(r * cos(phi), r * sin(phi), z));
    }
  }
  return 2 * pi * turns * (z_max - z_min) * sum / (rings * spokes);
}

// The same of a cylinder, whose axes are two radii and its height.
double cylinder_area(const glm::dmat3& axes, double turns) {
  constexpr int spokes = 4096;
  double sum = 0;
  for (int j = 0; j < spokes; ++j) {
    const double phi = (j + 0.5) * 2 * pi * turns / spokes;
    sum += glm::length(glm::cross(axes[1] * cos(phi) - axes[0] * sin(phi), axes[2]));
  }
  return 2 * pi * turns * sum / spokes;
}

void store_inverse(const glm::dmat3& axes, LightRow& row) {
  const glm::dmat3 rows = glm::transpose(glm::inverse(axes));
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) row.inverse[3 * i + k] = static_cast<float>(rows[i][k]);
}

// 2 sin^2 of half the angle: without cancellation for narrow cones.
double one_minus_cos_deg(double degrees) {
  const double s = sin(degrees * pi / 360);
  return 2 * s * s;
}
// Where a spot's falloff starts at its edge: a width of 1 - cos that no two floats differ by.
constexpr double sharpest_falloff = 1e-30;

// Half the width and height of a projection's image at unit distance.
glm::dvec2 projection_extent(const Light& light, const Image* image) {
  const double shorter = portable::tan(double{light.fov_deg} * pi / 360);
  const double aspect = image != nullptr ? static_cast<double>(image->width) / image->height : 1;
  return {shorter * std::max(aspect, 1.0), shorter * std::max(1 / aspect, 1.0)};
}

bool is_similarity(const glm::dmat3& m) {
  const double size = glm::dot(m[0], m[0]);
  const double tolerance = 1e-5 * size;
  return std::abs(glm::dot(m[1], m[1]) - size) < tolerance && std::abs(glm::dot(m[2], m[2]) - size) < tolerance &&
         std::abs(glm::dot(m[0], m[1])) < tolerance && std::abs(glm::dot(m[0], m[2])) < tolerance &&
         std::abs(glm::dot(m[1], m[2])) < tolerance;
}

}  // namespace

glm::dvec2 image_point(ImageMapping mapping, const glm::dvec3& d) {
  if (mapping == ImageMapping::latitude_longitude) {
    const double turn = atan2(d.y, d.x) / (2 * pi);
    return {turn < 0 ? turn + 1 : turn, atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z) / pi};
  }
  const double r = std::sqrt(std::max(0.0, 1 - std::abs(d.z)));
  double v = atan2(std::abs(d.y), std::abs(d.x)) * 2 / pi * r, u = r - v;
  if (d.z < 0) {
    const double folded = 1 - v;
    v = 1 - u;
    u = folded;
  }
  return {(std::copysign(u, d.x) + 1) / 2, (std::copysign(v, d.y) + 1) / 2};
}

double image_weight(const Light& light, const Image& image) {
  const glm::dvec2 half = projection_extent(light, &image);
  const Color3 luminance = rgb_to_xyz(image.color_space)[1];
  double sum = 0;
  for (uint32_t y = 0; y < image.height; ++y) {
    double ring = 1;
    if (light.kind != LightKind::area && image.mapping == ImageMapping::latitude_longitude)
      ring = (cos(pi * y / image.height) - cos(pi * (y + 1) / image.height)) * image.height / 2;
    for (uint32_t x = 0; x < image.width; ++x) {
      const float* rgb = image.rgb.data() + 3 * (size_t{y} * image.width + x);
      const double level =
          luminance[0] * double{rgb[0]} + luminance[1] * double{rgb[1]} + luminance[2] * double{rgb[2]};
      double measure = ring;
      if (light.kind == LightKind::projection) {
        // Solid angle per area at unit distance: cos^3.
        const double across = half.x * (2 * (x + 0.5) / image.width - 1),
                     up = half.y * (2 * (y + 0.5) / image.height - 1);
        const double distance2 = 1 + across * across + up * up;
        measure = 4 * half.x * half.y / (distance2 * std::sqrt(distance2));
      }
      sum += std::max(level, 0.0) * measure;
    }
  }
  const double mean = sum / (static_cast<double>(image.width) * image.height);
  const bool is_sphere = light.kind == LightKind::environment || light.kind == LightKind::goniometric;
  return is_sphere ? 4 * pi * mean : mean;
}

LightRow triangle_light(const glm::dvec3 (&vertex)[3], const glm::dvec2 (&uv)[3], const Light& light) {
  LightRow row = row_of(LightShape::triangle, light);
  const glm::dvec3 edge1 = vertex[1] - vertex[0], edge2 = vertex[2] - vertex[0];
  const glm::dvec3 cross = glm::cross(edge1, edge2);
  const double length = glm::length(cross);
  store(row.p, vertex[0]);
  store(row.axes, edge1);
  store(row.axes + 3, edge2);
  if (length > 0) store(row.normal, cross / length);
  row.area = static_cast<float>(length / 2);
  for (int c = 0; c < 2; ++c) {
    row.inverse[c] = static_cast<float>(uv[0][c]);
    for (int k = 1; k < 3; ++k) row.inverse[2 * k + c] = static_cast<float>(uv[k][c] - uv[0][c]);
  }
  return row;
}

LightRow sphere_light(const glm::dmat4& to_world, const Geometry& geometry, const Light& light) {
  const glm::dmat3 axes = glm::dmat3(to_world) * double{geometry.radius};
  const double z_min = std::clamp(double{geometry.z_min} / double{geometry.radius}, -1.0, 1.0);
  const double z_max = std::clamp(double{geometry.z_max} / double{geometry.radius}, -1.0, 1.0);
  const bool full = z_min == -1 && z_max == 1 && geometry.phi_max_deg >= 360;
  const bool round = full && is_similarity(axes);
  LightRow row = row_of(round ? LightShape::sphere : LightShape::ellipsoid, light);
  store(row.p, glm::dvec3(to_world[3]));
  for (int i = 0; i < 3; ++i) store(row.axes + 3 * i, axes[i]);
  store_inverse(axes, row);
  store(row.normal, {z_min, z_max, turns_of(geometry)});
  row.area = static_cast<float>(round ? 4 * pi * glm::dot(axes[0], axes[0])
                                      : ellipsoid_area(axes, z_min, z_max, turns_of(geometry)));
  row.normal_sign = geometry.flip_normal != 0 ? -1.0f : 1.0f;
  return row;
}

LightRow cylinder_light(const glm::dmat4& to_world, const Geometry& geometry, const Light& light) {
  LightRow row = row_of(LightShape::cylinder, light);
  const glm::dmat3 linear(to_world);
  const double radius = geometry.radius, height = double{geometry.z_max} - double{geometry.z_min};
  const glm::dmat3 axes(linear[0] * radius, linear[1] * radius, linear[2] * height);
  store(row.p, glm::dvec3(to_world * glm::dvec4(0, 0, geometry.z_min, 1)));
  for (int i = 0; i < 3; ++i) store(row.axes + 3 * i, axes[i]);
  store_inverse(axes, row);
  row.normal[2] = static_cast<float>(turns_of(geometry));
  row.area = static_cast<float>(cylinder_area(axes, turns_of(geometry)));
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
  row.inverse[0] = static_cast<float>(turns_of(geometry));
  row.area = static_cast<float>(pi * turns_of(geometry) * glm::length(glm::cross(x, y)) * (1 - inner * inner));
  row.inner = static_cast<float>(inner);
  return row;
}

LightRow abstract_light(const glm::dmat4& to_world, const Light& light, const Image* image) {
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
  } else if (light.kind == LightKind::goniometric || light.kind == LightKind::projection) {
    row.shape =
        static_cast<uint32_t>(light.kind == LightKind::goniometric ? LightShape::goniometric : LightShape::projection);
    const glm::dmat3 inverse = glm::transpose(glm::inverse(glm::dmat3(to_world)));
    for (int i = 0; i < 3; ++i) store(row.inverse + 3 * i, inverse[i]);
    if (light.kind == LightKind::projection) {
      const glm::dvec2 half = projection_extent(light, image);
      row.axes[0] = static_cast<float>(half.x);
      row.axes[1] = static_cast<float>(half.y);
    } else {
      row.mapping = static_cast<uint32_t>(image != nullptr ? image->mapping : ImageMapping::equal_area);
    }
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
    case LightShape::goniometric:
    case LightShape::projection: return 1;
    case LightShape::spot: return pi * (2 * double{row.axes[0]} - 1 / double{row.axes[1]});
    default: return 2 * pi * row.area / (double{row.cosine_power} + 2) * (row.two_sided != 0 ? 2 : 1);
  }
}

}  // namespace metamer
