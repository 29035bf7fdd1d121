#include "systems/build_grids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/schedule/blocks.h"

namespace metamer {
namespace {

bool before(glm::ivec3 a, glm::ivec3 b) { return std::tuple(a.z, a.y, a.x) < std::tuple(b.z, b.y, b.x); }

// The bricks of lookups: those that there are, and those below them, whose upper layers are of theirs.
std::vector<glm::ivec3> stored_origins(const Grid& grid) {
  std::vector<glm::ivec3> origins;
  origins.reserve(8 * grid.origins.size());
  for (const glm::ivec3 origin : grid.origins)
    for (int below = 0; below < 8; ++below)
      origins.push_back(origin - brick_side * glm::ivec3(below & 1, below >> 1 & 1, below >> 2 & 1));
  std::sort(origins.begin(), origins.end(), before);
  const auto same = [](glm::ivec3 a, glm::ivec3 b) { return a == b; };
  origins.erase(std::unique(origins.begin(), origins.end(), same), origins.end());
  return origins;
}

struct StoredBrick {
  bool differs = false;  // from the background
  ValueRange range;
};

// stored_voxels values from `origin` on.
StoredBrick store_brick(const Grid& grid, glm::ivec3 origin, float* values) {
  const size_t channels = grid.channels;
  size_t bricks[8];
  for (int above = 0; above < 8; ++above)
    bricks[above] = find_brick(grid, origin + brick_side * glm::ivec3(above & 1, above >> 1 & 1, above >> 2 & 1));
  StoredBrick stored;
  for (int z = 0; z < stored_side; ++z)
    for (int y = 0; y < stored_side; ++y)
      for (int x = 0; x < stored_side; ++x) {
        const size_t brick = bricks[x / brick_side + 2 * (y / brick_side) + 4 * (z / brick_side)];
        const int voxel = x % brick_side + brick_side * (y % brick_side + brick_side * (z % brick_side));
        for (size_t c = 0; c < channels; ++c) {
          const float background = grid.background[static_cast<int>(c)];
          const float value = brick == no_brick
                                  ? background
                                  : grid.values[(brick * brick_voxels + static_cast<size_t>(voxel)) * channels + c];
          stored.differs = stored.differs || value != background;
          stored.range.add(value);
          *values++ = value;
        }
      }
  return stored;
}

// Of node tables: from the grid's lowest brick on.
std::string lay_out(const Grid& grid, const std::vector<glm::ivec3>& origins, GridRow& row) {
  glm::ivec3 lower = origins.front(), upper = origins.front();
  for (const glm::ivec3 origin : origins) lower = glm::min(lower, origin), upper = glm::max(upper, origin);
  size_t nodes = 1;
  for (int i = 0; i < 3; ++i) {
    if (lower[i] < -farthest_voxel || upper[i] > farthest_voxel)
      return fmt::format("grid '{}' has voxels at {}; expected coordinates within {} of 0", grid.name,
                         lower[i] < -farthest_voxel ? lower[i] : upper[i], farthest_voxel);
    row.lower[i] = lower[i];
    row.nodes[i] = (upper[i] - lower[i]) / node_voxels + 1;
    nodes *= static_cast<size_t>(row.nodes[i]);
  }
  if (nodes > most_nodes)
    return fmt::format(
        "the voxels of grid '{}' are scattered over {} by {} by {}; expected at most {} blocks of {} voxels a side",
        grid.name, upper.x - lower.x, upper.y - lower.y, upper.z - lower.z, most_nodes, node_voxels);
  return {};
}

// The place of a brick in the tables.
size_t node_of(const GridRow& row, glm::ivec3 from_lower) {
  const glm::ivec3 node = from_lower / node_voxels;
  return size_t{row.first_node} + static_cast<size_t>(node.x + row.nodes[0] * (node.y + row.nodes[1] * node.z));
}
size_t brick_in_node(glm::ivec3 from_lower) {
  const glm::ivec3 brick = from_lower / brick_side % node_side;
  return static_cast<size_t>(brick.x + node_side * (brick.y + node_side * brick.z));
}

}  // namespace

namespace {
ValueRange background_range(const GridRow& row) {
  ValueRange range;
  for (uint32_t c = 0; c < row.channels; ++c) range.add(row.background[c]);
  return range;
}
}  // namespace

uint32_t FrozenGrids::row_of(GridId id, std::string& error) {
  const auto known = std::find(ids_.begin(), ids_.end(), id);
  if (known != ids_.end()) return static_cast<uint32_t>(known - ids_.begin());
  GridRow row;
  Box bounds{glm::ivec3(0), glm::ivec3(-1)};
  freeze(scene_.grids[id], row, bounds, error);
  ids_.push_back(id);
  bounds_.push_back(bounds);
  columns_.rows.push_back(row);
  return static_cast<uint32_t>(ids_.size() - 1);
}

void FrozenGrids::freeze(const Grid& grid, GridRow& row, Box& bounds, std::string& error) {
  row.channels = grid.channels;
  for (int c = 0; c < 3; ++c) row.background[c] = grid.background[c];
  const auto is_bad = [](float value) { return !(value >= 0 && std::isfinite(value)); };
  const auto bad = std::find_if(grid.values.begin(), grid.values.end(), is_bad);
  if (bad != grid.values.end() || is_bad(row.background[0]) || is_bad(row.background[1]) || is_bad(row.background[2]))
    error = fmt::format("grid '{}' holds {}; expected numbers of at least 0", grid.name,
                        bad != grid.values.end() ? *bad : row.background[0]);
  const size_t floats = static_cast<size_t>(stored_voxels) * grid.channels;
  const size_t first = columns_.values.size();
  first_value_.push_back(first);
  first_brick_.push_back(static_cast<uint32_t>(ranges_.size()));
  std::vector<glm::ivec3> origins;
  if (error.empty() && !grid.origins.empty()) {
    origins = stored_origins(grid);
    error = lay_out(grid, origins, row);
    if (!error.empty()) origins.clear();
  }
  if (!error.empty()) row = {.channels = grid.channels};
  // What differs from the background, found on all threads; then packed in order.
  std::vector<StoredBrick> stored(origins.size());
  for_blocks(origins.size(), 0, 64, [&](size_t begin, size_t end) {
    std::vector<float> scratch(floats);
    for (size_t i = begin; i < end; ++i) stored[i] = store_brick(grid, origins[i], scratch.data());
  });
  std::vector<size_t> kept;
  for (size_t i = 0; i < origins.size(); ++i)
    if (stored[i].differs) kept.push_back(i);
  if (first + (kept.size() + 1) * floats > most_grid_floats) {
    error = fmt::format("with grid '{}' there are {} bricks of 8x8x8 voxels too many: all grids together may have {}",
                        grid.name, (first + (kept.size() + 1) * floats - most_grid_floats) / floats,
                        most_grid_floats / static_cast<size_t>(stored_voxels));
    kept.clear();
  }
  columns_.values.resize(first + (kept.size() + 1) * floats);
  float* const values = columns_.values.data();
  for (size_t i = 0; i < floats; ++i) values[first + i] = row.background[i % grid.channels];
  for_blocks(kept.size(), 0, 64, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) store_brick(grid, origins[kept[i]], values + first + (i + 1) * floats);
  });
  ranges_.push_back(background_range(row));
  for (const size_t i : kept) ranges_.push_back(stored[i].range);
  // Tables. Nodes without bricks share one.
  row.first_node = static_cast<uint32_t>(columns_.nodes.size());
  const size_t nodes =
      static_cast<size_t>(row.nodes[0]) * static_cast<size_t>(row.nodes[1]) * static_cast<size_t>(row.nodes[2]);
  const auto add_node = [&] {
    const size_t at = columns_.bricks.size();
    columns_.bricks.resize(at + node_bricks);
    std::fill_n(columns_.bricks.data() + at, node_bricks, static_cast<uint32_t>(first));
    return static_cast<uint32_t>(at);
  };
  const uint32_t empty = add_node();
  columns_.nodes.resize(row.first_node + std::max<size_t>(nodes, 1));  // something to look at in any case
  std::fill(columns_.nodes.begin() + row.first_node, columns_.nodes.end(), empty);
  const glm::ivec3 lower(row.lower[0], row.lower[1], row.lower[2]);
  bounds = {grid.lower, grid.upper - 1};
  glm::ivec3 least(farthest_voxel), most(-farthest_voxel);
  for (size_t i = 0; i < kept.size(); ++i) {
    const glm::ivec3 origin = origins[kept[i]];
    uint32_t& node = columns_.nodes[node_of(row, origin - lower)];
    if (node == empty) node = add_node();
    columns_.bricks[node + brick_in_node(origin - lower)] = static_cast<uint32_t>(first + (i + 1) * floats);
    least = glm::min(least, origin), most = glm::max(most, origin + brick_side);
  }
  bounds.lower = glm::max(bounds.lower, least);
  bounds.upper = glm::min(bounds.upper, most);
}

float FrozenGrids::greatest(uint32_t row) const {
  float most = 0;
  const size_t end = row + 1 < first_brick_.size() ? first_brick_[row + 1] : ranges_.size();
  for (size_t brick = first_brick_[row]; brick < end; ++brick) most = std::max(most, ranges_[brick].greatest);
  return most;
}

ValueRange FrozenGrids::range(uint32_t row, glm::ivec3 lower, glm::ivec3 upper) const {
  const GridRow& r = columns_.rows[row];
  const glm::ivec3 table(r.lower[0], r.lower[1], r.lower[2]), nodes(r.nodes[0], r.nodes[1], r.nodes[2]);
  const glm::ivec3 from = glm::max(lower - table, glm::ivec3(0)), to = glm::min(upper - table, nodes * node_voxels - 1);
  ValueRange range;
  if (from != lower - table || to != upper - table) range = background_range(r);
  if (from.x > to.x || from.y > to.y || from.z > to.z) return range;
  const glm::ivec3 size = to - from;
  const bool is_small = size.x < brick_side - 1 && size.y < brick_side - 1 && size.z < brick_side - 1;
  for (int z = from.z / brick_side; z <= to.z / brick_side; ++z)
    for (int y = from.y / brick_side; y <= to.y / brick_side; ++y)
      for (int x = from.x / brick_side; x <= to.x / brick_side; ++x) {
        const glm::ivec3 origin = brick_side * glm::ivec3(x, y, z);
        if (is_small)
          add_voxels(row, origin, glm::max(from - origin, glm::ivec3(0)),
                     glm::min(to - origin, glm::ivec3(brick_side - 1)) + 1, range);
        else
          range.add(ranges_[first_brick_[row] + (first_value_of(r, origin) - first_value_[row]) /
                                                    (static_cast<size_t>(stored_voxels) * r.channels)]);
      }
  return range;
}

// Of the brick at `origin` from the table's lower end, the voxels from `first` to `last`, both included.
void FrozenGrids::add_voxels(uint32_t row, glm::ivec3 origin, glm::ivec3 first, glm::ivec3 last,
                             ValueRange& range) const {
  const GridRow& r = columns_.rows[row];
  const size_t brick = first_value_of(r, origin);
  for (int k = first.z; k <= last.z; ++k)
    for (int j = first.y; j <= last.y; ++j)
      for (int i = first.x; i <= last.x; ++i) {
        const size_t at = brick + static_cast<size_t>(i + stored_side * (j + stored_side * k)) * r.channels;
        for (uint32_t c = 0; c < r.channels; ++c) range.add(columns_.values[at + c]);
      }
}

size_t FrozenGrids::first_value_of(const GridRow& row, glm::ivec3 from_lower) const {
  return columns_.bricks[columns_.nodes[node_of(row, from_lower)] + brick_in_node(from_lower)];
}

}  // namespace metamer
