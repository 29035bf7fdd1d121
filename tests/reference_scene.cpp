#include "tests/reference_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace metamer {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Vector point(const glm::dmat4& m, const Vector& p) { return Vector(m * glm::dvec4(p, 1)); }
Vector vector(const glm::dmat4& m, const Vector& v) { return glm::dmat3(m) * v; }
Vector normal(const glm::dmat4& inverse, const Vector& n) { return glm::transpose(glm::dmat3(inverse)) * n; }

glm::dmat4 matrix_of(const Placement& placement) {
  glm::dmat4 m(1);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) m[column][row] = placement.to_world[4 * row + column];
  return m;
}

// Orientation is that of the mesh's own space, carried over as a normal: a mirror does not turn it.
void add_triangle(ReferenceScene& scene, uint32_t object, uint32_t index, const glm::dmat4& m) {
  const World& world = scene.world;
  const glm::dmat4 inverse = glm::inverse(m);
  const uint32_t* corners = world.triangle_vertices.data() + 3 * (world.objects.first_triangle[object] + index);
  ReferenceTriangle t;
  Vector local[3];
  glm::dvec2 uv[3];
  for (int k = 0; k < 3; ++k) {
    local[k] = read3(world.positions.data() + 3 * corners[k]);
    t.p[k] = point(m, local[k]);
    t.n[k] = normal(inverse, read3(world.normals.data() + 3 * corners[k]));
    uv[k] = {world.uvs[2 * corners[k]], world.uvs[2 * corners[k] + 1]};
  }
  const Vector cross = glm::cross(local[1] - local[0], local[2] - local[0]);
  if (glm::length(cross) == 0) return;
  t.outside = glm::normalize(normal(inverse, cross));
  const glm::dvec2 d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
  const double area = d1.x * d2.y - d1.y * d2.x;
  t.tangent = area == 0 ? Vector(0) : ((t.p[1] - t.p[0]) * d2.y - (t.p[2] - t.p[0]) * d1.y) / area;
  t.object = object;
  if (world.objects.first_light[object] != no_index) t.light = world.objects.first_light[object] + index;
  scene.triangles.push_back(t);
}

bool is_visible(const World& world, uint32_t object, uint32_t mask) {
  return (world.objects.visibility[object] & mask) != 0;
}

void meet_triangle(double least_distance, const ReferenceTriangle& t, const Vector& origin, const Vector& direction,
                   ReferenceHit& hit) {
  const double facing = glm::dot(direction, t.outside);
  if (facing == 0) return;
  const double distance = glm::dot(t.p[0] - origin, t.outside) / facing;
  if (!(distance > least_distance && distance < hit.t)) return;
  const Vector at = origin + distance * direction;
  // Barycentric coordinates as ratios of signed areas.
  const Vector whole = glm::cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
  const double area = glm::dot(whole, whole);
  const double b1 = glm::dot(glm::cross(at - t.p[0], t.p[2] - t.p[0]), whole) / area;
  const double b2 = glm::dot(glm::cross(t.p[1] - t.p[0], at - t.p[0]), whole) / area;
  if (b1 < 0 || b2 < 0 || b1 + b2 > 1) return;
  const Vector smooth = t.n[0] * (1 - b1 - b2) + t.n[1] * b1 + t.n[2] * b2;
  hit = {distance, t.object, t.light, at, t.outside, t.outside, t.tangent};
  if (glm::length(smooth) > 0) hit.shading = glm::normalize(smooth);
}

void meet_quadric(const World& world, double least_distance, const ReferenceQuadric& q, const Vector& origin,
                  const Vector& direction, ReferenceHit& hit) {
  const Placement& shape = world.placements[world.objects.placement[q.object]];
  const Vector o = point(q.to_object, origin), d = vector(q.to_object, direction);
  const auto kind = static_cast<ShapeKind>(world.objects.kind[q.object]);
  const bool is_disk = kind == ShapeKind::disk;
  double roots[2] = {infinity, infinity};
  if (!is_disk) {
    const Vector flat(1, 1, kind == ShapeKind::sphere ? 1 : 0);
    const double a = glm::dot(d * flat, d), half_b = glm::dot(o * flat, d);
    const double c = glm::dot(o * flat, o) - double{shape.radius} * shape.radius;
    const double discriminant = half_b * half_b - a * c;
    if (discriminant < 0 || a == 0) return;
    roots[0] = (-half_b - std::sqrt(discriminant)) / a;
    roots[1] = (-half_b + std::sqrt(discriminant)) / a;
  } else if (d.z != 0) {
    roots[0] = (shape.z_min - o.z) / d.z;
  }
  // The one just left is a root near zero.
  const double least = std::max(least_distance, 1e-9 * shape.radius);
  for (const double t : roots) {
    if (!(t > least && t < hit.t)) continue;
    const Vector local = o + t * d;
    const double r = std::hypot(local.x, local.y);
    if (is_disk && (r > shape.radius || r < shape.inner_radius)) continue;
    if (!is_disk && (local.z < shape.z_min || local.z > shape.z_max)) continue;
    const double phi = std::atan2(local.y, local.x);
    if ((phi < 0 ? phi + 2 * M_PI : phi) > shape.phi_max) continue;
    const Vector outwards = is_disk ? Vector(0, 0, 1) : kind == ShapeKind::sphere ? local : Vector(local.x, local.y, 0);
    const Vector n = glm::normalize(normal(q.to_object, outwards)) * double{shape.normal_sign};
    const Vector tangent = r > 0 ? vector(q.to_world, Vector(-local.y, local.x, 0)) : vector(q.to_world, {1, 0, 0});
    hit = {t, q.object, world.objects.first_light[q.object], origin + t * direction, n, n, tangent};
    return;
  }
}

}  // namespace

ReferenceScene::ReferenceScene(const World& frozen) : world(frozen) {
  double reach = 0;
  for (uint32_t object = 0; object < world.objects.size(); ++object) {
    const glm::dmat4 m = matrix_of(world.placements[world.objects.placement[object]]);
    if (world.objects.kind[object] == static_cast<uint32_t>(ShapeKind::mesh))
      for (uint32_t i = 0; i < world.objects.triangle_count[object]; ++i) add_triangle(*this, object, i, m);
    else if (!is_curves(static_cast<ShapeKind>(world.objects.kind[object])))
      quadrics.push_back({m, glm::inverse(m), object});
    reach = std::max({reach, glm::length(m[0]), glm::length(m[1]), glm::length(m[2])});
  }
  for (const ReferenceTriangle& t : triangles)
    for (const Vector& p : t.p) reach = std::max(reach, glm::length(p));
  least_distance = 1e-9 * reach;
}

ReferenceHit ReferenceScene::intersect(const Vector& origin, const Vector& direction, uint32_t mask, double far) const {
  ReferenceHit hit;
  hit.t = far;
  for (const ReferenceTriangle& t : triangles)
    if (is_visible(world, t.object, mask)) meet_triangle(least_distance, t, origin, direction, hit);
  for (const ReferenceQuadric& q : quadrics)
    if (is_visible(world, q.object, mask)) meet_quadric(world, least_distance, q, origin, direction, hit);
  return hit;
}

}  // namespace metamer
