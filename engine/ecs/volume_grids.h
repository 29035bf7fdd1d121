// Frozen grids: read-only columns that lookups walk, and what is made of them for each volume that varies in space.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "engine/simd/column.h"

namespace metamer {

// Values lie in bricks of 8x8x8 voxels and a layer of their neighbours on the upper sides: the eight voxels around any
// place are in one brick. A table of 16x16x16 bricks is a node; a dense table holds a grid's nodes.
inline constexpr int32_t stored_side = 9, stored_voxels = stored_side * stored_side * stored_side;
inline constexpr int32_t node_side = 16, node_bricks = node_side * node_side * node_side;
inline constexpr int32_t node_voxels = 8 * node_side;
inline constexpr size_t most_nodes = size_t{1} << 22;        // of one grid's dense table
inline constexpr size_t most_grid_floats = size_t{1} << 31;  // of all values: gathers have 31 bits for an index
inline constexpr int32_t farthest_voxel = int32_t{1} << 22;  // coordinates are held in single precision

struct GridRow {
  int32_t lower[3] = {};    // voxel where the nodes' table begins, a multiple of 8
  int32_t nodes[3] = {};    // its size
  uint32_t first_node = 0;  // into GridColumns::nodes
  uint32_t channels = 1;
  float background[3] = {};  // beyond the table
};
struct GridColumns {
  std::vector<GridRow> rows;
  Column<uint32_t> nodes;   // of each node of a table: where its bricks begin in `bricks`
  Column<uint32_t> bricks;  // where each brick begins in `values`
  Column<float> values;     // stored_voxels times the channels per brick: x fastest, channels side by side
  size_t bytes() const { return nodes.bytes() + bricks.bytes() + values.bytes(); }
};

// A grid as a factor: of which, and from the volume's cells to its voxels (rows of an affine matrix).
struct GridUse {
  uint32_t grid = 0xffffffffu;  // row of GridColumns; no_index: a factor of 1
  uint32_t channels = 0;        // 0 without a grid
  float to_index[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  std::array<uint32_t, 3> tints{};  // SpectrumId that each of three channels counts with; they sum to 1
  bool is_used() const { return channels != 0; }
};

// What varies in a volume. Rays are followed in a space whose unit cubes are the cells of a table of majorants:
// in a cell, sigma_t(x) <= majorant * (absorption_most sigma_a + scattering_most sigma_s) of VolumeColumns, on each
// wavelength.
struct GridVolume {
  float to_cells[12] = {};             // from the world, row-major 3x4
  float to_local[12] = {};             // from the world to the medium's own space
  float lower[3] = {}, upper[3] = {};  // there: what is filled
  int32_t cells[3] = {1, 1, 1};
  uint32_t first_majorant = 0;  // its first cell in World::majorants
  GridUse density, sigma_a, sigma_s, emission, temperature;
  float sigma_a_most = 1, sigma_s_most = 1;  // greatest factors of the grids of that name
  float temperature_offset = 0, temperature_scale = 1;
  bool peak_is_one = false;  // blackbodies are divided by their peak
  bool stochastic = false;   // one voxel by chance, else trilinear
  bool is_grey = true;       // no wavelength is extinguished sooner than another
  bool glows = false;
};

}  // namespace metamer
