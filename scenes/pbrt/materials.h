// What the readers of single kinds of material share.
#pragma once
#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {

// materials.cpp

// Whether a coat has a closed form depends on what varies: a texture that is the same everywhere counts as its value.
NumberOrTexture without_constants(const Reader& reader, NumberOrTexture value);

// GGX widths along u and v of "roughness", "uroughness", "vroughness" with `prefix` before, remapped by a square root
// unless "remaproughness" is false. Errors: negative ones.
struct Widths {
  float alpha_x = 0, alpha_y = 0;
  TextureId x_texture = no_index, y_texture = no_index;  // in their place
};
enum class ConstantTextures : uint8_t { kept, values };
Widths read_widths(Reader& reader, Parameters& parameters, std::string_view prefix,
                   ConstantTextures constants = ConstantTextures::values);
// "reflectance", 0.5 by default, or its texture.
void read_reflectance(Reader& reader, Parameters& parameters, Material& material);
// Index of refraction, 1.5 by default. Errors: one that is not positive.
SpectrumId read_index(Reader& reader, Parameters& parameters, std::string_view name);
// Of a metal: copper by default, or of a reflectance, which may be a texture; `prefix` before "eta" and "k".
struct MetalIndex {
  SpectrumId eta = unit_spectrum, kappa = zero_spectrum;
  TextureId reflectance_texture = no_index;
};
MetalIndex read_metal(Reader& reader, Parameters& parameters, std::string_view prefix);

// layered_materials.cpp: pbrt's coats, with their layer.
void read_coated_diffuse(Reader& reader, Parameters& parameters, Material& material);
void read_coated_conductor(Reader& reader, Parameters& parameters, Material& material);

// hair.cpp
void read_hair(Reader& reader, Parameters& parameters, Material& material);

// mixed_materials.cpp
void read_diffuse_transmission(Reader& reader, Parameters& parameters, Material& material);
void read_mix(Reader& reader, Parameters& parameters, Material& material);

}  // namespace metamer::pbrt
