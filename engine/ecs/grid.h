// Values that fill a part of space, as they were read: sparse, in bricks of 8 by 8 by 8 voxels.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "engine/spectrum/color.h"

namespace metamer {

inline constexpr int brick_side = 8;
inline constexpr size_t brick_voxels = 512;

struct Grid {
  std::string name;       // the file and its grid, or the entity and its key, for messages
  std::string stored_as;  // what its file calls the type of its values
  uint32_t channels = 1;  // or 3: x y z or linear RGB
  ColorSpace color_space = ColorSpace::srgb;
  glm::vec3 background{0};  // outside of all bricks
  // The lowest voxel of each brick: multiples of 8, sorted by (z, y, x), none twice.
  std::vector<glm::ivec3> origins;
  // brick_voxels * channels per brick, x fastest, then y, then z; the channels of a voxel side by side.
  std::vector<float> values;
  // The voxels that count, from `lower` up to `upper`, which is excluded; voxels of bricks beyond have the background.
  glm::ivec3 lower{0}, upper{0};
  // Affine. Voxel (i, j, k) has its centre at these coordinates.
  glm::dmat4 index_to_local{1.0};

  size_t bytes() const { return origins.size() * sizeof(glm::ivec3) + values.size() * sizeof(float); }
};

inline constexpr size_t no_brick = std::numeric_limits<size_t>::max();

// The brick a voxel is in, or no_brick.
size_t find_brick(const Grid& grid, glm::ivec3 voxel);
// The value of a voxel; of one channel in all three of them.
glm::vec3 grid_value(const Grid& grid, glm::ivec3 voxel);
// The mean over the voxels that count; background if there are none.
glm::dvec3 grid_mean(const Grid& grid);

// Fills bricks, the channels and the background of `grid` in place, from nx * ny * nz * channels values, x fastest,
// that begin at voxel (0, 0, 0). Bricks of background only are left out.
void set_dense_values(Grid& grid, glm::ivec3 size, std::span<const float> values);

}  // namespace metamer
