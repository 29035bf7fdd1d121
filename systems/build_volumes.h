// Volumes that vary in space on their way into the world.
#pragma once
#include <glm/mat4x4.hpp>
#include <string>
#include <string_view>

#include "systems/build_grids.h"

namespace metamer {

class GridVolumeBuilder {
 public:
  GridVolumeBuilder(const Scene& scene, World& world, Diagnostics& diagnostics);

  // The row of World::grid_volumes of an entity with a MediumGrid; no_index after errors. `to_world` is the entity's.
  // Errors: those of its grids (see FrozenGrids::row_of), three numbers per voxel where one is expected, an empty box.
  uint32_t add(Entity entity, const Medium& medium, const glm::dmat4& to_world);

 private:
  bool use(Entity entity, GridId id, std::string_view name, uint32_t most_channels, GridUse& use);
  // The cells, and how everything is reached from them; the result says what is wrong.
  std::string place(const glm::dmat4& to_world, GridVolume& volume);
  void build_majorants(const Medium& medium, GridVolume& volume);
  ValueRange range_in(const GridUse& use, const glm::dvec3& cell, float most) const;
  bool may_glow(const GridVolume& volume, const glm::dvec3& cell) const;

  const Scene& scene_;
  World& world_;
  Diagnostics& diagnostics_;
  FrozenGrids grids_;
};

}  // namespace metamer
