#include "tests/reference_lights.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/spectrum/rgb_fit.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double infinity = std::numeric_limits<double>::infinity();

// Clarberg 2008: the octahedron's unfolding with equal areas.
glm::dvec2 equal_area_uv(const Vector& d) {
  const double r = std::sqrt(1 - std::abs(d.z));
  const double phi = std::atan2(std::abs(d.y), std::abs(d.x)) * 2 / pi;
  double v = phi * r, u = r - v;
  if (d.z < 0) {
    const double folded = 1 - v;
    v = 1 - u;
    u = folded;
  }
  return {(std::copysign(u, d.x) + 1) / 2, (std::copysign(v, d.y) + 1) / 2};
}

// The angle of (x, y) in turns, from 0 to 1.
double turns_of(double x, double y) {
  const double turns = std::atan2(y, x) / (2 * pi);
  return turns < 0 ? turns + 1 : turns;
}

double sigmoid_at(const float* c, double lambda_nm) { return sigmoid_polynomial({c[0], c[1], c[2]}, lambda_nm); }

// The texel, or linear between the centres of four, around the circle or clamped.
Spectrum4 image_at(const World& world, uint32_t row, const glm::dvec2& uv, const Spectrum4& lambda_nm) {
  const LightImage& image = world.light_images.rows[row];
  Spectrum4 sum{};
  const auto add = [&](double x, double y, double weight) {
    const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
    int column = static_cast<int>(std::floor(x));
    const bool around = image.lookup == static_cast<uint32_t>(ImageLookup::linear_around);
    column = around ? (column + width) % width : std::clamp(column, 0, width - 1);
    const int line = std::clamp(static_cast<int>(std::floor(y)), 0, height - 1);
    const size_t at = image.first_texel + static_cast<size_t>(line) * image.width + static_cast<size_t>(column);
    const float* texel = world.light_images.texels.data() + 4 * at;
    for (size_t j = 0; j < 4; ++j) sum[j] += weight * texel[3] * sigmoid_at(texel, lambda_nm[j]);
  };
  const double x = uv.x * image.width, y = uv.y * image.height;
  if (image.lookup == static_cast<uint32_t>(ImageLookup::nearest)) {
    add(x, y, 1);
    return sum;
  }
  const double right = x - 0.5 - std::floor(x - 0.5), lower = y - 0.5 - std::floor(y - 0.5);
  add(x - 0.5, y - 0.5, (1 - right) * (1 - lower));
  add(x + 0.5, y - 0.5, right * (1 - lower));
  add(x - 0.5, y + 0.5, (1 - right) * lower);
  add(x + 0.5, y + 0.5, right * lower);
  return sum;
}

glm::dvec2 sphere_uv(ImageMapping mapping, const Vector& d) {
  if (mapping == ImageMapping::equal_area) return equal_area_uv(d);
  const double turn = std::atan2(d.y, d.x) / (2 * pi);
  return {turn < 0 ? turn + 1 : turn, std::acos(std::clamp(d.z, -1.0, 1.0)) / pi};
}

Vector times_rows(const float* rows, const Vector& v) {
  return {glm::dot(read3(rows), v), glm::dot(read3(rows + 3), v), glm::dot(read3(rows + 6), v)};
}

// Whether the ray passes through the rectangle from the side its light goes to.
bool passes(const Portal& portal, const Vector& origin, const Vector& direction) {
  const Vector x = read3(portal.frame), y = read3(portal.frame + 3), z = read3(portal.frame + 6);
  const double ahead = glm::dot(read3(portal.corner) - origin, z), along = glm::dot(direction, z);
  if (!(ahead > 0) || !(along > 0)) return false;
  const Vector at = origin + direction * (ahead / along) - read3(portal.corner);
  const double across = glm::dot(at, x), up = glm::dot(at, y);
  return across >= 0 && across <= double{portal.width} && up >= 0 && up <= double{portal.height};
}

}  // namespace

Vector reference_direction(ReferenceRandom& random) {
  const double z = 1 - 2 * random(), phi = 2 * pi * random(), r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(phi), r * std::sin(phi), z};
}

Spectrum4 reference_spectrum(const World& world, uint32_t id, const Spectrum4& lambda_nm) {
  Spectrum4 values;
  for (size_t j = 0; j < 4; ++j) values[j] = world.spectra.value(id, lambda_nm[j]);
  return values;
}
Spectrum4 reference_radiance(const World& world, const LightRow& row, const Spectrum4& lambda_nm) {
  Spectrum4 values = reference_spectrum(world, row.spectrum, lambda_nm);
  for (double& value : values) value *= row.scale;
  return values;
}

Spectrum4 reference_emission(const World& world, const LightRow& row, double cos_light, const Spectrum4& lambda_nm) {
  Spectrum4 values = reference_radiance(world, row, lambda_nm);
  for (double& value : values) value *= std::pow(std::abs(cos_light), row.cosine_power);
  return values;
}

Spectrum4 reference_disks(const World& world, const Vector& direction, const Spectrum4& lambda_nm) {
  Spectrum4 values{};
  for (const LightRow& row : world.lights) {
    if (row.shape != static_cast<uint32_t>(LightShape::distant_disk)) continue;
    const double cos = glm::dot(glm::normalize(direction), glm::normalize(read3(row.p)));
    const Spectrum4 disk = reference_radiance(world, row, lambda_nm);
    for (size_t j = 0; j < 4 && cos >= 1 - double{row.axes[0]}; ++j) values[j] += disk[j];
  }
  return values;
}

Spectrum4 reference_environment(const World& world, const Vector& origin, const Vector& direction,
                                const Spectrum4& lambda_nm) {
  Spectrum4 sum{};
  for (const Environment& e : world.environments) {
    if (e.has_portal() && !passes(e.portal, origin, direction)) continue;
    const Spectrum4 plain = reference_radiance(world, world.lights[e.light], lambda_nm);
    Spectrum4 factor{1, 1, 1, 1};
    if (e.image != no_index) {
      const Vector d = glm::normalize(times_rows(e.to_local, direction));
      factor = image_at(world, e.image, sphere_uv(e.mapping, d), lambda_nm);
    }
    for (size_t j = 0; j < 4; ++j) sum[j] += plain[j] * factor[j];
  }
  return sum;
}

Spectrum4 reference_light_image(const World& world, uint32_t light, const Vector& direction,
                                const Spectrum4& lambda_nm) {
  const LightRow& row = world.lights[light];
  const auto shape = static_cast<LightShape>(row.shape);
  const Vector local = times_rows(row.inverse, direction);
  if (shape == LightShape::goniometric)
    return image_at(world, world.image_of_light[light],
                    sphere_uv(static_cast<ImageMapping>(row.mapping), glm::normalize(local)), lambda_nm);
  if (shape != LightShape::projection) return {1, 1, 1, 1};
  const double right = local.x / (local.z * row.axes[0]), up = local.y / (local.z * row.axes[1]);
  if (!(local.z > 0) || std::abs(right) > 1 || std::abs(up) > 1) return {};
  return image_at(world, world.image_of_light[light], {(1 + right) / 2, (1 - up) / 2}, lambda_nm);
}

ReferenceLightPoint reference_light_point(const LightRow& row, const Vector& from, ReferenceRandom& random) {
  ReferenceLightPoint sample;
  const Vector p = read3(row.p), a = read3(row.axes), b = read3(row.axes + 3), c = read3(row.axes + 6);
  const auto shape = static_cast<LightShape>(row.shape);
  if (shape == LightShape::directional) return {glm::normalize(p), infinity, 1};
  if (shape == LightShape::point || shape == LightShape::goniometric || shape == LightShape::projection) {
    const double d = glm::length(p - from);
    return {(p - from) / d, d, 1 / (d * d)};
  }
  if (shape == LightShape::spot) {
    const double d = glm::length(p - from);
    const double cos = glm::dot(glm::normalize(from - p), glm::normalize(read3(row.normal)));
    const double cos_cone = 1 - double{row.axes[0]}, cos_falloff = cos_cone + 1 / double{row.axes[1]};
    const double t = std::clamp((cos - cos_cone) / (cos_falloff - cos_cone), 0.0, 1.0);
    return {(p - from) / d, d, 1 / (d * d) * t * t * (3 - 2 * t)};
  }
  if (shape == LightShape::distant_disk) {
    // Uniform by rejection from the square around the disc's projection, which cos of the angle off the axis relates to
    // solid angle.
    const double cos_edge = 1 - double{row.axes[0]}, radius = std::sqrt(1 - cos_edge * cos_edge);
    double x = 2, y = 2;
    while (x * x + y * y > radius * radius) x = radius * (2 * random() - 1), y = radius * (2 * random() - 1);
    const Vector axis = glm::normalize(p), side = std::abs(axis.x) > 0.5 ? Vector(0, 1, 0) : Vector(1, 0, 0);
    const Vector s = glm::normalize(glm::cross(side, axis)), t = glm::cross(axis, s);
    const double cos = std::sqrt(1 - x * x - y * y);
    return {axis * cos + s * x + t * y, infinity, pi * radius * radius / cos};
  }
  Vector at, area;  // the point, and the area vector per unit density
  if (shape == LightShape::triangle) {
    double u = random(), v = random();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    at = p + a * u + b * v;
    area = glm::cross(a, b) / 2.0;
    if (glm::dot(area, read3(row.normal)) < 0) area = -area;
  } else if (shape == LightShape::disk) {
    double x = 0, y = 0, r2 = 2;
    const double turns = row.inverse[0];
    while (r2 > 1 || r2 < double{row.inner} * row.inner || turns_of(x, y) > turns) {
      x = 2 * random() - 1, y = 2 * random() - 1;
      r2 = x * x + y * y;
    }
    at = p + a * x + b * y;
    area = read3(row.normal) * (pi * turns * (1 - double{row.inner} * row.inner) * glm::length(glm::cross(a, b)));
  } else {
    const bool is_cylinder = shape == LightShape::cylinder;
    const double turns = row.normal[2], phi = 2 * pi * turns * random();
    const double z_min = is_cylinder ? 0.0 : double{row.normal[0]}, z_max = is_cylinder ? 1.0 : double{row.normal[1]};
    const double z = z_min + (z_max - z_min) * random(), r = is_cylinder ? 1 : std::sqrt(std::max(0.0, 1 - z * z));
    const Vector q(r * std::cos(phi), r * std::sin(phi), z);
    const glm::dmat3 axes(a, b, c);
    at = p + axes * q;
    const Vector outwards = is_cylinder ? Vector(q.x, q.y, 0) : q;
    area = std::abs(glm::determinant(axes)) * (glm::transpose(glm::inverse(axes)) * outwards) *
           (2 * pi * turns * (z_max - z_min)) * double{row.normal_sign};
  }
  const double d = glm::length(at - from);
  sample.direction = (at - from) / d;
  sample.distance = d;
  double projected = -glm::dot(area, sample.direction);
  if (row.two_sided != 0) projected = std::abs(projected);
  sample.factor = projected > 0 ? projected / (d * d) : 0;
  if (row.cosine_power > 0) sample.factor *= std::pow(std::abs(projected) / glm::length(area), row.cosine_power);
  return sample;
}

}  // namespace metamer
