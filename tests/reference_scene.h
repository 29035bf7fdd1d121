// What the oracle knows of surfaces, curves apart: brute-force intersection in double precision over the world's
// columns.
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "engine/ecs/world.h"

namespace metamer {

using Vector = glm::dvec3;

struct ReferenceTriangle {
  Vector p[3], n[3];
  Vector outside, tangent;  // unit normal; zero where unknown
  uint32_t object = 0, light = no_index;
};
struct ReferenceQuadric {
  glm::dmat4 to_world, to_object;
  uint32_t object = 0;
};
struct ReferenceHit {
  double t = std::numeric_limits<double>::infinity();
  uint32_t object = no_index, light = no_index;
  Vector position, outside, shading, tangent;
};

struct ReferenceScene {
  const World& world;
  std::vector<ReferenceTriangle> triangles;
  std::vector<ReferenceQuadric> quadrics;
  double least_distance = 0;  // hits nearer than this are the surface a ray starts from

  explicit ReferenceScene(const World& frozen);
  // The nearest hit before `far` among objects that `mask` sees; object == no_index: none.
  ReferenceHit intersect(const Vector& origin, const Vector& direction, uint32_t mask,
                         double far = std::numeric_limits<double>::infinity()) const;
};

inline Vector read3(const float* p) { return {p[0], p[1], p[2]}; }

}  // namespace metamer
