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

}  // namespace metamer::pbrt
