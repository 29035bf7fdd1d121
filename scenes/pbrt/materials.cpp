// Materials, and the entities that carry them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {
namespace {

constexpr std::string_view material_kinds[] = {
    "diffuse", "conductor", "dielectric", "coateddiffuse", "coatedconductor", "diffusetransmission",
    "hair",    "interface", "measured",   "mix",           "subsurface",      "thindielectric"};

// GGX widths along u and v. pbrt's remapping of roughness to alpha is a square root.
void read_roughness(Reader& reader, Parameters& parameters, Material& material) {
  const double both = read_real_or_texture(reader, parameters, "roughness", 0);
  const bool remap = parameters.boolean("remaproughness", true);
  if (both < 0) parameters.error("roughness", "roughness must not be negative");
  const auto alpha = [&](std::string_view name) {
    const double roughness = read_real_or_texture(reader, parameters, name, both);
    if (roughness < 0 && parameters.has(name)) parameters.error(name, "roughness must not be negative");
    return static_cast<float>(remap ? std::sqrt(std::max(roughness, 0.0)) : std::max(roughness, 0.0));
  };
  material.alpha_x = alpha("uroughness");
  material.alpha_y = alpha("vroughness");
}

SpectrumId spectrum_or(const std::optional<SpectrumValue>& value, SpectrumId fallback) {
  return value ? value->id : fallback;
}

void read_diffuse(Reader& reader, Parameters& parameters, Material& material) {
  material.kind = MaterialKind::diffuse;
  material.reflectance = reader.scene.spectra.add_constant(0.5).id;
  if (parameters.is_texture("reflectance")) {
    material.reflectance_texture = read_texture_parameter(reader, parameters, "reflectance", false).value_or(no_index);
    return;
  }
  const auto reflectance = read_spectrum(reader, parameters, "reflectance", RgbKind::albedo, SpectrumAlso::texture);
  material.reflectance = spectrum_or(reflectance, material.reflectance);
}

// pbrt's inversion: eta = 1 and k = 2 sqrt(R) / sqrt(1 - R), whose reflectance at normal incidence is R.
SpectrumId kappa_of_reflectance(SpectrumSet& spectra, SpectrumId reflectance) {
  Samples samples = spectra.samples(reflectance);
  for (double& sample : samples) {
    const double r = std::clamp(sample, 0.0, 0.9999);
    sample = 2 * std::sqrt(r) / std::sqrt(1 - r);
  }
  return spectra.add_samples(samples).id;
}

void read_conductor(Reader& reader, Parameters& parameters, Material& material) {
  SpectrumSet& spectra = reader.scene.spectra;
  material.kind = MaterialKind::conductor;
  const auto eta = read_spectrum(reader, parameters, "eta", RgbKind::unbounded, SpectrumAlso::texture);
  const auto kappa = read_spectrum(reader, parameters, "k", RgbKind::unbounded, SpectrumAlso::texture);
  const auto reflectance = read_spectrum(reader, parameters, "reflectance", RgbKind::albedo, SpectrumAlso::texture);
  if (reflectance && (eta || kappa)) {
    parameters.error("reflectance", "'reflectance' and 'eta' or 'k' exclude each other");
  }
  if (reflectance) {
    material.eta = unit_spectrum;
    material.kappa = kappa_of_reflectance(spectra, reflectance->id);
  } else {
    material.eta = spectrum_or(eta, spectra.add_named("metal-Cu-eta").value_or(unit_spectrum));
    material.kappa = spectrum_or(kappa, spectra.add_named("metal-Cu-k").value_or(zero_spectrum));
  }
  read_roughness(reader, parameters, material);
}

void read_index(Reader& reader, Parameters& parameters, Material& material) {
  SpectrumSet& spectra = reader.scene.spectra;
  const auto eta = read_spectrum(reader, parameters, "eta", RgbKind::unbounded, SpectrumAlso::texture_or_real);
  material.eta = spectrum_or(eta, spectra.add_constant(1.5).id);
  if (spectra.min_value(material.eta) > 0) return;
  parameters.error("eta", "an index of refraction must be positive");
  material.eta = spectra.add_constant(1.5).id;
}

void read_dielectric(Reader& reader, Parameters& parameters, Material& material) {
  material.kind = MaterialKind::dielectric;
  read_index(reader, parameters, material);
  read_roughness(reader, parameters, material);
}

void read_thin_dielectric(Reader& reader, Parameters& parameters, Material& material) {
  material.kind = MaterialKind::dielectric;
  read_index(reader, parameters, material);
  material.thin = 1;
}

// Our coat has no thickness; pbrt's absorbs along its way through the layer.
void read_coated_diffuse(Reader& reader, Parameters& parameters, Material& material) {
  read_diffuse(reader, parameters, material);
  material.kind = MaterialKind::coated;
  read_index(reader, parameters, material);
  read_roughness(reader, parameters, material);
  reader.messages.warning_once(
      "coateddiffuse", parameters.source(),
      "material \"coateddiffuse\": its layer has no thickness here and absorbs nothing, and all "
      "internal reflections count; it looks lighter than pbrt's");
  for (const std::string_view name : {"thickness", "g", "albedo"})
    parameters.unsupported(name, "the layer has no thickness and scatters nothing");
  for (const std::string_view name : {"maxdepth", "nsamples"}) parameters.unsupported(name, "the sum is exact");
  if (material.alpha_x != material.alpha_y)
    reader.messages.warning_once("anisotropic coat", parameters.source(),
                                 "material \"coateddiffuse\": its roughness is the same in every direction here, the "
                                 "geometric mean of the two");
  material.alpha_x = material.alpha_y = std::sqrt(material.alpha_x * material.alpha_y);
}

void read_unsupported(Reader& reader, std::string_view kind, Parameters& parameters, Material& material) {
  const bool known = std::find(std::begin(material_kinds), std::end(material_kinds), kind) != std::end(material_kinds);
  material.reflectance = reader.scene.spectra.add_constant(0.5).id;
  parameters.ignore_the_rest();
  if (!known) {
    reader.messages.error(parameters.source(),
                          fmt::format("there is no material \"{}\"{}", kind, did_you_mean(kind, material_kinds)));
    return;
  }
  reader.messages.warning_once(
      "material " + std::string(kind), parameters.source(),
      fmt::format("material \"{}\" is not supported yet; it is rendered as diffuse with reflectance 0.5", kind));
}

}  // namespace

Entity read_material(Reader& reader, std::string_view kind, Parameters& parameters, Entity entity) {
  Material material;
  if (kind == "diffuse") {
    read_diffuse(reader, parameters, material);
  } else if (kind == "conductor") {
    read_conductor(reader, parameters, material);
  } else if (kind == "dielectric") {
    read_dielectric(reader, parameters, material);
  } else if (kind == "coateddiffuse") {
    read_coated_diffuse(reader, parameters, material);
  } else if (kind == "thindielectric") {
    read_thin_dielectric(reader, parameters, material);
  } else if (kind == "interface" || kind == "none" || kind.empty()) {
    material.kind = MaterialKind::interface;
    reader.interface_materials.push_back(entity);
  } else {
    read_unsupported(reader, kind, parameters, material);
  }
  parameters.unsupported("displacement", "the surface stays as it is");
  parameters.unsupported("normalmap", "the surface stays as it is");
  reader.scene.registry.set(entity, material);
  reader.scene.registry.set(entity, parameters.source());
  return entity;
}

}  // namespace metamer::pbrt
