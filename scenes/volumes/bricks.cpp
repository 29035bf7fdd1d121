#include "scenes/volumes/bricks.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace metamer {
namespace {

auto order(glm::ivec3 v) { return std::tuple(v.z, v.y, v.x); }

std::string amount(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.3g} MB", bytes / 1e6) : fmt::format("{:.3g} GB", bytes / 1e9);
}

size_t brick_bytes(const Grid& grid) { return sizeof(glm::ivec3) + brick_voxels * grid.channels * sizeof(float); }

void check_room(const BrickSink& sink, double bricks, const std::string& what) {
  const double bytes = bricks * static_cast<double>(brick_bytes(sink.grid));
  if (bytes <= static_cast<double>(sink.most_bytes)) return;
  throw GridError(fmt::format("{}: {:.4g} bricks of 8x8x8 voxels are {}; the most is {}, half of this machine's memory",
                              what, bricks, amount(bytes), amount(static_cast<double>(sink.most_bytes))));
}

void check_place(glm::ivec3 lower, int side) {
  for (int i = 0; i < 3; ++i)
    if (lower[i] < -largest_voxel || lower[i] > largest_voxel - side)
      throw GridError(fmt::format("has voxels at ({}, {}, {}); coordinates beyond {} are not supported", lower.x,
                                  lower.y, lower.z, largest_voxel));
}

bool is_background(const Grid& grid, const float* values, size_t count) {
  for (size_t i = 0; i < count; ++i)
    if (!(values[i] == grid.background[static_cast<int>(i % grid.channels)])) return false;
  return true;
}

// Voxels beyond the bounds get the background.
void trim(const Grid& grid, glm::ivec3 origin, float* values) {
  const auto is_inside = [](glm::ivec3 p, glm::ivec3 lower, glm::ivec3 upper) {
    return p.x >= lower.x && p.y >= lower.y && p.z >= lower.z && p.x < upper.x && p.y < upper.y && p.z < upper.z;
  };
  if (is_inside(origin, grid.lower, grid.upper) && is_inside(origin + (brick_side - 1), grid.lower, grid.upper)) return;
  for (int i = 0; i < static_cast<int>(brick_voxels); ++i) {
    const glm::ivec3 at = origin + glm::ivec3(i % 8, i / 8 % 8, i / 64);
    if (is_inside(at, grid.lower, grid.upper)) continue;
    for (uint32_t c = 0; c < grid.channels; ++c) values[i * grid.channels + c] = grid.background[static_cast<int>(c)];
  }
}

}  // namespace

size_t most_grid_bytes() {
  return static_cast<size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<size_t>(sysconf(_SC_PAGE_SIZE)) / 2;
}

float* add_brick(BrickSink& sink, glm::ivec3 origin) {
  check_place(origin, brick_side);
  Grid& grid = sink.grid;
  check_room(sink, static_cast<double>(grid.origins.size() + 1), "the grid is too large");
  grid.origins.push_back(origin);
  const size_t size = brick_voxels * grid.channels;
  grid.values.resize(grid.values.size() + size);
  return grid.values.data() + grid.values.size() - size;
}

void add_tile(BrickSink& sink, glm::ivec3 origin, int side, const float* value) {
  const Grid& grid = sink.grid;
  if (is_background(grid, value, grid.channels)) return;
  const double along = side / brick_side;
  check_room(
      sink, static_cast<double>(grid.origins.size()) + along * along * along,
      fmt::format("a tile of {0}x{0}x{0} voxels at ({1}, {2}, {3}) is too large", side, origin.x, origin.y, origin.z));
  for (int z = 0; z < side; z += brick_side)
    for (int y = 0; y < side; y += brick_side)
      for (int x = 0; x < side; x += brick_side) {
        float* values = add_brick(sink, origin + glm::ivec3(x, y, z));
        for (size_t i = 0; i < brick_voxels * grid.channels; ++i) values[i] = value[i % grid.channels];
      }
}

void add_active(BrickSink& sink, glm::ivec3 lower, glm::ivec3 upper) {
  check_place(lower, upper.x - lower.x);
  check_place(upper - 1, 1);
  for (int i = 0; i < 3; ++i) {
    sink.lower[i] = sink.has_active ? std::min(sink.lower[i], lower[i]) : lower[i];
    sink.upper[i] = sink.has_active ? std::max(sink.upper[i], upper[i]) : upper[i];
  }
  sink.has_active = true;
}

void finish_bricks(BrickSink& sink) {
  Grid& grid = sink.grid;
  grid.lower = sink.lower;
  grid.upper = sink.upper;
  const size_t size = brick_voxels * grid.channels;
  std::vector<uint32_t> sorted(grid.origins.size());
  std::iota(sorted.begin(), sorted.end(), 0u);
  std::sort(sorted.begin(), sorted.end(),
            [&](uint32_t a, uint32_t b) { return order(grid.origins[a]) < order(grid.origins[b]); });
  for (size_t i = 1; i < sorted.size(); ++i)
    if (grid.origins[sorted[i]] == grid.origins[sorted[i - 1]])
      throw GridError("the file is damaged: two bricks have the same place");
  std::vector<glm::ivec3> origins;
  std::vector<uint32_t> kept;
  for (const uint32_t brick : sorted) {
    float* values = grid.values.data() + brick * size;
    trim(grid, grid.origins[brick], values);
    if (is_background(grid, values, size)) continue;
    kept.push_back(brick);
    origins.push_back(grid.origins[brick]);
  }
  std::vector<float> values(kept.size() * size);
  for (size_t i = 0; i < kept.size(); ++i)
    std::copy_n(grid.values.data() + kept[i] * size, size, values.data() + i * size);
  grid.origins = std::move(origins);
  grid.values = std::move(values);
}

void settle_transform(glm::dmat4& m) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i != j && m[i][j] != 0) return;
  constexpr int rounds = 4;  // the second settles it
  for (int round = 0; round < rounds; ++round)
    for (int i = 0; i < 3; ++i) m[i][i] = (m[i][i] + m[3][i]) - m[3][i];
}

void check_values(const Grid& grid, bool may_be_negative) {
  const auto is_wrong = [&](float x) { return !std::isfinite(x) || (x < 0 && !may_be_negative); };
  const auto fail = [](float x, const std::string& where, size_t count) {
    const std::string others = count > 1 ? fmt::format(" and {} more", count - 1) : "";
    const std::string_view expected = std::isfinite(x) ? "values of at least 0" : "finite values";
    throw GridError(fmt::format("the value {} is {}{}; expected {}", where, x, others, expected));
  };
  for (uint32_t c = 0; c < grid.channels; ++c)
    if (const float x = grid.background[static_cast<int>(c)]; is_wrong(x)) fail(x, "of the background", 1);
  const auto first = std::find_if(grid.values.begin(), grid.values.end(), is_wrong);
  if (first == grid.values.end()) return;
  const size_t index = static_cast<size_t>(first - grid.values.begin()) / grid.channels;
  const int in_brick = static_cast<int>(index % brick_voxels);
  const glm::ivec3 at = grid.origins[index / brick_voxels] + glm::ivec3(in_brick % 8, in_brick / 8 % 8, in_brick / 64);
  fail(*first, fmt::format("at voxel ({}, {}, {})", at.x, at.y, at.z),
       static_cast<size_t>(std::count_if(first, grid.values.end(), is_wrong)));
}

}  // namespace metamer
