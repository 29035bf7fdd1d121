#include <fmt/format.h>

#include "scenes/native/components.h"
#include "scenes/native/spectra.h"

namespace metamer {
namespace {

// Coefficients are per unit of length of the file.
Medium read_medium(SceneContext& context, const JsonObject& object) {
  constexpr Range open_unit{-1, 1, true, true};
  Medium medium;
  const auto spectrum = [&](std::string_view key, Quantity quantity) {
    return object.has(key) ? read_spectrum(context, *object.find(key), key, quantity) : zero_spectrum;
  };
  medium.sigma_a = spectrum("sigma_a", Quantity::coefficient);
  medium.sigma_s = spectrum("sigma_s", Quantity::coefficient);
  medium.emission = spectrum("emission", Quantity::light);
  medium.scale = static_cast<float>(object.number("scale", not_negative, 1) / context.metres_per_unit);
  medium.emission_scale = object.number_f("emission_scale", not_negative, 1);
  medium.g = object.number_f("g", open_unit, 0);
  medium.g2 = object.number_f("g2", open_unit, 0);
  medium.g2_share = object.number_f("g2_share", Range{0, 1, false, false}, 0);
  if (object.has("emission") && !(context.scene.spectra.max_value(medium.sigma_a) > 0))
    context.reader.error(*object.find("emission"), "what absorbs nothing emits nothing: 'emission' needs a 'sigma_a'");
  return medium;
}

}  // namespace

void read_media(SceneContext& context, const Json::Value& media) {
  if (!media.isObject()) return context.reader.expected(media, "media", "an object of named media");
  Registry& registry = context.scene.registry;
  for (const auto& [name, value] : members_in_order(media)) {
    const Entity entity = registry.create();
    registry.set(entity, Source{context.file, context.reader.document().at_key(*value).line});
    registry.set(entity, Name{context.scene.names.add(name)});
    context.media.emplace(name, entity);
    context.reader.set_subject(fmt::format("medium '{}'", printable_text(name)));
    const JsonObject object(context.reader, *value, "medium");
    registry.set(entity, object.is_valid() ? read_medium(context, object) : Medium{});
    context.reader.set_subject({});
  }
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
