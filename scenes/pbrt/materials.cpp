// Materials, and the entities that carry them.
#include "scenes/pbrt/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace metamer::pbrt {
namespace {

constexpr std::string_view material_kinds[] = {
    "diffuse", "conductor", "dielectric", "coateddiffuse", "coatedconductor", "diffusetransmission",
    "hair",    "interface", "measured",   "mix",           "subsurface",      "thindielectric"};

void read_roughness(Reader& reader, Parameters& parameters, Material& material) {
  const Widths widths = read_widths(reader, parameters, "", ConstantTextures::kept);
  material.alpha_x = widths.alpha_x;
  material.alpha_y = widths.alpha_y;
  material.alpha_x_texture = widths.x_texture;
  material.alpha_y_texture = widths.y_texture;
}

SpectrumId spectrum_or(const std::optional<SpectrumValue>& value, SpectrumId fallback) {
  return value ? value->id : fallback;
}

void read_diffuse(Reader& reader, Parameters& parameters, Material& material) {
  material.kind = MaterialKind::diffuse;
  read_reflectance(reader, parameters, material);
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
  material.kind = MaterialKind::conductor;
  const MetalIndex metal = read_metal(reader, parameters, "");
  material.eta = metal.eta;
  material.kappa = metal.kappa;
  material.reflectance_texture = metal.reflectance_texture;
  read_roughness(reader, parameters, material);
}

void read_dielectric(Reader& reader, Parameters& parameters, Material& material) {
  material.kind = MaterialKind::dielectric;
  material.eta = read_index(reader, parameters, "eta");
  read_roughness(reader, parameters, material);
}

void read_thin_dielectric(Reader& reader, Parameters& parameters, Material& material) {
  material.kind = MaterialKind::dielectric;
  material.eta = read_index(reader, parameters, "eta");
  material.thin = 1;
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
      fmt::format("material \"{}\" is not supported; it is rendered as diffuse with reflectance 0.5", kind));
}

}  // namespace

NumberOrTexture without_constants(const Reader& reader, NumberOrTexture value) {
  if (value.texture == no_index) return value;
  const Texture& texture = reader.scene.textures[value.texture];
  return texture.kind == TextureKind::constant ? NumberOrTexture{double{texture.value}, no_index} : value;
}

Widths read_widths(Reader& reader, Parameters& parameters, std::string_view prefix, ConstantTextures constants) {
  const auto name_of = [&](std::string_view name) { return std::string(prefix).append(name); };
  const std::string both_name = name_of("roughness"), u_name = name_of("uroughness"), v_name = name_of("vroughness");
  const auto value_of = [&](const std::string& name, double fallback) {
    const NumberOrTexture value = read_number_or_texture(reader, parameters, name, fallback);
    return constants == ConstantTextures::kept ? value : without_constants(reader, value);
  };
  const NumberOrTexture both = value_of(both_name, 0);
  const bool remap = parameters.boolean("remaproughness", true);
  if (both.number < 0) parameters.error(both_name, "roughness must not be negative");
  const auto read = [&](const std::string& name, float& alpha, TextureId& texture) {
    const NumberOrTexture own = parameters.has(name) ? value_of(name, both.number) : both;
    if (own.number < 0 && parameters.has(name)) parameters.error(name, "roughness must not be negative");
    const double roughness = std::max(own.number, 0.0);
    alpha = static_cast<float>(remap ? std::sqrt(roughness) : roughness);
    texture = remap && own.texture != no_index ? square_root_of(reader, own.texture) : own.texture;
  };
  Widths widths;
  read(u_name, widths.alpha_x, widths.x_texture);
  if (both.texture != no_index && !parameters.has(u_name) && !parameters.has(v_name)) {
    widths.alpha_y = widths.alpha_x;
    widths.y_texture = widths.x_texture;
  } else {
    read(v_name, widths.alpha_y, widths.y_texture);
  }
  return widths;
}

void read_reflectance(Reader& reader, Parameters& parameters, Material& material) {
  material.reflectance = reader.scene.spectra.add_constant(0.5).id;
  if (parameters.is_texture("reflectance")) {
    material.reflectance_texture = read_texture_parameter(reader, parameters, "reflectance", false).value_or(no_index);
    return;
  }
  const auto reflectance = read_spectrum(reader, parameters, "reflectance", RgbKind::albedo, SpectrumAlso::texture);
  material.reflectance = spectrum_or(reflectance, material.reflectance);
}

SpectrumId read_index(Reader& reader, Parameters& parameters, std::string_view name) {
  SpectrumSet& spectra = reader.scene.spectra;
  const SpectrumId fallback = spectra.add_constant(1.5).id;
  const auto eta = read_spectrum(reader, parameters, name, RgbKind::unbounded, SpectrumAlso::texture_or_real);
  const SpectrumId index = spectrum_or(eta, fallback);
  if (spectra.min_value(index) > 0) return index;
  parameters.error(name, "an index of refraction must be positive");
  return fallback;
}

MetalIndex read_metal(Reader& reader, Parameters& parameters, std::string_view prefix) {
  SpectrumSet& spectra = reader.scene.spectra;
  const std::string eta_name = std::string(prefix).append("eta"), k_name = std::string(prefix).append("k");
  if (parameters.is_texture("reflectance")) {
    for (const std::string& name : {eta_name, k_name})
      if (parameters.has(name)) parameters.error(name, fmt::format("'reflectance' and '{}' exclude each other", name));
    return {unit_spectrum, zero_spectrum,
            read_texture_parameter(reader, parameters, "reflectance", false).value_or(no_index)};
  }
  const auto eta = read_spectrum(reader, parameters, eta_name, RgbKind::unbounded, SpectrumAlso::texture);
  const auto kappa = read_spectrum(reader, parameters, k_name, RgbKind::unbounded, SpectrumAlso::texture);
  const auto reflectance = read_spectrum(reader, parameters, "reflectance", RgbKind::albedo, SpectrumAlso::texture);
  if (reflectance && (eta || kappa))
    parameters.error("reflectance", fmt::format("'reflectance' and '{}' or '{}' exclude each other", eta_name, k_name));
  if (reflectance) return {unit_spectrum, kappa_of_reflectance(spectra, reflectance->id), no_index};
  return {spectrum_or(eta, spectra.add_named("metal-Cu-eta").value_or(unit_spectrum)),
          spectrum_or(kappa, spectra.add_named("metal-Cu-k").value_or(zero_spectrum)), no_index};
}

NamedMaterial& named_material(Reader& reader, const std::string& name, Source source) {
  const auto [entry, fresh] = reader.materials.try_emplace(name);
  if (fresh) {
    const Entity entity = reader.scene.registry.create();
    reader.scene.registry.set(entity, Name{reader.scene.names.add(name)});
    entry->second = {entity, source, false};
  }
  return entry->second;
}

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
  } else if (kind == "coatedconductor") {
    read_coated_conductor(reader, parameters, material);
  } else if (kind == "hair") {
    read_hair(reader, parameters, material);
  } else if (kind == "diffusetransmission") {
    read_diffuse_transmission(reader, parameters, material);
  } else if (kind == "mix") {
    read_mix(reader, parameters, material);
  } else if (kind == "thindielectric") {
    read_thin_dielectric(reader, parameters, material);
  } else if (kind == "interface" || kind == "none" || kind.empty()) {
    material.kind = MaterialKind::interface;
    reader.interface_materials.push_back(entity);
  } else {
    read_unsupported(reader, kind, parameters, material);
  }
  read_bump(reader, parameters, material);
  reader.scene.registry.set(entity, material);
  reader.scene.registry.set(entity, parameters.source());
  return entity;
}

}  // namespace metamer::pbrt
