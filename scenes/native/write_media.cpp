#include <fmt/format.h>

#include "scenes/native/write_parts.h"
#include "systems/freeze.h"

namespace metamer {
namespace {

JsonText write_medium(WriteContext& context, const Medium& medium) {
  JsonText object = JsonText::object();
  object.add("type", JsonText::string("homogeneous"));
  const auto spectrum = [&](std::string_view key, SpectrumId id) {
    if (id != zero_spectrum) object.add(key, context.spectra.write(id));
  };
  const auto number = [&](std::string_view key, float value, float fallback) {
    if (value != fallback) object.add(key, JsonText::number(value));
  };
  spectrum("sigma_a", medium.sigma_a);
  spectrum("sigma_s", medium.sigma_s);
  number("scale", medium.scale, 1);
  number("g", medium.g, 0);
  number("g2", medium.g2, 0);
  number("g2_share", medium.g2_share, 0);
  if (context.own_spectra.max_value(medium.sigma_a) > 0) {  // what absorbs nothing emits nothing
    spectrum("emission", medium.emission);
    number("emission_scale", medium.emission_scale, 1);
  }
  return object;
}

}  // namespace

JsonText write_media(WriteContext& context) {
  const Registry& registry = context.scene.registry;
  const Table<Medium>& table = registry.table<Medium>();
  JsonText media = JsonText::object().break_lines();
  UniqueNames names(' ');
  for (uint32_t row = 0; row < table.size(); ++row) {
    const Entity entity = table.owner(row);
    const Name own = registry.get<Name>(entity);
    const std::string name =
        names.take(own.name == no_index ? fmt::format("medium {}", row + 1) : context.scene.names[own.name]);
    if (entity.index >= context.medium_names.size()) context.medium_names.resize(entity.index + 1);
    context.medium_names[entity.index] = name;
    const Medium medium = homogeneous_medium(context.scene, entity, context.own_spectra, context.remarks);
    media.add(name, write_medium(context, medium));
  }
  return media;
}

JsonText write_medium_slot(const WriteContext& context, const MediumSlot& slot) {
  JsonText object = JsonText::object();
  if (!slot.inside.is_null()) object.add("inside", JsonText::string(context.medium_names[slot.inside.index]));
  if (!slot.outside.is_null()) object.add("outside", JsonText::string(context.medium_names[slot.outside.index]));
  return object;
}

}  // namespace metamer
