#include "systems/build_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "engine/simd/portable_math.h"
#include "systems/bsdf/limits.h"

namespace metamer {
namespace {

MaterialRow add_diffuse(const Material& material, World& world) {
  const bool textured = material.reflectance_texture != no_index;
  if (!textured && world.spectra.max_value(material.reflectance) == 0) return {ShadeKind::absorber, 0};
  world.diffuse.reflectance.push_back(material.reflectance);
  world.diffuse.texture.push_back(material.reflectance_texture);
  return {ShadeKind::diffuse, static_cast<uint32_t>(world.diffuse.reflectance.size() - 1)};
}

MaterialRow add_diffuse_transmission(const Material& material, World& world) {
  DiffuseTransmissionColumns& table = world.diffuse_transmission;
  table.reflectance.push_back(material.reflectance);
  table.transmittance.push_back(material.transmittance);
  table.reflectance_texture.push_back(material.reflectance_texture);
  table.transmittance_texture.push_back(material.transmittance_texture);
  return {ShadeKind::diffuse_transmission, static_cast<uint32_t>(table.reflectance.size() - 1)};
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

// Programs in place of the widths; true where there are any: then the surface is rough everywhere.
bool add_alpha_textures(const Material& material, Column<uint32_t> (&programs)[2], World& world) {
  programs[0].push_back(material.alpha_x_texture);
  programs[1].push_back(material.alpha_y_texture);
  const bool varies = material.alpha_x_texture != no_index || material.alpha_y_texture != no_index;
  world.has_textured_alpha = world.has_textured_alpha || varies;
  if (varies && material.alpha_x_texture != material.alpha_y_texture) world.needs_tangents = true;
  return varies;
}

MaterialRow add_conductor(const Material& material, World& world) {
  const bool varies = add_alpha_textures(material, world.conductor.alpha_texture, world);
  const bool is_mirror_like = !varies && material.alpha_x < smooth_alpha && material.alpha_y < smooth_alpha;
  ConductorColumns& table = world.conductor;
  table.eta.push_back(material.eta);
  table.kappa.push_back(material.kappa);
  table.texture.push_back(material.reflectance_texture);
  // One width may be nearly nothing, the lobe's normalisation may not.
  table.alpha_x.push_back(std::max(material.alpha_x, least_alpha));
  table.alpha_y.push_back(std::max(material.alpha_y, least_alpha));
  table.schlick.push_back(material.fresnel == FresnelModel::schlick);
  if (material.alpha_x != material.alpha_y && !is_mirror_like) world.needs_tangents = true;
  return {is_mirror_like ? ShadeKind::smooth_conductor : ShadeKind::rough_conductor,
          static_cast<uint32_t>(table.eta.size() - 1)};
}

// What is inside of a material that paths follow; equal ones are one medium. 0: it is not followed.
uint32_t add_medium(const Material& material, World& world) {
  const bool absorbs = world.spectra.max_value(material.kappa) > 0;
  const bool is_followed = material.kind == MaterialKind::smooth || material.priority > 0 || absorbs;
  if (!is_followed || material.thin != 0) return 0;
  MediumColumns& media = world.media;
  const uint32_t priority = std::max(material.priority, 1u);
  for (uint32_t row = 1; row < media.eta.size(); ++row)
    if (media.eta[row] == material.eta && media.kappa[row] == material.kappa && media.priority[row] == priority)
      return row;
  world.has_interiors = true;
  media.eta.push_back(material.eta);
  media.kappa.push_back(material.kappa);
  media.priority.push_back(priority);
  media.dispersive.push_back(!world.spectra.is_constant(material.eta));
  media.volume.push_back(keeps_volume);
  return static_cast<uint32_t>(media.eta.size() - 1);
}

MaterialRow add_dielectric(const Material& material, World& world) {
  const bool varies = add_alpha_textures(material, world.dielectric.alpha_texture, world);
  const bool is_smooth = !varies && material.alpha_x < smooth_alpha && material.alpha_y < smooth_alpha;
  const bool is_partly_opaque = world.spectra.max_value(material.kappa) >= double{refracting_kappa};
  DielectricColumns& table = world.dielectric;
  table.eta.push_back(material.eta);
  table.kappa.push_back(material.kappa);
  table.schlick.push_back(material.fresnel == FresnelModel::schlick);
  table.dispersive.push_back(!world.spectra.is_constant(material.eta) || is_partly_opaque);
  table.partly_opaque.push_back(is_partly_opaque);
  table.medium.push_back(add_medium(material, world));
  table.alpha_x.push_back(std::max(material.alpha_x, least_alpha));
  table.alpha_y.push_back(std::max(material.alpha_y, least_alpha));
  table.thickness.push_back(material.thickness);
  table.is_absolute.push_back(material.kind == MaterialKind::smooth);
  world.disperses = world.disperses || table.dispersive.back() != 0;
  world.branches = std::max(world.branches, table.dispersive.back() != 0 && material.thin == 0 ? 5u : 2u);
  const uint32_t row = static_cast<uint32_t>(table.eta.size() - 1);
  if (material.thin != 0) return {ShadeKind::thin_dielectric, row};
  if (material.alpha_x != material.alpha_y && !is_smooth) world.needs_tangents = true;
  return {is_smooth ? ShadeKind::dielectric : ShadeKind::rough_dielectric, row};
}

// Wholly opaque matter is a smooth conductor.
MaterialRow add_smooth(const Material& material, World& world) {
  const bool is_opaque = world.spectra.min_value(material.kappa) >= double{refracting_kappa};
  return is_opaque ? add_conductor(material, world) : add_dielectric(material, world);
}

// Row 0: what is around a path that is inside of nothing.
void add_vacuum(MediumColumns& media) {
  media.eta.push_back(unit_spectrum);
  media.kappa.push_back(zero_spectrum);
  media.priority.push_back(0);
  media.dispersive.push_back(0);
  media.volume.push_back(keeps_volume);
}

void check_optics(const Scene& scene, Entity entity, const Material& material, Diagnostics& diagnostics) {
  const auto error = [&](const std::string& what) {
    diagnostics.error(scene.location(entity), fmt::format("{}: {}", scene.describe(entity), what));
  };
  const SpectrumSet& spectra = scene.spectra;
  if (!(spectra.min_value(material.eta) > 0)) error("its index of refraction is not above 0 at every wavelength");
  if (spectra.has_negative(material.kappa)) error("its kappa is negative at some wavelength");
  const float least_width = std::min(material.alpha_x, material.alpha_y);
  if (!(least_width >= 0)) error(fmt::format("its roughness is {}; expected a number of at least 0", least_width));
  if (!(material.thickness >= 0 && material.thickness < std::numeric_limits<float>::infinity()))
    error(fmt::format("its thickness is {} m; expected a number of at least 0", material.thickness));
  if (material.priority > largest_priority)
    error(fmt::format("its priority is {}; expected an integer from 0 to {}", material.priority, largest_priority));
  const bool absorbs = spectra.max_value(material.kappa) > 0;
  if (material.kind == MaterialKind::dielectric && spectra.max_value(material.kappa) >= double{refracting_kappa})
    error("its kappa reaches 0.01, where matter is opaque; a dielectric's stays below, 'smooth' may have any");
  const bool varies = material.alpha_x_texture != no_index || material.alpha_y_texture != no_index;
  if (material.thin != 0 && (varies || std::max(material.alpha_x, material.alpha_y) >= smooth_alpha))
    error("a thin material has no roughness");
  if (material.thin != 0 && material.priority > 0) error("a thin material has no inside and takes no priority");
  if (material.thin != 0 && absorbs && material.thickness == 0) error("a thin material with kappa needs a thickness");
  if (material.thin == 0 && material.thickness != 0) error("only a thin material has a thickness");
}

MaterialRow add_material(const Material& material, World& world) {
  switch (material.kind) {
    case MaterialKind::diffuse: return add_diffuse(material, world);
    case MaterialKind::diffuse_transmission: return add_diffuse_transmission(material, world);
    case MaterialKind::conductor: return add_conductor(material, world);
    case MaterialKind::rough: return add_rough(material, world);
    case MaterialKind::coated: return add_coated(material, world);
    case MaterialKind::layered: return add_layered(material, world);
    case MaterialKind::hair: return add_hair(material, world);
    case MaterialKind::smooth: return add_smooth(material, world);
    case MaterialKind::interface: return {ShadeKind::interface, 0};
    case MaterialKind::dielectric:
    case MaterialKind::mix: break;
  }
  return add_dielectric(material, world);
}

// What bends the shading normal of a material's row.
void add_bump(const Scene& scene, const Material& material, const MaterialRow& row, World& world,
              Diagnostics& diagnostics) {
  uint32_t key = material.displacement;
  if (material.normal_map != no_index)
    key = static_cast<uint32_t>(world.textures.programs.size()) +
          add_normal_map(scene.images[material.normal_map], material.normal_map, world.textures, diagnostics);
  if (key == no_index || row.kind == ShadeKind::absorber) return;
  Column<uint32_t>& bumps = world.bumps[static_cast<size_t>(row.kind)];
  while (bumps.size() <= row.row) bumps.push_back(no_index);
  bumps[row.row] = key;
  world.has_bumps = true;
}

}  // namespace

std::vector<MaterialRow> build_materials(const Scene& scene, World& world, Diagnostics& diagnostics) {
  const Registry& registry = scene.registry;
  // Rows are made once per Material component, then every surface points to its row.
  std::vector<MaterialRow> own, by_surface;
  add_vacuum(world.media);
  registry.each<Material>([&](Entity entity, uint32_t) {
    if (entity.index >= own.size()) own.resize(entity.index + 1);
    const Material material = registry.get<Material>(entity);
    if (material.kind == MaterialKind::rough) check_rough(scene, entity, material, diagnostics);
    if (material.kind == MaterialKind::conductor || material.kind == MaterialKind::dielectric ||
        material.kind == MaterialKind::smooth)
      check_optics(scene, entity, material, diagnostics);
    const bool is_coated = material.kind == MaterialKind::coated || material.kind == MaterialKind::layered;
    if (is_coated && !check_coated(scene, entity, material, diagnostics)) return;
    if (material.kind == MaterialKind::layered && !check_layered(scene, entity, material, diagnostics)) return;
    if (material.kind == MaterialKind::hair && !check_hair(scene, entity, material, diagnostics)) return;
    if (material.kind == MaterialKind::mix) return;
    own[entity.index] = add_material(material, world);
    add_bump(scene, material, own[entity.index], world, diagnostics);
  });
  Material grey;
  grey.reflectance = world.spectra.add_constant(0.5).id;
  std::optional<MaterialRow> fallback;
  add_mixes(scene, own, world, diagnostics);
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
