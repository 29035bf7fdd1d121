#include "systems/build_materials.h"

#include <fmt/format.h>

#include "engine/simd/portable_math.h"
#include "systems/bsdf/limits.h"

namespace metamer {
namespace {

MaterialRow add_diffuse(const Material& material, World& world) {
  if (world.spectra.max_value(material.reflectance) == 0) return {ShadeKind::absorber, 0};
  world.diffuse.reflectance.push_back(material.reflectance);
  return {ShadeKind::diffuse, static_cast<uint32_t>(world.diffuse.reflectance.size() - 1)};
}

// What it reflects of light from everywhere, seen along the normal: the integral of f_cos over the hemisphere.
double rough_albedo(const Material& material, double kd, double ks) {
  if (material.normalized != 0) return kd + ks;
  constexpr double pi = 3.14159265358979323846;
  const double s = double{material.shininess} + 2;
  return pi * kd + 8 * pi * ks * (1 - portable::pow(2, -s / 2)) / s;
}

struct RoughPeak {
  double albedo = 0;
  int lambda_nm = 0;
};
RoughPeak rough_peak(const Material& material, const SpectrumSet& spectra) {
  RoughPeak peak;
  for (int lambda_nm = lambda_min_nm; lambda_nm <= lambda_max_nm; ++lambda_nm) {
    const double albedo =
        rough_albedo(material, spectra.value(material.kd, lambda_nm), spectra.value(material.ks, lambda_nm));
    if (albedo > peak.albedo) peak = {albedo, lambda_nm};
  }
  return peak;
}

void check_rough(const Scene& scene, Entity entity, const Material& material, Diagnostics& diagnostics) {
  const auto error = [&](const std::string& what) {
    diagnostics.error(scene.location(entity), fmt::format("{}: {}", scene.describe(entity), what));
  };
  if (!(material.shininess >= 0 && material.shininess <= largest_shininess))
    return error("'shininess' is not a number from 0 to 1e6");
  if (scene.spectra.has_negative(material.kd) || scene.spectra.has_negative(material.ks))
    return error("'kd' or 'ks' is negative at some wavelength");
  const RoughPeak peak = rough_peak(material, scene.spectra);
  if (!(peak.albedo > 1 + 1e-6)) return;  // single precision may round a sum of 1 up
  if (material.normalized != 0)
    return diagnostics.warning(
        scene.location(entity),
        fmt::format("{}: 'kd' + 'ks' reaches {:.4g} at {} nm; normalised they are albedos: where their sum is above 1, "
                    "'ks' counts as 1 - 'kd'",
                    scene.describe(entity), peak.albedo, peak.lambda_nm));
  diagnostics.warning(scene.location(entity),
                      fmt::format("{} creates energy: seen along the normal it reflects {:.4g} times the light of its "
                                  "surroundings at {} nm; smaller 'kd' and 'ks', or 'normalized', would not",
                                  scene.describe(entity), peak.albedo, peak.lambda_nm));
}

// The glossy albedo that the diffuse one leaves: energy is conserved on every wavelength whatever was asked for.
SpectrumId limited_glossy(const Material& material, SpectrumSet& spectra) {
  if (!(rough_peak(material, spectra).albedo > 1)) return material.ks;
  Samples ks = spectra.samples(material.ks);
  const Samples kd = spectra.samples(material.kd);
  for (size_t i = 0; i < ks.size(); ++i) ks[i] = std::min(ks[i], std::max(0.0, 1 - kd[i]));
  return spectra.add_samples(ks).id;
}

MaterialRow add_rough(const Material& material, World& world) {
  RoughColumns& table = world.rough;
  if (world.spectra.max_value(material.kd) == 0 && world.spectra.max_value(material.ks) == 0)
    return {ShadeKind::absorber, 0};
  table.kd.push_back(material.kd);
  table.ks.push_back(material.normalized != 0 ? limited_glossy(material, world.spectra) : material.ks);
  table.shininess.push_back(material.shininess);
  table.normalized.push_back(material.normalized);
  return {ShadeKind::rough, static_cast<uint32_t>(table.kd.size() - 1)};
}

MaterialRow add_conductor(const Material& material, World& world) {
  const bool smooth = material.alpha_x < smooth_alpha && material.alpha_y < smooth_alpha;
  ConductorColumns& table = world.conductor;
  table.eta.push_back(material.eta);
  table.kappa.push_back(material.kappa);
  // One width may be nearly nothing, the lobe's normalisation may not.
  table.alpha_x.push_back(std::max(material.alpha_x, least_alpha));
  table.alpha_y.push_back(std::max(material.alpha_y, least_alpha));
  table.schlick.push_back(material.fresnel == FresnelModel::schlick);
  if (material.alpha_x != material.alpha_y && !smooth) world.needs_tangents = true;
  return {smooth ? ShadeKind::smooth_conductor : ShadeKind::rough_conductor,
          static_cast<uint32_t>(table.eta.size() - 1)};
}

MaterialRow add_dielectric(const Material& material, World& world) {
  DielectricColumns& table = world.dielectric;
  table.eta.push_back(material.eta);
  table.schlick.push_back(material.fresnel == FresnelModel::schlick);
  const bool disperses = !world.spectra.is_constant(material.eta);
  table.dispersive.push_back(disperses);
  world.branches = std::max(world.branches, disperses ? 5u : 2u);
  world.disperses = world.disperses || disperses;
  return {ShadeKind::dielectric, static_cast<uint32_t>(table.eta.size() - 1)};
}

MaterialRow add_material(const Material& material, World& world) {
  switch (material.kind) {
    case MaterialKind::diffuse: return add_diffuse(material, world);
    case MaterialKind::conductor: return add_conductor(material, world);
    case MaterialKind::rough: return add_rough(material, world);
    case MaterialKind::coated: return add_coated(material, world);
    case MaterialKind::dielectric: break;
  }
  return add_dielectric(material, world);
}

}  // namespace

std::vector<MaterialRow> build_materials(const Scene& scene, World& world, Diagnostics& diagnostics) {
  const Registry& registry = scene.registry;
  // Rows are made once per Material component, then every surface points to its row.
  std::vector<MaterialRow> own, by_surface;
  registry.each<Material>([&](Entity entity, uint32_t) {
    if (entity.index >= own.size()) own.resize(entity.index + 1);
    const Material material = registry.get<Material>(entity);
    if (material.kind == MaterialKind::rough) check_rough(scene, entity, material, diagnostics);
    if (material.kind == MaterialKind::coated && !check_coated(scene, entity, material, diagnostics)) return;
    own[entity.index] = add_material(material, world);
  });
  Material grey;
  grey.reflectance = world.spectra.add_constant(0.5).id;
  std::optional<MaterialRow> fallback;
  registry.each<Geometry>([&](Entity entity, uint32_t) {
    const Entity slot = registry.get<MaterialSlot>(entity).material;
    const Entity source = registry.has<Material>(slot) ? slot : entity;
    if (entity.index >= by_surface.size()) by_surface.resize(entity.index + 1);
    if (registry.has<Material>(source)) {
      by_surface[entity.index] = own[source.index];
    } else {
      if (!fallback) fallback = add_material(grey, world);
      by_surface[entity.index] = *fallback;
    }
  });
  return by_surface;
}

}  // namespace metamer
