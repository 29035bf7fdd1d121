#include "systems/build_volumes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "systems/freeze.h"

namespace metamer {
namespace {

// Free paths that differ by less are the same: single precision tells no more.
constexpr double same_extinction = 1e-6;

bool check_medium(const Scene& scene, Entity entity, const Medium& medium, const SpectrumSet& known,
                  Diagnostics& diagnostics) {
  const size_t before = diagnostics.error_count();
  const auto error = [&](const std::string& what) {
    diagnostics.error(scene.location(entity), fmt::format("medium {}: {}", scene.describe(entity), what));
  };
  const auto is_amount = [](float x) { return x >= 0 && std::isfinite(x); };
  if (!is_amount(medium.scale)) error(fmt::format("its scale is {}; expected a number of at least 0", medium.scale));
  if (!is_amount(medium.emission_scale))
    error(fmt::format("the scale of its emission is {}; expected a number of at least 0", medium.emission_scale));
  for (const float g : {medium.g, medium.g2})
    if (!(g > -1 && g < 1)) error(fmt::format("its g is {}; expected a number between -1 and 1, both excluded", g));
  if (!(medium.g2_share >= 0 && medium.g2_share <= 1))
    error(fmt::format("the share of its second lobe is {}; expected a number from 0 to 1", medium.g2_share));
  const std::pair<SpectrumId, const char*> spectra[] = {
      {medium.sigma_a, "sigma_a"}, {medium.sigma_s, "sigma_s"}, {medium.emission, "emission"}};
  for (const auto& [id, name] : spectra)
    if (known.has_negative(id)) error(fmt::format("its {} is negative at some wavelength", name));
  return diagnostics.error_count() == before;
}

// Whether some wavelength is scattered or absorbed sooner than another.
bool is_chromatic(const Medium& medium, const World& world) {
  const SpectrumSet& spectra = world.spectra;
  if (world.settings.color != ColorMode::spectral)
    return !spectra.is_constant(medium.sigma_a) || !spectra.is_constant(medium.sigma_s);
  const Samples absorption = spectra.samples(medium.sigma_a), scattering = spectra.samples(medium.sigma_s);
  double least = absorption[0] + scattering[0], most = least;
  for (size_t i = 0; i < absorption.size(); ++i) {
    least = std::min(least, absorption[i] + scattering[i]);
    most = std::max(most, absorption[i] + scattering[i]);
  }
  return most - least > same_extinction * most;
}

uint32_t add_volume(const Medium& medium, uint32_t grid, World& world) {
  VolumeColumns& table = world.volumes;
  const bool scatters = medium.scale > 0 && world.spectra.max_value(medium.sigma_s) > 0;
  table.sigma_a.push_back(medium.sigma_a);
  table.sigma_s.push_back(medium.sigma_s);
  table.emission.push_back(medium.emission);
  table.scale.push_back(medium.scale);
  table.emission_scale.push_back(medium.emission_scale);
  table.g.push_back(medium.g);
  table.g2.push_back(medium.g2);
  table.g2_share.push_back(medium.g2_share);
  table.scatters.push_back(scatters);
  table.grid.push_back(grid);
  bool parts = is_chromatic(medium, world);
  if (grid != no_index) {
    GridVolume& row = world.grid_volumes[grid];
    parts = parts || row.sigma_a.is_used() || row.sigma_s.is_used();
    row.is_grey = !parts;
  }
  if (scatters && parts) world.shares_paths = true;
  return static_cast<uint32_t>(table.scale.size() - 1);
}

}  // namespace

std::vector<VolumeSides> build_volumes(const Scene& scene, std::span<const glm::dmat4> to_world, World& world,
                                       Diagnostics& diagnostics) {
  const Registry& registry = scene.registry;
  GridVolumeBuilder grids(scene, world, diagnostics);
  Medium empty;
  empty.scale = empty.emission_scale = 0;
  add_volume(empty, no_index, world);
  std::vector<uint32_t> rows;
  registry.each<Medium>([&](Entity entity, uint32_t) {
    if (entity.index >= rows.size()) rows.resize(entity.index + 1);
    const Medium medium = registry.get<Medium>(entity);
    if (!check_medium(scene, entity, medium, world.spectra, diagnostics)) return;
    uint32_t grid = no_index;
    if (registry.has<MediumGrid>(entity)) {
      grid = grids.add(entity, medium, to_world[entity.index]);
      if (grid == no_index) return;
    }
    rows[entity.index] = add_volume(medium, grid, world);
  });
  const auto row_of = [&](Entity owner, Entity medium) {
    if (medium.is_null()) return 0u;
    if (registry.has<Medium>(medium)) return rows[medium.index];
    diagnostics.error(scene.location(owner),
                      fmt::format("{} is in {}, which is no medium", scene.describe(owner), scene.describe(medium)));
    return 0u;
  };
  std::vector<VolumeSides> sides;
  registry.each<MediumSlot>([&](Entity entity, uint32_t) {
    const MediumSlot slot = registry.get<MediumSlot>(entity);
    const uint32_t inside = row_of(entity, slot.inside), outside = row_of(entity, slot.outside);
    if (registry.has<Camera>(entity)) world.camera_volume = outside;
    if (inside != 0 || outside != 0) world.has_volumes = true;
    if (inside == outside) return;
    if (entity.index >= sides.size()) sides.resize(entity.index + 1);
    sides[entity.index] = {inside, outside};
  });
  return sides;
}

}  // namespace metamer
