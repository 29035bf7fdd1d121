// Media of grids from code.
#pragma once
#include <cmath>

#include "tests/systems/support/radiances.h"

namespace metamer {

// `size` voxels whose centres span the box from `lower` to `upper` (faces of the outer voxels, local space).
inline glm::dmat4 voxels_in_box(const glm::ivec3& size, const glm::dvec3& lower, const glm::dvec3& upper) {
  const glm::dvec3 voxel = (upper - lower) / glm::dvec3(size);
  return glm::translate(glm::dmat4(1), lower + 0.5 * voxel) * glm::scale(glm::dmat4(1), voxel);
}

// A grid of one channel, value(i, j, k), or three, of which value() gives a vec3.
template <class Value>
GridId add_grid(SceneBuilder& b, const glm::ivec3& size, const glm::dmat4& index_to_local, const Value& value) {
  Grid grid;
  grid.name = "test";
  grid.index_to_local = index_to_local;
  grid.lower = glm::ivec3(0), grid.upper = size;
  std::vector<float> values;
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) {
        const auto v = value(i, j, k);
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, glm::vec3>) {
          grid.channels = 3;
          for (int c = 0; c < 3; ++c) values.push_back(v[c]);
        } else {
          values.push_back(static_cast<float>(v));
        }
      }
  set_dense_values(grid, size, values);
  b.scene.grids.push_back(grid);
  return static_cast<GridId>(b.scene.grids.size() - 1);
}

inline MediumGrid in_box(const glm::vec3& lower, const glm::vec3& upper) {
  MediumGrid grid;
  grid.lower = lower, grid.upper = upper;
  return grid;
}

inline Entity grid_medium(SceneBuilder& b, SpectrumId sigma_a, SpectrumId sigma_s, const MediumGrid& grid, float g = 0,
                          const glm::dmat4& matrix = glm::dmat4(1)) {
  const Entity entity = b.medium(sigma_a, sigma_s, g);
  b.scene.registry.set(entity, grid);
  b.scene.registry.set(entity, b.scene.registry.get<Transform>(b.place(matrix)));
  return entity;
}

// What lookups between voxels should give: linear in double precision, voxel by voxel from the scene's own grid.
inline glm::dvec3 interpolated(const Grid& grid, const glm::dvec3& index) {
  const glm::dvec3 low = glm::floor(index), f = index - low;
  glm::dvec3 sum(0);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 up(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    double weight = 1;
    for (int i = 0; i < 3; ++i) weight *= up[i] != 0 ? f[i] : 1 - f[i];
    sum += weight * glm::dvec3(grid_value(grid, glm::ivec3(low) + up));
  }
  return sum;
}
inline glm::dvec3 value_at(const Grid& grid, const glm::dvec3& local) {
  return interpolated(grid, glm::dvec3(glm::inverse(grid.index_to_local) * glm::dvec4(local, 1)));
}

}  // namespace metamer
