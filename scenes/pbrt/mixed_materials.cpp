// Sheets that scatter to both sides, and materials mixed of two others.
#include <fmt/format.h>

#include <algorithm>

#include "scenes/pbrt/materials.h"

namespace metamer::pbrt {
namespace {

// An albedo of a sheet, 0.25 by default, times its scale and at most 1.
struct Albedo {
  SpectrumId spectrum = zero_spectrum;
  TextureId texture = no_index;
};
Albedo read_albedo(Reader& reader, Parameters& parameters, std::string_view name, double scale) {
  SpectrumSet& spectra = reader.scene.spectra;
  Albedo albedo;
  if (parameters.is_texture(name)) {
    albedo.spectrum = spectra.add_constant(std::min(1.0, 0.25 * scale)).id;
    const std::optional<TextureId> texture = read_texture_parameter(reader, parameters, name, false);
    if (!texture) return albedo;
    albedo.texture = *texture;
    if (scale == 1) return albedo;
    std::vector<Texture>& textures = reader.scene.textures;
    Texture factor, product;
    factor.is_number = 1;
    factor.value = static_cast<float>(scale);
    textures.push_back(factor);
    product.kind = TextureKind::scale;
    product.a = *texture;
    product.b = static_cast<TextureId>(textures.size() - 1);
    textures.push_back(product);
    albedo.texture = static_cast<TextureId>(textures.size() - 1);
    return albedo;
  }
  const auto given = read_spectrum(reader, parameters, name, RgbKind::albedo, SpectrumAlso::texture);
  albedo.spectrum = given ? given->id : spectra.add_constant(0.25).id;
  if (scale == 1) return albedo;
  Samples samples = spectra.samples(albedo.spectrum);
  for (double& sample : samples) sample = std::clamp(sample * scale, 0.0, 1.0);
  albedo.spectrum = spectra.add_samples(samples).id;
  return albedo;
}

}  // namespace

void read_diffuse_transmission(Reader& reader, Parameters& parameters, Material& material) {
  material.kind = MaterialKind::diffuse_transmission;
  const double scale = parameters.number_from("scale", 1, 0);
  const Albedo reflectance = read_albedo(reader, parameters, "reflectance", scale);
  const Albedo transmittance = read_albedo(reader, parameters, "transmittance", scale);
  material.reflectance = reflectance.spectrum;
  material.reflectance_texture = reflectance.texture;
  material.transmittance = transmittance.spectrum;
  material.transmittance_texture = transmittance.texture;
}

void read_mix(Reader& reader, Parameters& parameters, Material& material) {
  material.kind = MaterialKind::mix;
  const Parameter* names = parameters.find("materials", ParameterType::string);
  const NumberOrTexture amount = read_number_or_texture(reader, parameters, "amount", 0.5);
  material.mix.amount = static_cast<float>(amount.number);
  material.mix.amount_texture = amount.texture;
  if (names == nullptr || names->strings.size() != 2) {
    parameters.error("materials", fmt::format("'string materials' names the two materials that are mixed, not {}",
                                              names == nullptr ? 0 : names->strings.size()));
    material.kind = MaterialKind::diffuse;
    material.reflectance = reader.scene.spectra.add_constant(0.5).id;
    return;
  }
  material.mix.first = named_material(reader, names->strings[0], names->source).entity;
  material.mix.second = named_material(reader, names->strings[1], names->source).entity;
}

}  // namespace metamer::pbrt
