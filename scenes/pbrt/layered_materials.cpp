// pbrt's coats: a dielectric surface over a layer over a base.
#include <algorithm>

#include "scenes/pbrt/materials.h"

namespace metamer::pbrt {
namespace {

void read_layer(Reader& reader, Parameters& parameters, Material& material) {
  Layer& layer = material.layer;
  material.kind = MaterialKind::layered;
  const NumberOrTexture thickness =
      without_constants(reader, read_number_or_texture(reader, parameters, "thickness", 0.01));
  if (thickness.number < 0) parameters.error("thickness", "a layer's thickness must not be negative");
  layer.thickness = static_cast<float>(std::max(thickness.number, 0.0));
  layer.thickness_texture = thickness.texture;
  const NumberOrTexture asymmetry = without_constants(reader, read_number_or_texture(reader, parameters, "g", 0));
  if (!(asymmetry.number > -1 && asymmetry.number < 1)) parameters.error("g", "'g' must be between -1 and 1");
  layer.asymmetry = static_cast<float>(asymmetry.number);
  layer.asymmetry_texture = asymmetry.texture;
  if (parameters.is_texture("albedo")) {
    layer.albedo_texture = read_texture_parameter(reader, parameters, "albedo", false).value_or(no_index);
  } else {
    const auto albedo = read_spectrum(reader, parameters, "albedo", RgbKind::albedo, SpectrumAlso::texture);
    layer.albedo = albedo ? albedo->id : zero_spectrum;
  }
  layer.max_depth = static_cast<uint32_t>(parameters.integer("maxdepth", 10, 0));
  layer.walks = static_cast<uint32_t>(parameters.integer("nsamples", 1, 1));
}

void set_surface(const Widths& surface, Material& material) {
  material.alpha_x = surface.alpha_x;
  material.alpha_y = surface.alpha_y;
  material.alpha_x_texture = surface.x_texture;
  material.alpha_y_texture = surface.y_texture;
}

}  // namespace

void read_coated_diffuse(Reader& reader, Parameters& parameters, Material& material) {
  read_reflectance(reader, parameters, material);
  material.eta = read_index(reader, parameters, "eta");
  set_surface(read_widths(reader, parameters, ""), material);
  read_layer(reader, parameters, material);
}

// As pbrt's, the metal's index is against vacuum; the layer before it makes less of it.
void read_coated_conductor(Reader& reader, Parameters& parameters, Material& material) {
  material.eta = read_index(reader, parameters, "interface.eta");
  set_surface(read_widths(reader, parameters, "interface."), material);
  read_layer(reader, parameters, material);
  Layer& layer = material.layer;
  layer.base = LayerBase::conductor;
  const MetalIndex metal = read_metal(reader, parameters, "conductor.");
  layer.base_eta = metal.eta;
  layer.base_kappa = metal.kappa;
  material.reflectance_texture = metal.reflectance_texture;
  const Widths base = read_widths(reader, parameters, "conductor.");
  layer.base_alpha_x = base.alpha_x;
  layer.base_alpha_y = base.alpha_y;
  layer.base_alpha_x_texture = base.x_texture;
  layer.base_alpha_y_texture = base.y_texture;
}

}  // namespace metamer::pbrt
