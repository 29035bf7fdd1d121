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

// Matrices of entities whose chain of parents has been walked: a chain of n links costs n products, not n squared.
struct KnownMatrices {
  std::vector<glm::dmat4> to_world;
  std::vector<bool> known;
  void set(Entity entity, const glm::dmat4& matrix) {
    if (entity.index >= known.size()) {
      known.resize(entity.index + 1);
      to_world.resize(entity.index + 1, glm::dmat4(1));
    }
    known[entity.index] = true;
    to_world[entity.index] = matrix;
  }
  bool has(Entity entity) const { return entity.index < known.size() && known[entity.index]; }
};

// Fills in the entity and its ancestors; false where they form a cycle.
bool resolve(const Registry& registry, Entity entity, KnownMatrices& matrices) {
  std::vector<Entity> chain;
  for (; !entity.is_null() && !matrices.has(entity); entity = registry.get<Parent>(entity).entity) {
    if (chain.size() > registry.entity_count()) return false;
    chain.push_back(entity);
  }
  glm::dmat4 matrix = entity.is_null() ? glm::dmat4(1) : matrices.to_world[entity.index];
  for (; !chain.empty(); chain.pop_back()) {
    matrix = matrix * local_matrix(registry, chain.back());
    matrices.set(chain.back(), matrix);
  }
  return true;
}

}  // namespace

std::vector<glm::dmat4> build_transforms(const Scene& scene, Diagnostics& diagnostics) {
  const Registry& registry = scene.registry;
  KnownMatrices matrices;
  const auto add = [&](Entity entity) {
    if (!resolve(registry, entity, matrices)) {
      diagnostics.error(scene.location(entity), fmt::format("the parents of {} form a cycle", scene.describe(entity)));
      matrices.set(entity, glm::dmat4(1));
      return;
    }
    const glm::dmat4& matrix = matrices.to_world[entity.index];
    if (is_finite(matrix) && !is_singular(matrix)) return;
    diagnostics.error(
        scene.location(entity),
        fmt::format("the transform of {} is singular or not finite: it has no inverse", scene.describe(entity)));
    matrices.set(entity, glm::dmat4(1));
  };
  registry.each<Geometry>([&](Entity entity, uint32_t) { add(entity); });
  registry.each<Light>([&](Entity entity, uint32_t) {
    if (!registry.has<Geometry>(entity)) add(entity);
  });
  registry.each<MediumGrid>([&](Entity entity, uint32_t) { add(entity); });
  registry.each<Camera>([&](Entity entity, uint32_t) { add(entity); });
  return std::move(matrices.to_world);
}

}  // namespace metamer
