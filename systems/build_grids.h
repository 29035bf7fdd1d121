// Grids on the way into the world.
#pragma once
#include <algorithm>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "engine/ecs/world.h"

namespace metamer {

struct ValueRange {
  float least = std::numeric_limits<float>::infinity(), greatest = 0;
  void add(float value) { least = std::min(least, value), greatest = std::max(greatest, value); }
  void add(const ValueRange& other) { add(other.least), add(other.greatest); }
};

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
  // The least and the greatest value, of any channel, of lookups whose place has a floor from `lower` to `upper`, both
  // included.
  ValueRange range(uint32_t row, glm::ivec3 lower, glm::ivec3 upper) const;
  float greatest(uint32_t row) const;

 private:
  void freeze(const Grid& grid, GridRow& row, Box& bounds, std::string& error);
  void add_voxels(uint32_t row, glm::ivec3 origin, glm::ivec3 first, glm::ivec3 last, ValueRange& range) const;
  size_t first_value_of(const GridRow& row, glm::ivec3 from_lower) const;

  const Scene& scene_;
  GridColumns& columns_;
  std::vector<GridId> ids_;
  std::vector<Box> bounds_;
  std::vector<uint32_t> first_brick_;  // by row: of ranges_
  std::vector<ValueRange> ranges_;     // by brick; a grid's first one is its background
  std::vector<size_t> first_value_;    // by row: where its bricks begin in the columns
};

}  // namespace metamer
