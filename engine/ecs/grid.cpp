#include "engine/ecs/grid.h"

#include <algorithm>
#include <tuple>

namespace metamer {
namespace {

auto order(glm::ivec3 v) { return std::tuple(v.z, v.y, v.x); }
int brick_floor(int x) { return x & ~(brick_side - 1); }

// One brick of the dense values, at `origin`; whether anything in it differs from the background.
bool copy_brick(const Grid& grid, glm::ivec3 origin, glm::ivec3 size, std::span<const float> dense,
                std::span<float> brick) {
  const size_t channels = grid.channels;
  bool differs = false;
  for (int z = 0; z < brick_side; ++z)
    for (int y = 0; y < brick_side; ++y)
      for (int x = 0; x < brick_side; ++x) {
        const glm::ivec3 at = origin + glm::ivec3(x, y, z);
        const bool is_inside = at.x < size.x && at.y < size.y && at.z < size.z;
        const size_t to = size_t(x + brick_side * (y + brick_side * z)) * channels;
        const size_t from = (size_t(at.x) + size_t(size.x) * (size_t(at.y) + size_t(size.y) * size_t(at.z))) * channels;
        for (size_t c = 0; c < channels; ++c) {
          brick[to + c] = is_inside ? dense[from + c] : grid.background[static_cast<int>(c)];
          differs = differs || brick[to + c] != grid.background[static_cast<int>(c)];
        }
      }
  return differs;
}

}  // namespace

size_t find_brick(const Grid& grid, glm::ivec3 voxel) {
  const glm::ivec3 origin(brick_floor(voxel.x), brick_floor(voxel.y), brick_floor(voxel.z));
  const auto found = std::lower_bound(grid.origins.begin(), grid.origins.end(), origin,
                                      [](glm::ivec3 a, glm::ivec3 b) { return order(a) < order(b); });
  return found != grid.origins.end() && *found == origin ? static_cast<size_t>(found - grid.origins.begin()) : no_brick;
}

glm::vec3 grid_value(const Grid& grid, glm::ivec3 voxel) {
  const size_t brick = find_brick(grid, voxel);
  if (brick == no_brick) return grid.background;
  const glm::ivec3 at = voxel - grid.origins[brick];
  const float* value =
      &grid.values[(brick * brick_voxels + size_t(at.x + brick_side * (at.y + brick_side * at.z))) * grid.channels];
  return grid.channels == 3 ? glm::vec3(value[0], value[1], value[2]) : glm::vec3(value[0]);
}

glm::dvec3 grid_mean(const Grid& grid) {
  const glm::dvec3 background(grid.background), size(grid.upper - grid.lower);
  const double voxels = size.x * size.y * size.z;
  if (!(voxels > 0)) return background;
  glm::dvec3 sum(0);  // of what differs from the background, which is all that voxels beyond the bounds can be
  for (size_t i = 0; i < grid.values.size(); i += grid.channels)
    for (int c = 0; c < 3; ++c)
      sum[c] += double{grid.values[i + (grid.channels == 3 ? static_cast<size_t>(c) : 0)]} - background[c];
  return background + sum / voxels;
}

void set_dense_values(Grid& grid, glm::ivec3 size, std::span<const float> values) {
  grid.lower = glm::ivec3(0);
  grid.upper = size;
  grid.origins.clear();
  grid.values.clear();
  std::vector<float> brick(brick_voxels * grid.channels);
  for (int z = 0; z < size.z; z += brick_side)
    for (int y = 0; y < size.y; y += brick_side)
      for (int x = 0; x < size.x; x += brick_side) {
        if (!copy_brick(grid, {x, y, z}, size, values, brick)) continue;
        grid.origins.emplace_back(x, y, z);
        grid.values.insert(grid.values.end(), brick.begin(), brick.end());
      }
}

}  // namespace metamer
