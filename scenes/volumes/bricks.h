// How the readers of files fill a Grid: bricks and constant tiles in any order, then finish_bricks.
#pragma once
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "engine/ecs/grid.h"

namespace metamer {

// What is wrong with a file of grids, without its name; caught by read_grids.
struct GridError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Half of the machine's memory.
size_t most_grid_bytes();

struct BrickSink {
  Grid& grid;
  size_t most_bytes = most_grid_bytes();
  bool has_active = false;
  glm::ivec3 lower{0}, upper{0};  // of the active voxels, upper excluded
};

// Voxels beyond this from the origin along an axis are taken for damage: 64 km of 6 cm voxels.
inline constexpr int largest_voxel = 1 << 20;

// A new brick at `origin`, a multiple of 8, whose values are to be filled in: brick_voxels * channels. The pointer
// holds until the next call. Throws a GridError where the memory bound or largest_voxel is passed.
float* add_brick(BrickSink& sink, glm::ivec3 origin);
// A cube of `side` voxels, a multiple of 8, with one value (as many numbers as there are channels). Where it is the
// background, nothing is stored.
void add_tile(BrickSink& sink, glm::ivec3 origin, int side, const float* value);
// Voxels from `lower` up to `upper`, excluded, are active.
void add_active(BrickSink& sink, glm::ivec3 lower, glm::ivec3 upper);

// Sorts the bricks, leaves out those of background only, sets the bounds to the active voxels, and voxels beyond them
// to the background. Throws where two bricks have the same place.
void finish_bricks(BrickSink& sink);

// OpenVDB keeps a matrix that only scales and moves as the place of voxel (1, 1, 1) less that of (0, 0, 0), which
// rounds the scale: so rounded, it is kept as it is, and a grid that was written is where it was.
void settle_transform(glm::dmat4& index_to_local);

// Throws where a value is not finite, or negative unless that is allowed: the first of them and how many there are.
void check_values(const Grid& grid, bool may_be_negative);

}  // namespace metamer
