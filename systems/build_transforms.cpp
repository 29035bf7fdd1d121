#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "systems/freeze.h"

namespace metamer {
namespace {

glm::dmat4 local_matrix(const Registry& registry, Entity entity) {
  const Transform t = registry.get<Transform>(entity);
  return glm::transpose(glm::dmat4(glm::dvec4(t.row0), glm::dvec4(t.row1), glm::dvec4(t.row2), glm::dvec4(0, 0, 0, 1)));
}

bool is_finite(const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) return false;
  return true;
}

// Singular to float precision: the volume of the image of the unit cube against that of a box of its edges.
bool is_singular(const glm::dmat4& m) {
  const glm::dmat3 linear(m);
  const double edges = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  return !(std::abs(glm::determinant(linear)) > 1e-9 * edges);
}

}  // namespace

std::vector<glm::dmat4> build_transforms(const Scene& scene, Diagnostics& diagnostics) {
  const Registry& registry = scene.registry;
  std::vector<glm::dmat4> to_world;
  const auto resolve = [&](Entity entity) {
    glm::dmat4 matrix = local_matrix(registry, entity);
    Entity parent = registry.get<Parent>(entity).entity;
    for (size_t steps = 0; !parent.is_null(); ++steps) {
      if (steps > registry.entity_count()) {
        diagnostics.error(scene.location(entity),
                          fmt::format("the parents of {} form a cycle", scene.describe(entity)));
        return glm::dmat4(1);
      }
      matrix = local_matrix(registry, parent) * matrix;
      parent = registry.get<Parent>(parent).entity;
    }
    if (!is_finite(matrix) || is_singular(matrix)) {
      diagnostics.error(
          scene.location(entity),
          fmt::format("the transform of {} is singular or not finite: it has no inverse", scene.describe(entity)));
      return glm::dmat4(1);
    }
    return matrix;
  };
  const auto add = [&](Entity entity) {
    if (entity.index >= to_world.size()) to_world.resize(entity.index + 1, glm::dmat4(1));
    to_world[entity.index] = resolve(entity);
  };
  registry.each<Geometry>([&](Entity entity, uint32_t) { add(entity); });
  registry.each<Light>([&](Entity entity, uint32_t) {
    if (!registry.has<Geometry>(entity)) add(entity);
  });
  registry.each<Camera>([&](Entity entity, uint32_t) { add(entity); });
  return to_world;
}

}  // namespace metamer
