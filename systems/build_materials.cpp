#include "systems/bsdf/limits.h"
#include "systems/freeze.h"

namespace metamer {
namespace {

MaterialRow add_diffuse(const Material& material, World& world) {
  if (world.spectra.max_value(material.reflectance) == 0) return {ShadeKind::absorber, 0};
  world.diffuse.reflectance.push_back(material.reflectance);
  return {ShadeKind::diffuse, static_cast<uint32_t>(world.diffuse.reflectance.size() - 1)};
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
  table.dispersive.push_back(!world.spectra.is_constant(material.eta));
  return {ShadeKind::dielectric, static_cast<uint32_t>(table.eta.size() - 1)};
}

MaterialRow add_material(const Material& material, World& world) {
  switch (material.kind) {
    case MaterialKind::diffuse: return add_diffuse(material, world);
    case MaterialKind::conductor: return add_conductor(material, world);
    case MaterialKind::dielectric: break;
  }
  return add_dielectric(material, world);
}

}  // namespace

std::vector<MaterialRow> build_materials(const Scene& scene, World& world) {
  const Registry& registry = scene.registry;
  // Rows are made once per Material component, then every surface points to its row.
  std::vector<MaterialRow> own, by_surface;
  registry.each<Material>([&](Entity entity, uint32_t) {
    if (entity.index >= own.size()) own.resize(entity.index + 1);
    own[entity.index] = add_material(registry.get<Material>(entity), world);
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
