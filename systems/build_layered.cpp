#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "systems/bsdf/limits.h"
#include "systems/build_materials.h"

namespace metamer {
namespace {

// Light has to be followed at random where a conductor or the layer itself scatters it, or the coat varies.
bool is_walked(const Material& material, const SpectrumSet& spectra) {
  const Layer& layer = material.layer;
  const bool varies = material.alpha_x_texture != no_index || material.alpha_y_texture != no_index ||
                      layer.thickness_texture != no_index || layer.albedo_texture != no_index;
  return varies || layer.base == LayerBase::conductor || spectra.max_value(layer.albedo) > 0;
}

}  // namespace

bool check_layered(const Scene& scene, Entity entity, const Material& material, Diagnostics& diagnostics) {
  const size_t errors_before = diagnostics.error_count();
  const auto error = [&](const std::string& what) {
    diagnostics.error(scene.location(entity), fmt::format("{}: {}", scene.describe(entity), what));
  };
  const SpectrumSet& spectra = scene.spectra;
  const Layer& layer = material.layer;
  if (!(layer.thickness >= 0 && std::isfinite(layer.thickness)))
    error("'optical_thickness' is not a number of at least 0");
  if (!(layer.asymmetry > -1 && layer.asymmetry < 1)) error("'asymmetry' is not a number between -1 and 1");
  if (spectra.has_negative(layer.albedo) || spectra.max_value(layer.albedo) > 1 + 1e-6)
    error("'albedo' is not from 0 to 1 at every wavelength");
  if (layer.walks == 0) error("'walks' is 0");
  if (layer.base == LayerBase::conductor) {
    if (!(spectra.min_value(layer.base_eta) > 0)) error("'base_eta' is not above 0 at every wavelength");
    if (spectra.has_negative(layer.base_kappa)) error("'base_kappa' is negative at some wavelength");
    if (!(std::min(layer.base_alpha_x, layer.base_alpha_y) >= 0)) error("'base_roughness' is below 0");
  }
  if (diagnostics.error_count() > errors_before) return false;
  if (is_walked(material, spectra) && !spectra.is_constant(material.eta))
    diagnostics.warning(
        scene.location(entity),
        fmt::format("{}: a layer over a metal, or one that scatters or varies, has the same index on all "
                    "wavelengths: that at 550 nm",
                    scene.describe(entity)));
  return true;
}

// Programs in place of what the tables hold; facets of a matched index have no width.
void add_layer_textures(const Material& material, bool matched, World& world) {
  LayeredColumns& table = world.layered;
  const Layer& layer = material.layer;
  table.alpha_texture[0].push_back(matched ? no_index : material.alpha_x_texture);
  table.alpha_texture[1].push_back(matched ? no_index : material.alpha_y_texture);
  table.base_alpha_texture[0].push_back(layer.base_alpha_x_texture);
  table.base_alpha_texture[1].push_back(layer.base_alpha_y_texture);
  table.thickness_texture.push_back(layer.thickness_texture);
  table.asymmetry_texture.push_back(layer.asymmetry_texture);
  table.albedo_texture.push_back(layer.albedo_texture);
  const auto is_set = [](const Column<uint32_t>& column) { return column[column.size() - 1] != no_index; };
  if (is_set(table.alpha_texture[0]) || is_set(table.alpha_texture[1])) world.has_textured_alpha = true;
  for (const Column<uint32_t>* column :
       {&table.alpha_texture[0], &table.alpha_texture[1], &table.base_alpha_texture[0], &table.base_alpha_texture[1],
        &table.thickness_texture, &table.asymmetry_texture, &table.albedo_texture})
    world.has_textured_layers = world.has_textured_layers || is_set(*column);
  if (table.alpha_texture[0].back() != table.alpha_texture[1].back() ||
      layer.base_alpha_x_texture != layer.base_alpha_y_texture)
    world.needs_tangents = true;
}

MaterialRow add_layered(const Material& material, World& world) {
  if (!is_walked(material, world.spectra)) return add_coated(material, world);
  const Layer& layer = material.layer;
  LayeredColumns& table = world.layered;
  const double eta = world.spectra.value(material.eta, 550);
  // Facets of a matched index are not there.
  const bool matched = std::abs(eta - 1) < double{matched_index};
  const auto width = [](float alpha, float other) {
    return std::max(alpha, other) < smooth_alpha ? 0.0f : std::max(alpha, least_alpha);
  };
  table.eta.push_back(static_cast<float>(eta));
  table.alpha_x.push_back(matched ? 0 : width(material.alpha_x, material.alpha_y));
  table.alpha_y.push_back(matched ? 0 : width(material.alpha_y, material.alpha_x));
  table.thickness.push_back(layer.thickness);
  table.asymmetry.push_back(layer.asymmetry);
  table.albedo.push_back(layer.albedo);
  table.scatters.push_back(world.spectra.max_value(layer.albedo) > 0);
  table.max_depth.push_back(static_cast<float>(layer.max_depth));
  table.walks.push_back(static_cast<float>(layer.walks));
  table.conductor.push_back(layer.base == LayerBase::conductor);
  table.reflectance.push_back(material.reflectance);
  table.texture.push_back(material.reflectance_texture);
  table.base_eta.push_back(layer.base_eta);
  table.base_kappa.push_back(layer.base_kappa);
  table.base_alpha_x.push_back(width(layer.base_alpha_x, layer.base_alpha_y));
  table.base_alpha_y.push_back(width(layer.base_alpha_y, layer.base_alpha_x));
  if (table.alpha_x.back() != table.alpha_y.back() || table.base_alpha_x.back() != table.base_alpha_y.back())
    world.needs_tangents = true;
  add_layer_textures(material, matched, world);
  return {ShadeKind::layered, static_cast<uint32_t>(table.eta.size() - 1)};
}

}  // namespace metamer
