// Grids on the way into the world.
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/ecs/world.h"

namespace metamer {

// Grids of a scene in the form of World::grids, each once; and what is needed of them until majorants are built.
class FrozenGrids {
 public:
  FrozenGrids(const Scene& scene, GridColumns& columns) : scene_(scene), columns_(columns) {}

  // The row of a grid that is used, built on the first call. What is wrong with it, at most once, in `error`: negative
  // or infinite values, voxels too far away or too many. Then, and for an empty grid, it is background everywhere.
  uint32_t row_of(GridId id, std::string& error);
  const Grid& source(uint32_t row) const { return scene_.grids[ids_[row]]; }

  // Voxels that may differ from the background, both included; lower > upper: none.
  struct Box {
    glm::ivec3 lower, upper;
  };
  Box bounds(uint32_t row) const { return bounds_[row]; }
  // The greatest value, of any channel, of lookups whose place has this floor, both included.
  float greatest(uint32_t row, glm::ivec3 lower, glm::ivec3 upper) const;
  float greatest(uint32_t row) const;

 private:
  void freeze(const Grid& grid, GridRow& row, Box& bounds, std::string& error);

  const Scene& scene_;
  GridColumns& columns_;
  std::vector<GridId> ids_;
  std::vector<Box> bounds_;
  std::vector<uint32_t> first_brick_;  // by row: of greatest_
  std::vector<float> greatest_;        // by brick; a grid's first one is its background
  std::vector<size_t> first_value_;    // by row: where its bricks begin in the columns
};

}  // namespace metamer
