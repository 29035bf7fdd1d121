#include <algorithm>
#include <unordered_map>

#include "systems/freeze.h"

namespace metamer {
namespace {

// Replaces spectra by the same with the coefficients of one role, each spectrum once.
class RoleCoefficients {
 public:
  using Rule = Color3 (*)(ColorMode, const Samples&);
  RoleCoefficients(World& world, Rule rule) : spectra_(world.spectra), mode_(world.settings.color), rule_(rule) {}

  void give(SpectrumId& id) {
    const auto [known, is_new] = ids_.try_emplace(id, id);
    if (is_new) known->second = spectra_.with_coefficients(id, rule_(mode_, spectra_.samples(id)));
    id = known->second;
  }
  void give(Column<uint32_t>& ids) {
    for (uint32_t& id : ids) give(id);
  }

 private:
  SpectrumSet& spectra_;
  ColorMode mode_;
  Rule rule_;
  std::unordered_map<SpectrumId, SpectrumId> ids_;
};

// Normalised kd and ks are albedos of one surface: in no channel does their sum exceed 1. As taught they are constants
// without a bound.
void give_rough(World& world) {
  RoleCoefficients albedo(world, albedo_coefficients), factor(world, factor_coefficients);
  RoughColumns& rough = world.rough;
  for (size_t row = 0; row < rough.kd.size(); ++row) {
    RoleCoefficients& role = rough.normalized[row] != 0 ? albedo : factor;
    role.give(rough.kd[row]);
    role.give(rough.ks[row]);
    if (rough.normalized[row] == 0) continue;
    const auto &kd = world.spectra.row(rough.kd[row]).coefficients, &ks = world.spectra.row(rough.ks[row]).coefficients;
    Color3 limited;
    for (size_t c = 0; c < 3; ++c) limited[c] = std::min(double{ks[c]}, 1.0 - double{kd[c]});
    rough.ks[row] = world.spectra.with_coefficients(rough.ks[row], limited);
  }
}

}  // namespace

void build_coefficients(World& world) {
  if (world.settings.color == ColorMode::spectral) return;
  RoleCoefficients albedo(world, albedo_coefficients), index(world, index_coefficients);
  RoleCoefficients light(world, light_coefficients), factor(world, factor_coefficients);
  albedo.give(world.diffuse.reflectance);
  albedo.give(world.diffuse_transmission.reflectance);
  albedo.give(world.diffuse_transmission.transmittance);
  give_rough(world);
  index.give(world.conductor.eta);
  index.give(world.conductor.kappa);
  for (CoatedColumns* coated : {&world.smooth_coated, &world.rough_coated}) {
    albedo.give(coated->reflectance);
    index.give(coated->eta);
  }
  albedo.give(world.layered.reflectance);
  albedo.give(world.layered.albedo);
  index.give(world.layered.base_eta);
  index.give(world.layered.base_kappa);
  index.give(world.hair.sigma_a);
  index.give(world.dielectric.eta);
  index.give(world.dielectric.kappa);
  index.give(world.media.eta);
  index.give(world.media.kappa);
  factor.give(world.volumes.sigma_a);
  factor.give(world.volumes.sigma_s);
  light.give(world.volumes.emission);
  for (LightRow& row : world.lights) light.give(row.spectrum);
  light.give(world.ambient_light);
}

}  // namespace metamer
