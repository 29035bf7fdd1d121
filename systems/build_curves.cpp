#include "systems/build_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace metamer {
namespace {

constexpr uint32_t most_divisions = 64;

using Points = std::array<glm::dvec4, 4>;  // of a segment; w: half of the width

Points points_of(const World& world, uint32_t first) {
  Points points;
  for (size_t k = 0; k < 4; ++k)
    for (size_t c = 0; c < 4; ++c) points[k][static_cast<int>(c)] = world.curve_points[4 * (first + k) + c];
  return points;
}

void push_point(const glm::dvec4& p, World& world) {
  for (int c = 0; c < 4; ++c) world.curve_points.push_back(static_cast<float>(p[c]));
}

// A power of 2. A curve whose second differences of control points are at most d is within sqrt(2) 6 d / (8 n^2) of n
// chords (Lane & Riesenfeld's bound, as pbrt-v4 uses it).
uint32_t divisions(const Points& points) {
  double bend = 0, width = 0;
  for (size_t k = 0; k < 4; ++k) width = std::max(width, 2 * points[k].w);
  for (size_t k = 0; k < 2; ++k) {
    const glm::dvec3 second(points[k] - 2.0 * points[k + 1] + points[k + 2]);
    bend = std::max({bend, std::abs(second.x), std::abs(second.y), std::abs(second.z)});
  }
  const double chords2 = std::sqrt(2.0) * 6 * bend / (8 * 0.05 * width);  // n^2; infinite for no width
  uint32_t count = 1;
  while (count < most_divisions && chords2 > double{pieces_of_segment} * pieces_of_segment * count * count) count *= 2;
  return width > 0 ? count : 1;
}

// The polar form of the curve: its control points between a and b are those of (a a a), (a a b), (a b b), (b b b).
glm::dvec4 blossom(const Points& p, double a, double b, double c) {
  const auto step = [](const glm::dvec4& x, const glm::dvec4& y, double t) { return (1 - t) * x + t * y; };
  const glm::dvec4 p01 = step(p[0], p[1], a), p12 = step(p[1], p[2], a), p23 = step(p[2], p[3], a);
  return step(step(p01, p12, b), step(p12, p23, b), c);
}

void add_segment(const Points& points, uint32_t first_point, uint32_t count, World& world) {
  for (uint32_t i = 0; i < count; ++i) {
    const double a = double(i) / count, b = double(i + 1) / count;
    world.curve_segments.push_back(count == 1 ? first_point : static_cast<uint32_t>(world.curve_points.size() / 4));
    world.curve_u.push_back(static_cast<float>(a));
    world.curve_u.push_back(static_cast<float>(1.0 / count));
    if (count == 1) return;
    for (const glm::dvec4& p :
         {blossom(points, a, a, a), blossom(points, a, a, b), blossom(points, a, b, b), blossom(points, b, b, b)})
      push_point(p, world);
  }
}

}  // namespace

double extent(const Curves& curves) {
  float largest = 0;
  for (const glm::vec4& p : curves.points)
    largest = std::max({largest, std::abs(p.x) + p.w, std::abs(p.y) + p.w, std::abs(p.z) + p.w});
  return double{largest};
}

bool is_turned_and_scaled(const glm::dmat4& m) {
  const glm::dmat3 linear(m);
  const glm::dmat3 product = glm::transpose(linear) * linear;
  const double size = product[0][0], tolerance = 1e-6 * size;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(product[i][k] - (i == k ? size : 0)) <= tolerance)) return false;
  return glm::determinant(linear) > 0;
}

SegmentRange add_curves(const Curves& curves, ShapeKind kind, const glm::dmat4& to_world, World& world) {
  SegmentRange range{static_cast<uint32_t>(world.curve_segments.size())};
  const auto first_point = static_cast<uint32_t>(world.curve_points.size() / 4);
  const glm::dmat3 linear(to_world);
  const double scale = glm::length(linear[0]);
  for (const glm::vec4& point : curves.points)
    push_point(glm::dvec4(glm::dvec3(to_world * glm::dvec4(glm::dvec3(point), 1.0)), point.w * scale), world);
  if (kind == ShapeKind::ribbons) {
    world.curve_normals.resize(size_t{3} * first_point);  // zeros for what has none
    for (const glm::vec3& normal : curves.normals) {
      const glm::dvec3 n = linear * glm::dvec3(normal) / scale;
      for (int i = 0; i < 3; ++i) world.curve_normals.push_back(static_cast<float>(n[i]));
    }
  }
  for (const uint32_t segment : curves.segments) {
    const Points points = points_of(world, first_point + segment);
    add_segment(points, first_point + segment, kind == ShapeKind::ribbons ? 1 : divisions(points), world);
  }
  if (!world.curve_normals.empty()) world.curve_normals.resize(world.curve_points.size() / 4 * 3);
  range.count = static_cast<uint32_t>(world.curve_segments.size()) - range.first;
  return range;
}

}  // namespace metamer
