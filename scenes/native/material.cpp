#include <fmt/format.h>

#include "scenes/native/components.h"
#include "scenes/native/spectra.h"
#include "systems/bsdf/limits.h"

namespace metamer {
namespace {

constexpr std::string_view fresnel_names[] = {"exact", "schlick"};  // in the order of FresnelModel

// GGX's alpha itself, one number or one along each tangent.
void read_roughness(const SceneContext& context, const JsonObject& object, Material& material) {
  const Json::Value* value = object.find("roughness");
  if (value == nullptr) return;
  std::array<double, 2> alpha{};
  if (value->isArray()) {
    context.reader.numbers(*value, "roughness", unit_interval, alpha);
  } else {
    alpha.fill(context.reader.number(*value, "roughness", unit_interval, 0));
  }
  material.alpha_x = static_cast<float>(alpha[0]);
  material.alpha_y = static_cast<float>(alpha[1]);
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

void read_conductor(SceneContext& context, const JsonObject& object, Material& material) {
  constexpr std::string_view ways[] = {"metal", "eta"};
  const std::string_view way = object.one_of(ways);
  if (way == "metal") {
    const MetalSpectra metal = read_metal(context, *object.find("metal"));
    material.eta = metal.eta;
    material.kappa = metal.kappa;
    if (object.has("kappa")) context.reader.error(*object.find("kappa"), "'metal' and 'kappa' exclude each other");
  } else if (way == "eta") {
    material.eta = read_spectrum(context, *object.find("eta"), "eta", Quantity::eta);
    if (!object.has("kappa"))
      context.reader.error(object.value(), "a conductor with 'eta' lacks the required key 'kappa'");
  }
  if (way != "metal" && object.has("kappa"))
    material.kappa = read_spectrum(context, *object.find("kappa"), "kappa", Quantity::kappa);
  read_roughness(context, object, material);
}

void read_dielectric(SceneContext& context, const JsonObject& object, Material& material) {
  constexpr std::string_view ways[] = {"glass", "eta"};
  const std::string_view way = object.one_of(ways);
  if (way == "glass") material.eta = read_glass(context, *object.find("glass"));
  if (way == "eta") material.eta = read_spectrum(context, *object.find("eta"), "eta", Quantity::eta);
}

void read_coated(SceneContext& context, const JsonObject& object, Material& material) {
  if (object.has("reflectance"))
    material.reflectance = read_spectrum(context, *object.find("reflectance"), "reflectance", Quantity::reflectance);
  read_dielectric(context, object, material);
  material.alpha_x = material.alpha_y = static_cast<float>(object.number("roughness", unit_interval, 0));
}

}  // namespace

std::optional<Material> read_material(SceneContext& context, const Json::Value& value) {
  const JsonObject object(context.reader, value, "material");
  if (!object.is_valid()) return std::nullopt;
  Material material;
  if (object.type() == "diffuse") {
    material.kind = MaterialKind::diffuse;
    if (object.has("reflectance"))
      material.reflectance = read_spectrum(context, *object.find("reflectance"), "reflectance", Quantity::reflectance);
    return material;
  }
  if (object.type() == "rough") {
    material.kind = MaterialKind::rough;
    read_rough(context, object, material);
    return material;
  }
  material.fresnel = static_cast<FresnelModel>(object.choice("fresnel", fresnel_names, 0));
  if (object.type() == "coated") {
    material.kind = MaterialKind::coated;
    read_coated(context, object, material);
  } else if (object.type() == "conductor") {
    material.kind = MaterialKind::conductor;
    read_conductor(context, object, material);
  } else {
    material.kind = MaterialKind::dielectric;
    read_dielectric(context, object, material);
  }
  return material;
}

}  // namespace metamer
