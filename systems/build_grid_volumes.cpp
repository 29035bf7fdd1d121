// Volumes that vary in space: how rays get into their cells, and what extinguishes them there at most.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "engine/schedule/blocks.h"
#include "engine/simd/portable_math.h"
#include "engine/spectrum/sources.h"
#include "systems/build_grids.h"
#include "systems/build_volumes.h"

namespace metamer {
namespace {

// A table of majorants is at most so many cells long. On clouds of 100 to 500 voxels a side (bench/volumes_bench.cpp)
// 32 to 128 differ little: smaller cells save lookups and cost steps.
constexpr int most_cells_a_side = 64;
// Rays through a medium that glows collide so often on its longest side, however thin it is.
constexpr double glowing_collisions = 16;
constexpr double wien_nm_kelvin = 2.897771955e6;  // CODATA 2018
constexpr int least_cell = 4;                     // voxels
// Voxels; a cell that ends where a voxel's share begins does not reach into it. Lookups are cut off at the majorant.
constexpr double cell_margin = 1e-5;

void store_rows(const glm::dmat4& m, float rows[12]) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) rows[4 * r + c] = static_cast<float>(m[c][r]);
}

struct DoubleBox {
  glm::dvec3 lower{std::numeric_limits<double>::infinity()}, upper{-std::numeric_limits<double>::infinity()};
};
DoubleBox transformed(const glm::dmat4& m, const glm::dvec3& lower, const glm::dvec3& upper) {
  DoubleBox box;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p(corner & 1 ? upper.x : lower.x, corner & 2 ? upper.y : lower.y, corner & 4 ? upper.z : lower.z);
    const glm::dvec3 image(m * glm::dvec4(p, 1));
    box.lower = glm::min(box.lower, image), box.upper = glm::max(box.upper, image);
  }
  return box;
}

glm::dmat4 scaled_and_moved(double scale, const glm::dvec3& origin) {
  return {{scale, 0, 0, 0}, {0, scale, 0, 0}, {0, 0, scale, 0}, {origin, 1}};
}

// The spectra that red, green and blue of a grid count with: those of the colour space's primaries, divided by their
// sum. They are not negative and sum to 1 on each wavelength, so a grey voxel is grey, and what a voxel adds is at most
// the greatest of its three numbers. In the modes of coefficients the primaries' coefficients take their place.
std::array<SpectrumId, 3> make_tints(ColorSpace space, ColorMode mode, SpectrumSet& spectra) {
  std::array<Samples, 3> primaries;
  Samples sum{};
  for (size_t c = 0; c < 3; ++c) {
    Color3 rgb{};
    rgb[c] = 1;
    primaries[c] = spectra.samples(spectra.add_rgb(rgb, RgbKind::albedo, space).id);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += primaries[c][i];
  }
  std::array<SpectrumId, 3> tints;
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < sum.size(); ++i) primaries[c][i] /= sum[i];
    tints[c] = spectra.add_samples(primaries[c]).id;
  }
  if (mode == ColorMode::spectral) return tints;
  const Matrix3 m = image_to_coefficients(mode, space);
  for (size_t c = 0; c < 3; ++c) {
    Color3 coefficients;
    for (size_t k = 0; k < 3; ++k) {
      double row_sum = 0;
      for (size_t i = 0; i < 3; ++i) row_sum += std::max(m[k][i], 0.0);
      coefficients[k] = std::max(m[k][c], 0.0) / row_sum;
    }
    tints[c] = spectra.with_coefficients(tints[c], coefficients);
  }
  return tints;
}

// See World::blackbody_coefficients.
void add_blackbody_coefficients(World& world) {
  const ColorMode mode = world.settings.color;
  if (mode == ColorMode::spectral || !world.blackbody_coefficients.empty()) return;
  world.blackbody_coefficients.resize(3 * blackbody_steps);
  const double step = portable::log(blackbody_hottest / blackbody_coldest) / (blackbody_steps - 1);
  for (uint32_t i = 0; i < blackbody_steps; ++i) {
    const double kelvin = blackbody_coldest * portable::exp(step * i);
    Samples samples = blackbody(kelvin);
    const double peak = planck_radiance(kelvin, wien_nm_kelvin / kelvin);
    for (double& sample : samples) sample /= peak;
    const Color3 coefficients = light_coefficients(mode, samples);
    for (size_t c = 0; c < 3; ++c) world.blackbody_coefficients[3 * i + c] = static_cast<float>(coefficients[c]);
  }
}

}  // namespace

GridVolumeBuilder::GridVolumeBuilder(const Scene& scene, World& world, Diagnostics& diagnostics)
    : scene_(scene), world_(world), diagnostics_(diagnostics), grids_(scene, world.grids) {}

bool GridVolumeBuilder::use(Entity entity, GridId id, std::string_view name, uint32_t most_channels, GridUse& use) {
  if (id == no_index) return true;
  const auto error = [&](const std::string& what) {
    diagnostics_.error(scene_.location(entity), fmt::format("medium {}: {}", scene_.describe(entity), what));
    return false;
  };
  if (id >= scene_.grids.size()) return error(fmt::format("there is no grid for its {}", name));
  const Grid& grid = scene_.grids[id];
  if (grid.channels > most_channels)
    return error(fmt::format("grid '{}' has three numbers per voxel; its {} is one number", grid.name, name));
  std::string wrong;
  use.grid = grids_.row_of(id, wrong);
  use.channels = grid.channels;
  if (!wrong.empty()) return error(wrong);
  if (use.channels == 3) use.tints = make_tints(grid.color_space, world_.settings.color, world_.spectra);
  return true;
}

uint32_t GridVolumeBuilder::add(Entity entity, const Medium& medium, const glm::dmat4& to_world) {
  const MediumGrid component = scene_.registry.get<MediumGrid>(entity);
  const size_t before = diagnostics_.error_count();
  const auto error = [&](const std::string& what) {
    diagnostics_.error(scene_.location(entity), fmt::format("medium {}: {}", scene_.describe(entity), what));
  };
  GridVolume volume;
  use(entity, component.density, "density", 1, volume.density);
  use(entity, component.sigma_a, "sigma_a", 3, volume.sigma_a);
  use(entity, component.sigma_s, "sigma_s", 3, volume.sigma_s);
  use(entity, component.emission, "emission", 3, volume.emission);
  use(entity, component.temperature, "temperature", 1, volume.temperature);
  for (int i = 0; i < 3; ++i) {
    volume.lower[i] = component.lower[i], volume.upper[i] = component.upper[i];
    if (!(component.lower[i] < component.upper[i]) || !std::isfinite(component.upper[i] - component.lower[i]))
      error(fmt::format("its box reaches from {} to {} along {}; expected two numbers, the second greater",
                        component.lower[i], component.upper[i], "xyz"[i]));
  }
  if (!(component.temperature_scale >= 0 && std::isfinite(component.temperature_scale)) ||
      !std::isfinite(component.temperature_offset))
    error(fmt::format("its temperature is (T - {}) times {}; expected finite numbers, the second at least 0",
                      component.temperature_offset, component.temperature_scale));
  volume.temperature_offset = component.temperature_offset;
  volume.temperature_scale = component.temperature_scale;
  volume.peak_is_one = component.blackbody == BlackbodyUnit::peak;
  volume.stochastic = component.lookup == GridLookup::stochastic;
  const SpectrumSet& spectra = world_.spectra;
  const bool absorbs = medium.scale > 0 && spectra.max_value(medium.sigma_a) > 0;
  volume.glows =
      absorbs && medium.emission_scale > 0 && (volume.temperature.is_used() || spectra.max_value(medium.emission) > 0);
  if (volume.temperature.is_used()) add_blackbody_coefficients(world_);
  if (diagnostics_.error_count() != before) return no_index;
  volume.sigma_a_most = volume.sigma_a.is_used() ? grids_.greatest(volume.sigma_a.grid) : 1;
  volume.sigma_s_most = volume.sigma_s.is_used() ? grids_.greatest(volume.sigma_s.grid) : 1;
  if (const std::string wrong = place(to_world, volume); !wrong.empty()) {
    error(wrong);
    return no_index;
  }
  build_majorants(medium, volume);
  world_.grid_volumes.push_back(volume);
  world_.has_grids = true;
  return static_cast<uint32_t>(world_.grid_volumes.size() - 1);
}

std::string GridVolumeBuilder::place(const glm::dmat4& to_world, GridVolume& volume) {
  GridUse* const uses[] = {&volume.density, &volume.sigma_s, &volume.sigma_a, &volume.temperature, &volume.emission};
  const auto leader = std::find_if(std::begin(uses), std::end(uses), [](const GridUse* u) { return u->is_used(); });
  const glm::dmat4 index_to_local =
      leader == std::end(uses) ? glm::dmat4(1) : grids_.source((*leader)->grid).index_to_local;
  const glm::dmat4 local_to_index = glm::inverse(index_to_local);
  const glm::dvec3 lower(volume.lower[0], volume.lower[1], volume.lower[2]);
  const glm::dvec3 upper(volume.upper[0], volume.upper[1], volume.upper[2]);
  DoubleBox box = transformed(local_to_index, lower, upper);
  if (volume.density.is_used() && grids_.source(volume.density.grid).background.x == 0) {
    const FrozenGrids::Box bounds = grids_.bounds(volume.density.grid);
    box.lower = glm::max(box.lower, glm::dvec3(bounds.lower - 1));
    box.upper = glm::min(box.upper, glm::dvec3(bounds.upper + 1));
  }
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(box.lower[i]) <= farthest_voxel && std::abs(box.upper[i]) <= farthest_voxel))
      return fmt::format("its box is {} voxels away from the first one; expected at most {}",
                         std::max(std::abs(box.lower[i]), std::abs(box.upper[i])), farthest_voxel);
    if (box.lower[i] >= box.upper[i]) box.upper[i] = box.lower[i] + 1;  // nothing there
  }
  const double longest = std::max({box.upper.x - box.lower.x, box.upper.y - box.lower.y, box.upper.z - box.lower.z});
  int size = least_cell;
  while (longest > double(size) * (most_cells_a_side - 1)) size *= 2;
  const glm::ivec3 first(glm::floor(box.lower / double(size)));
  for (int i = 0; i < 3; ++i)
    volume.cells[i] = std::max(1, static_cast<int>(std::ceil(box.upper[i] / size)) - first[i]);
  const glm::dmat4 cells_to_index = scaled_and_moved(size, glm::dvec3(first * size));
  store_rows(glm::inverse(to_world * index_to_local * cells_to_index), volume.to_cells);
  store_rows(glm::inverse(to_world), volume.to_local);
  for (GridUse* const grid_use : uses) {
    if (!grid_use->is_used()) continue;
    const glm::dmat4& own = grids_.source(grid_use->grid).index_to_local;
    store_rows(own == index_to_local ? cells_to_index : glm::inverse(own) * index_to_local * cells_to_index,
               grid_use->to_index);
  }
  for (const float number : volume.to_cells)
    if (!std::isfinite(number)) return "its voxels are too small for single precision";
  return {};
}

// Of one factor in a cell.
ValueRange GridVolumeBuilder::range_in(const GridUse& use, const glm::dvec3& cell, float most) const {
  ValueRange range;
  if (!use.is_used()) {
    range.add(1);
    return range;
  }
  glm::dmat4 m(1);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) m[c][r] = double{use.to_index[4 * r + c]};
  const DoubleBox box = transformed(m, cell, cell + 1.0);
  range = grids_.range(use.grid, glm::ivec3(glm::floor(box.lower + cell_margin)),
                       glm::ivec3(glm::floor(box.upper - cell_margin)));
  if (!(most > 0)) return {0, 0};
  return {range.least / most, range.greatest / most};
}

bool GridVolumeBuilder::may_glow(const GridVolume& volume, const glm::dvec3& cell) const {
  if (!volume.glows || !(range_in(volume.emission, cell, 1).greatest > 0)) return false;
  if (!volume.temperature.is_used()) return true;
  const float warmest = range_in(volume.temperature, cell, 1).greatest;
  return (warmest - volume.temperature_offset) * volume.temperature_scale > 100;
}

void GridVolumeBuilder::build_majorants(const Medium& medium, GridVolume& volume) {
  const size_t nx = static_cast<size_t>(volume.cells[0]), ny = static_cast<size_t>(volume.cells[1]);
  const size_t count = nx * ny * static_cast<size_t>(volume.cells[2]);
  const size_t first = world_.majorants.size() / 2;
  volume.first_majorant = static_cast<uint32_t>(first);
  world_.majorants.resize(2 * (first + count));
  float* const majorants = world_.majorants.data() + 2 * first;
  const SpectrumSet& spectra = world_.spectra;
  const double absorption = spectra.max_value(medium.sigma_a) * double{volume.sigma_a_most};
  const double scattering = spectra.max_value(medium.sigma_s) * double{volume.sigma_s_most};
  const double extinction = double{medium.scale} * (absorption + scattering);
  // What glows is only seen where rays collide.
  double longest = 0;
  for (int i = 0; i < 3; ++i) {
    const float* const row = volume.to_cells + 4 * i;
    const glm::dvec3 cells_per_metre(row[0], row[1], row[2]);
    longest = std::max(longest, volume.cells[i] / glm::length(cells_per_metre));
  }
  const float least = extinction > 0 ? static_cast<float>(glowing_collisions / (extinction * longest)) : 0;
  for_blocks(count, 0, 256, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const glm::dvec3 cell(double(i % nx), double(i / nx % ny), double(i / (nx * ny)));
      ValueRange factor;
      if (absorption > 0) factor.add(range_in(volume.sigma_a, cell, volume.sigma_a_most));
      if (scattering > 0) factor.add(range_in(volume.sigma_s, cell, volume.sigma_s_most));
      if (!(extinction > 0) || !(factor.greatest > 0)) continue;
      const ValueRange density = range_in(volume.density, cell, 1);
      const float most = factor.greatest * density.greatest;
      majorants[2 * i] = most > 0 && may_glow(volume, cell) ? std::max(most, least) : most;
      majorants[2 * i + 1] = factor.least * density.least;
    }
  });
}

}  // namespace metamer
