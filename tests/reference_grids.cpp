#include "tests/reference_grids.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/spectrum/sources.h"

namespace metamer {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Vector transformed(const float m[12], const Vector& v, double w) {
  Vector result;
  for (int i = 0; i < 3; ++i)
    result[i] =
        double{m[4 * i]} * v.x + double{m[4 * i + 1]} * v.y + double{m[4 * i + 2]} * v.z + w * double{m[4 * i + 3]};
  return result;
}

double voxel(const World& world, uint32_t grid, const std::array<int64_t, 3>& at, uint32_t channel) {
  const GridRow& row = world.grids.rows[grid];
  int64_t from[3], node = 0, brick = 0, place = 0;
  for (int i = 2; i >= 0; --i) {
    from[i] = at[size_t(i)] - row.lower[i];
    if (from[i] < 0 || from[i] >= row.nodes[i] * node_voxels) return double{row.background[channel]};
    node = node * row.nodes[i] + from[i] / node_voxels;
    brick = brick * node_side + from[i] / 8 % node_side;
    place = place * stored_side + from[i] % 8;
  }
  const uint32_t bricks = world.grids.nodes[row.first_node + size_t(node)];
  const uint32_t first = world.grids.bricks[bricks + size_t(brick)];
  return double{world.grids.values[first + size_t(place) * row.channels + channel]};
}

struct Stretch {
  double near, far;
};
Stretch in_box(const GridVolume& grid, const Vector& origin, const Vector& direction, double distance) {
  const Vector o = transformed(grid.to_local, origin, 1), d = transformed(grid.to_local, direction, 0);
  Stretch stretch{0, distance};
  for (int i = 0; i < 3; ++i) {
    const double a = (double{grid.lower[i]} - o[i]) / d[i], b = (double{grid.upper[i]} - o[i]) / d[i];
    stretch.near = std::max(stretch.near, std::min(a, b));
    stretch.far = std::min(stretch.far, std::max(a, b));
  }
  return stretch;
}

// The extinction of a wavelength that is nowhere exceeded.
double majorant_of(const World& world, uint32_t volume, double lambda_nm) {
  const GridVolume& grid = world.grid_volumes[world.volumes.grid[volume]];
  const size_t count = size_t(grid.cells[0]) * size_t(grid.cells[1]) * size_t(grid.cells[2]);
  const float* first = world.majorants.data() + 2 * size_t{grid.first_majorant};
  const double scale = world.volumes.scale[volume];
  return double{*std::max_element(first, first + 2 * count)} * scale *
         (world.spectra.value(world.volumes.sigma_a[volume], lambda_nm) * double{grid.sigma_a_most} +
          world.spectra.value(world.volumes.sigma_s[volume], lambda_nm) * double{grid.sigma_s_most});
}

// Of a factor on one wavelength.
double factor(const World& world, const GridUse& use, const Vector& cells, double lambda_nm) {
  if (!use.is_used()) return 1;
  const auto value = reference_grid_value(world, use.grid, transformed(use.to_index, cells, 1));
  if (use.channels == 1) return value[0];
  double sum = 0;
  for (size_t c = 0; c < 3; ++c) sum += value[c] * world.spectra.value(use.tints[c], lambda_nm);
  return sum;
}

}  // namespace

std::array<double, 3> reference_grid_value(const World& world, uint32_t grid, const Vector& index) {
  std::array<double, 3> sum{};
  const uint32_t channels = world.grids.rows[grid].channels;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<int64_t, 3> at;
    for (int i = 0; i < 3; ++i) {
      const double low = std::floor(index[i]), above = index[i] - low;
      const int up = corner >> i & 1;
      weight *= up != 0 ? above : 1 - above;
      at[size_t(i)] = static_cast<int64_t>(low) + up;
    }
    for (uint32_t c = 0; c < 3; ++c) sum[c] += weight * voxel(world, grid, at, channels == 3 ? c : 0);
  }
  return sum;
}

void vary(const World& world, uint32_t volume, const Vector& position, double lambda_nm, ReferenceVolume& there) {
  const GridVolume& grid = world.grid_volumes[world.volumes.grid[volume]];
  const Vector local = transformed(grid.to_local, position, 1), cells = transformed(grid.to_cells, position, 1);
  for (int i = 0; i < 3; ++i)
    if (local[i] < double{grid.lower[i]} || local[i] > double{grid.upper[i]}) return void(there = {});
  const double density = factor(world, grid.density, cells, lambda_nm);
  there.absorption *= density * factor(world, grid.sigma_a, cells, lambda_nm);
  there.scattering *= density * factor(world, grid.sigma_s, cells, lambda_nm);
  if (!grid.glows) return void(there.glow = 0);
  if (grid.temperature.is_used()) {
    const double kelvin = (factor(world, grid.temperature, cells, lambda_nm) - double{grid.temperature_offset}) *
                          double{grid.temperature_scale};
    there.glow = 0;
    if (kelvin > 100)
      there.glow = double{world.volumes.emission_scale[volume]} * planck_radiance(kelvin, lambda_nm) /
                   (grid.peak_is_one ? planck_radiance(kelvin, 2.897771955e6 / kelvin) : 1);
  }
  there.glow *= factor(world, grid.emission, cells, lambda_nm);
}

double reference_free_path(const World& world, uint32_t volume, const Vector& origin, const Vector& direction,
                           double distance, double lambda_nm, ReferenceRandom& random) {
  const double majorant = majorant_of(world, volume, lambda_nm);
  const Stretch stretch = in_box(world.grid_volumes[world.volumes.grid[volume]], origin, direction, distance);
  if (!(majorant > 0)) return infinity;
  for (double t = stretch.near;;) {
    t -= std::log(1 - random()) / majorant;
    if (!(t < stretch.far)) return infinity;
    if (random() * majorant < volume_at(world, volume, origin + t * direction, lambda_nm).extinction()) return t;
  }
}

double reference_ratio(const World& world, uint32_t volume, const Vector& origin, const Vector& direction,
                       double distance, double lambda_nm, ReferenceRandom& random) {
  const double majorant = majorant_of(world, volume, lambda_nm);
  const Stretch stretch = in_box(world.grid_volumes[world.volumes.grid[volume]], origin, direction, distance);
  if (!(majorant > 0)) return 1;
  double passes = 1;
  for (double t = stretch.near; passes > 0;) {
    t -= std::log(1 - random()) / majorant;
    if (!(t < stretch.far)) break;
    passes *= 1 - volume_at(world, volume, origin + t * direction, lambda_nm).extinction() / majorant;
  }
  return passes;
}

}  // namespace metamer
