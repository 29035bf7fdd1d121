#include <fmt/format.h>

#include <algorithm>

#include "scenes/native/components.h"
#include "scenes/native/grids.h"
#include "scenes/native/spectra.h"

namespace metamer {
namespace {

// sigma_s = albedo sigma_t, and sigma_a the rest of it.
void read_albedo(SceneContext& context, const JsonObject& object, Medium& medium) {
  const JsonReader& reader = context.reader;
  SpectrumSet& spectra = context.scene.spectra;
  for (const std::string_view other : {"sigma_a", "sigma_s"})
    if (object.has(other))
      reader.error(*object.find(other), fmt::format("'{}' does not go with 'albedo' and 'sigma_t'", other));
  if (!object.has("albedo") || !object.has("sigma_t"))
    return reader.error(object.value(), "'albedo' and 'sigma_t' go together only: one of them is missing");
  const SpectrumId albedo = read_spectrum(context, *object.find("albedo"), "albedo", Quantity::reflectance);
  const SpectrumId sigma_t = read_spectrum(context, *object.find("sigma_t"), "sigma_t", Quantity::coefficient);
  if (spectra.is_constant(albedo)) {
    const double scattered = spectra.value(albedo, 550);
    medium.sigma_s = spectra.scaled(sigma_t, scattered).id;
    medium.sigma_a = spectra.scaled(sigma_t, 1 - scattered).id;
    return;
  }
  const Samples share = spectra.samples(albedo), extinction = spectra.samples(sigma_t);
  Samples scattering = share, absorption = share;
  for (size_t i = 0; i < share.size(); ++i) {
    scattering[i] = share[i] * extinction[i];
    absorption[i] = std::max(0.0, 1 - share[i]) * extinction[i];
  }
  medium.sigma_s = spectra.add_samples(scattering).id;
  medium.sigma_a = spectra.add_samples(absorption).id;
}

// Coefficients are per unit of length of the file. Those of grids count as 1 where only the grid is given.
Medium read_medium(SceneContext& context, const JsonObject& object) {
  constexpr Range open_unit{-1, 1, true, true};
  Medium medium;
  const auto spectrum = [&](std::string_view key, Quantity quantity) {
    return object.has(key) ? read_spectrum(context, *object.find(key), key, quantity) : zero_spectrum;
  };
  medium.sigma_a = spectrum("sigma_a", Quantity::coefficient);
  medium.sigma_s = spectrum("sigma_s", Quantity::coefficient);
  if (object.has("sigma_a_grid") && !object.has("sigma_a")) medium.sigma_a = unit_spectrum;
  if (object.has("sigma_s_grid") && !object.has("sigma_s")) medium.sigma_s = unit_spectrum;
  if (object.has("albedo") || object.has("sigma_t")) read_albedo(context, object, medium);
  medium.emission = spectrum("emission", Quantity::light);
  medium.scale = static_cast<float>(object.number("scale", not_negative, 1) / context.metres_per_unit);
  medium.emission_scale = object.number_f("emission_scale", not_negative, 1);
  medium.g = object.number_f("g", open_unit, 0);
  medium.g2 = object.number_f("g2", open_unit, 0);
  medium.g2_share = object.number_f("g2_share", Range{0, 1, false, false}, 0);
  for (const std::string_view glow : {"emission", "temperature"})
    if (object.has(glow) && !(context.scene.spectra.max_value(medium.sigma_a) > 0))
      context.reader.error(*object.find(glow),
                           fmt::format("what absorbs nothing emits nothing: '{}' needs a 'sigma_a'", glow));
  return medium;
}

}  // namespace

void read_media(SceneContext& context, const Json::Value& media) {
  if (!media.isObject()) return context.reader.expected(media, "media", "an object of named media");
  Registry& registry = context.scene.registry;
  MediumGrids grids(context);
  for (const auto& [name, value] : members_in_order(media)) {
    const Entity entity = registry.create();
    registry.set(entity, Source{context.file, context.reader.document().at_key(*value).line});
    registry.set(entity, Name{context.scene.names.add(name)});
    context.media.emplace(name, entity);
    context.reader.set_subject(fmt::format("medium '{}'", printable_text(name)));
    const JsonObject object(context.reader, *value, "medium");
    registry.set(entity, object.is_valid() ? read_medium(context, object) : Medium{});
    if (object.is_valid() && object.type() == "grid") grids.add(entity, object);
    context.reader.set_subject({});
  }
  grids.read_files();
}

MediumSlot read_medium_slot(const SceneContext& context, const Json::Value& value) {
  const JsonObject object(context.reader, value, *find_object_spec("entity_media"), "media");
  if (!object.is_valid()) return {};
  const auto named = [&](std::string_view key) {
    const Json::Value* name = object.find(key);
    if (name == nullptr) return Entity{};
    const std::string text = context.reader.text(*name, key);
    const auto found = context.media.find(text);
    if (found != context.media.end()) return found->second;
    if (!text.empty())
      context.reader.error(
          *name, fmt::format("unknown medium '{}'{}", printable_text(text), did_you_mean_key(text, context.media)));
    return Entity{};
  };
  return {named("inside"), named("outside")};
}

}  // namespace metamer
