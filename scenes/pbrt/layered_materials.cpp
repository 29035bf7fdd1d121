// pbrt's coats: a dielectric surface over a layer over a base.
#include <algorithm>

#include "scenes/pbrt/materials.h"

namespace metamer::pbrt {
namespace {

void read_layer(Reader& reader, Parameters& parameters, Material& material) {
  Layer& layer = material.layer;
  material.kind = MaterialKind::layered;
  const double thickness = read_real_or_texture(reader, parameters, "thickness", 0.01);
  if (thickness < 0) parameters.error("thickness", "a layer's thickness must not be negative");
  layer.thickness = static_cast<float>(std::max(thickness, 0.0));
  const double asymmetry = read_real_or_texture(reader, parameters, "g", 0);
  if (!(asymmetry > -1 && asymmetry < 1)) parameters.error("g", "'g' must be between -1 and 1");
  layer.asymmetry = static_cast<float>(asymmetry);
  const auto albedo = read_spectrum(reader, parameters, "albedo", RgbKind::albedo, SpectrumAlso::texture);
  layer.albedo = albedo ? albedo->id : zero_spectrum;
  layer.max_depth = static_cast<uint32_t>(parameters.integer("maxdepth", 10, 0));
  layer.walks = static_cast<uint32_t>(parameters.integer("nsamples", 1, 1));
}

}  // namespace

void read_coated_diffuse(Reader& reader, Parameters& parameters, Material& material) {
  read_reflectance(reader, parameters, material);
  material.eta = read_index(reader, parameters, "eta");
  const Widths surface = read_widths(reader, parameters, "", 0);
  material.alpha_x = surface.alpha_x;
  material.alpha_y = surface.alpha_y;
  read_layer(reader, parameters, material);
}

// As pbrt's, the metal's index is against vacuum; the layer before it makes less of it.
void read_coated_conductor(Reader& reader, Parameters& parameters, Material& material) {
  material.eta = read_index(reader, parameters, "interface.eta");
  const Widths surface = read_widths(reader, parameters, "interface.", 0);
  material.alpha_x = surface.alpha_x;
  material.alpha_y = surface.alpha_y;
  read_layer(reader, parameters, material);
  Layer& layer = material.layer;
  layer.base = LayerBase::conductor;
  const MetalIndex metal = read_metal(reader, parameters, "conductor.");
  layer.base_eta = metal.eta;
  layer.base_kappa = metal.kappa;
  const Widths base = read_widths(reader, parameters, "conductor.", 0);
  layer.base_alpha_x = base.alpha_x;
  layer.base_alpha_y = base.alpha_y;
}

}  // namespace metamer::pbrt
