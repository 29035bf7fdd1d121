#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenes/native/components.h"
#include "scenes/native/spectra.h"
#include "scenes/native/varying.h"
#include "systems/bsdf/hair.h"
#include "systems/bsdf/limits.h"

namespace metamer {
namespace {

constexpr std::string_view fresnel_names[] = {"exact", "schlick"};  // in the order of FresnelModel

// GGX's alpha itself, one number or one along each tangent.
void read_widths(const SceneContext& context, const JsonObject& object, std::string_view key, float& alpha_x,
                 float& alpha_y) {
  const Json::Value* value = object.find(key);
  if (value == nullptr) return;
  std::array<double, 2> alpha{};
  if (value->isArray()) {
    context.reader.numbers(*value, key, not_negative, alpha);
  } else {
    alpha.fill(context.reader.number(*value, key, not_negative, 0));
  }
  alpha_x = static_cast<float>(alpha[0]);
  alpha_y = static_cast<float>(alpha[1]);
}

// The same where each of them may be a texture.
struct Widths {
  float &alpha_x, &alpha_y;
  TextureId &x_texture, &y_texture;
};
void read_varying_widths(SceneContext& context, const JsonObject& object, std::string_view key, Widths widths) {
  const Json::Value* value = object.find(key);
  const bool is_pair = value != nullptr && value->isArray() && value->size() == 2;
  const bool varies =
      value != nullptr && (is_texture(*value) || (is_pair && (is_texture((*value)[0]) || is_texture((*value)[1]))));
  if (!varies) return read_widths(context, object, key, widths.alpha_x, widths.alpha_y);
  const NumberOrTexture x = read_number_or_texture(context, is_pair ? (*value)[0] : *value, key, not_negative);
  const NumberOrTexture y = is_pair ? read_number_or_texture(context, (*value)[1], key, not_negative) : x;
  widths.alpha_x = x.number;
  widths.alpha_y = y.number;
  widths.x_texture = x.texture;
  widths.y_texture = y.texture;
}
void read_varying_roughness(SceneContext& context, const JsonObject& object, Material& material) {
  read_varying_widths(context, object, "roughness",
                      {material.alpha_x, material.alpha_y, material.alpha_x_texture, material.alpha_y_texture});
}

// A spectrum, or a texture in its place.
void read_albedo(SceneContext& context, const JsonObject& object, std::string_view key, SpectrumId& spectrum,
                 TextureId& texture) {
  const Json::Value* value = object.find(key);
  if (value == nullptr) return;  // reported, or of no effect
  if (is_texture(*value))
    texture = read_texture_reference(context, *value, false).value_or(no_index);
  else
    spectrum = read_spectrum(context, *value, key, Quantity::reflectance);
}
void read_reflectance(SceneContext& context, const JsonObject& object, Material& material) {
  read_albedo(context, object, "reflectance", material.reflectance, material.reflectance_texture);
}

// Both terms may be left out; the glossy one needs its exponent.
void read_rough(SceneContext& context, const JsonObject& object, Material& material) {
  constexpr Range exponent{0, double{largest_shininess}};
  material.normalized = object.boolean("normalized", false);
  const Quantity quantity = material.normalized != 0 ? Quantity::reflectance : Quantity::brdf;
  if (object.has("kd")) material.kd = read_spectrum(context, *object.find("kd"), "kd", quantity);
  if (object.has("ks")) material.ks = read_spectrum(context, *object.find("ks"), "ks", quantity);
  material.shininess = static_cast<float>(object.number("shininess", exponent, 0));
  if (object.has("ks") && !object.has("shininess"))
    context.reader.error(object.value(), "a rough material with 'ks' lacks the required key 'shininess'");
}

// One of three ways to say the index: a metal, which brings its kappa along, a glass, or a spectrum called `index`.
void read_index(SceneContext& context, const JsonObject& object, std::string_view index,
                std::span<const std::string_view> ways, Material& material) {
  const std::string_view way = object.one_of(ways);
  if (way == "metal") {
    const MetalSpectra metal = read_metal(context, *object.find("metal"));
    material.eta = metal.eta;
    material.kappa = metal.kappa;
    if (object.has("kappa")) context.reader.error(*object.find("kappa"), "'metal' and 'kappa' exclude each other");
  }
  if (way == "glass") material.eta = read_glass(context, *object.find("glass"));
  if (way == index) material.eta = read_spectrum(context, *object.find(index), index, Quantity::eta);
  if (way != "metal" && object.has("kappa"))
    material.kappa = read_spectrum(context, *object.find("kappa"), "kappa", Quantity::kappa);
}

// The metal of index 1 + i kappa that reflects so much along the normal, as a spectrum or a texture.
void read_metal_reflectance(SceneContext& context, const Json::Value& value, SpectrumId& eta, SpectrumId& kappa_id,
                            TextureId& texture) {
  SpectrumSet& spectra = context.scene.spectra;
  eta = unit_spectrum;
  if (is_texture(value)) {
    texture = read_texture_reference(context, value, false).value_or(no_index);
    return;
  }
  Samples kappa = spectra.samples(read_spectrum(context, value, "reflectance", Quantity::reflectance));
  for (double& sample : kappa) {
    const double r = std::clamp(sample, 0.0, 0.9999);
    sample = 2 * std::sqrt(r / (1 - r));
  }
  kappa_id = spectra.add_samples(kappa).id;
}

void read_conductor(SceneContext& context, const JsonObject& object, Material& material) {
  constexpr std::string_view ways[] = {"metal", "eta", "reflectance"};
  read_index(context, object, "eta", ways, material);
  if (object.has("reflectance"))
    read_metal_reflectance(context, *object.find("reflectance"), material.eta, material.kappa,
                           material.reflectance_texture);
  if (object.has("reflectance") && object.has("kappa"))
    context.reader.error(*object.find("kappa"), "'reflectance' and 'kappa' exclude each other");
  if (object.has("eta") && !object.has("kappa"))
    context.reader.error(object.value(), "a conductor with 'eta' lacks the required key 'kappa'");
  read_varying_roughness(context, object, material);
}

// Where light can go inside: how the inside is told from what overlaps it, or that there is none.
void read_inside(SceneContext& context, const JsonObject& object, Material& material) {
  material.priority = object.integer("priority", 1, largest_priority, 0);
  material.thin = object.boolean("thin", false);
  const bool absorbs = context.scene.spectra.max_value(material.kappa) > 0;
  if (object.has("thickness")) {
    if (material.thin == 0) context.reader.error(*object.find("thickness"), "'thickness' belongs to 'thin' only");
    material.thickness = context.metres(object.number("thickness", positive, 1));
  } else if (material.thin != 0 && absorbs) {
    context.reader.error(object.value(), "a thin material with 'kappa' lacks the required key 'thickness'");
  }
  if (material.thin != 0 && object.has("priority"))
    context.reader.error(*object.find("priority"), "'thin' and 'priority' exclude each other: there is no inside");
}

void read_dielectric(SceneContext& context, const JsonObject& object, Material& material) {
  constexpr std::string_view ways[] = {"glass", "eta"};
  read_index(context, object, "eta", ways, material);
  if (context.scene.spectra.max_value(material.kappa) >= double{refracting_kappa})
    context.reader.error(*object.find("kappa"),
                         "'kappa' reaches 0.01, where matter is opaque; a dielectric's stays below it, the type "
                         "'smooth' may have any");
  read_inside(context, object, material);
  read_varying_roughness(context, object, material);
  const bool varies = material.alpha_x_texture != no_index || material.alpha_y_texture != no_index;
  if (material.thin != 0 && (varies || std::max(material.alpha_x, material.alpha_y) >= smooth_alpha))
    context.reader.error(*object.find("roughness"), "'thin' and 'roughness' exclude each other");
}

void read_smooth(SceneContext& context, const JsonObject& object, Material& material) {
  constexpr std::string_view ways[] = {"metal", "glass", "n"};
  read_index(context, object, "n", ways, material);
  read_inside(context, object, material);
}

// Reflects everything: the limit of a large kappa.
Material mirror(SpectrumSet& spectra) {
  Material material;
  material.kind = MaterialKind::conductor;
  material.eta = unit_spectrum;
  material.kappa = spectra.add_constant(1e8).id;
  return material;
}

void read_coated(SceneContext& context, const JsonObject& object, Material& material) {
  read_reflectance(context, object, material);
  constexpr std::string_view ways[] = {"glass", "eta"};
  const std::string_view way = object.one_of(ways);
  if (way == "glass") material.eta = read_glass(context, *object.find("glass"));
  if (way == "eta") material.eta = read_spectrum(context, *object.find("eta"), "eta", Quantity::eta);
  material.alpha_x = material.alpha_y = static_cast<float>(object.number("roughness", not_negative, 0));
}

void read_sheet(SceneContext& context, const JsonObject& object, Material& material) {
  material.kind = MaterialKind::diffuse_transmission;
  read_reflectance(context, object, material);
  read_albedo(context, object, "transmittance", material.transmittance, material.transmittance_texture);
}

// Of two entries of "materials".
void read_mix(SceneContext& context, const JsonObject& object, Material& material) {
  material.kind = MaterialKind::mix;
  const auto part = [&](std::string_view key) -> Entity {
    const Json::Value* value = object.find(key);
    if (value == nullptr) return {};
    const std::string name = context.reader.text(*value, key);
    const auto found = context.entities.find(name);
    if (found != context.entities.end()) return found->second.entity;
    if (!name.empty())
      context.reader.error(*value, fmt::format("unknown material '{}'{}", printable_text(name),
                                               did_you_mean_key(name, context.entities)));
    return {};
  };
  material.mix.first = part("first");
  material.mix.second = part("second");
  if (!object.has("amount")) return;
  const NumberOrTexture amount = read_number_or_texture(context, *object.find("amount"), "amount", unit_interval);
  material.mix.amount = amount.number;
  material.mix.amount_texture = amount.texture;
}

// What is under the layer: a diffuse albedo, or a metal.
void read_base(SceneContext& context, const JsonObject& object, Material& material) {
  Layer& layer = material.layer;
  constexpr std::string_view bases[] = {"reflectance", "base_metal", "base_eta", "base_reflectance"};
  const std::string_view base = object.one_of(bases);
  if (base == "reflectance") read_reflectance(context, object, material);
  if (base == "base_reflectance") {
    read_metal_reflectance(context, *object.find(base), layer.base_eta, layer.base_kappa, material.reflectance_texture);
  }
  if (base == "base_metal") {
    const MetalSpectra metal = read_metal(context, *object.find("base_metal"));
    layer.base_eta = metal.eta;
    layer.base_kappa = metal.kappa;
  }
  if (base == "base_eta") {
    layer.base_eta = read_spectrum(context, *object.find("base_eta"), "base_eta", Quantity::eta);
    if (!object.has("base_kappa"))
      context.reader.error(object.value(), "a layered material with 'base_eta' lacks the required key 'base_kappa'");
  }
  if (object.has("base_kappa"))
    layer.base_kappa = read_spectrum(context, *object.find("base_kappa"), "base_kappa", Quantity::kappa);
  if (base != "reflectance") layer.base = LayerBase::conductor;
  for (const std::string_view key : {"base_kappa", "base_roughness"})
    if (base == "reflectance" && object.has(key))
      context.reader.error(*object.find(key), fmt::format("'reflectance' and '{}' exclude each other", key));
  for (const std::string_view other : {"base_metal", "base_reflectance"})
    if (base == other && object.has("base_kappa"))
      context.reader.error(*object.find("base_kappa"), fmt::format("'{}' and 'base_kappa' exclude each other", other));
  read_varying_widths(context, object, "base_roughness",
                      {layer.base_alpha_x, layer.base_alpha_y, layer.base_alpha_x_texture, layer.base_alpha_y_texture});
}

// pbrt's coat.
void read_layered(SceneContext& context, const JsonObject& object, Material& material) {
  constexpr uint32_t most = 0x7fffffff;
  material.kind = MaterialKind::layered;
  read_base(context, object, material);
  constexpr std::string_view ways[] = {"glass", "eta"};
  const std::string_view way = object.one_of(ways);
  if (way == "glass") material.eta = read_glass(context, *object.find("glass"));
  if (way == "eta") material.eta = read_spectrum(context, *object.find("eta"), "eta", Quantity::eta);
  read_varying_roughness(context, object, material);
  Layer& layer = material.layer;
  const auto varying = [&](std::string_view key, const Range& range, float& number, TextureId& texture) {
    if (!object.has(key)) return;
    const NumberOrTexture read = read_number_or_texture(context, *object.find(key), key, range);
    number = read.number;
    texture = read.texture;
  };
  varying("optical_thickness", not_negative, layer.thickness, layer.thickness_texture);
  varying("asymmetry", {-1, 1, true, true}, layer.asymmetry, layer.asymmetry_texture);
  layer.max_depth = object.integer("max_depth", 0, most, layer.max_depth);
  layer.walks = object.integer("walks", 1, most, layer.walks);
  read_albedo(context, object, "albedo", layer.albedo, layer.albedo_texture);
}

// A fibre along the tangent; v goes across it.
void read_hair(SceneContext& context, const JsonObject& object, Material& material) {
  material.kind = MaterialKind::hair;
  Hair& hair = material.hair;
  constexpr std::string_view ways[] = {"sigma_a", "reflectance"};
  const std::string_view way = object.one_of(ways);
  if (way == "sigma_a") hair.sigma_a = read_spectrum(context, *object.find(way), way, Quantity::kappa);
  hair.beta_m = static_cast<float>(object.number("beta_m", unit_interval, double{hair.beta_m}));
  hair.beta_n = static_cast<float>(object.number("beta_n", unit_interval, double{hair.beta_n}));
  if (way == "reflectance") {
    SpectrumId color = zero_spectrum;
    read_albedo(context, object, way, color, material.reflectance_texture);
    Samples samples = context.scene.spectra.samples(color);
    for (double& sample : samples) sample = hair_absorption_of_reflectance(sample, double{hair.beta_n});
    if (material.reflectance_texture == no_index) hair.sigma_a = context.scene.spectra.add_samples(samples).id;
  }
  hair.tilt_deg = static_cast<float>(object.number("tilt", Range{-20, 20}, double{hair.tilt_deg}));
  material.eta = context.scene.spectra.add_constant(object.number("eta", Range{1, largest_float}, 1.55)).id;
}

Material read_kind(SceneContext& context, const JsonObject& object) {
  Material material;
  if (object.type() == "diffuse") {
    material.kind = MaterialKind::diffuse;
    read_reflectance(context, object, material);
    return material;
  }
  if (object.type() == "rough") {
    material.kind = MaterialKind::rough;
    read_rough(context, object, material);
    return material;
  }
  if (object.type() == "interface") {
    material.kind = MaterialKind::interface;
    return material;
  }
  if (object.type() == "mirror") return mirror(context.scene.spectra);
  using Read = void (*)(SceneContext&, const JsonObject&, Material&);
  constexpr std::pair<std::string_view, Read> others[] = {
      {"layered", read_layered}, {"diffuse_transmission", read_sheet}, {"mix", read_mix}, {"hair", read_hair}};
  for (const auto& [type, read] : others)
    if (object.type() == type) {
      read(context, object, material);
      return material;
    }
  material.fresnel = static_cast<FresnelModel>(object.choice("fresnel", fresnel_names, 0));
  if (object.type() == "coated") {
    material.kind = MaterialKind::coated;
    read_coated(context, object, material);
  } else if (object.type() == "conductor") {
    material.kind = MaterialKind::conductor;
    read_conductor(context, object, material);
  } else if (object.type() == "smooth") {
    material.kind = MaterialKind::smooth;
    read_smooth(context, object, material);
  } else {
    material.kind = MaterialKind::dielectric;
    read_dielectric(context, object, material);
  }
  return material;
}

}  // namespace

std::optional<Material> read_material(SceneContext& context, const Json::Value& value) {
  const JsonObject object(context.reader, value, "material");
  if (!object.is_valid()) return std::nullopt;
  Material material = read_kind(context, object);
  read_bump(context, object, material);
  return material;
}

}  // namespace metamer
