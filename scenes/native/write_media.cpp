#include <fmt/format.h>

#include <array>

#include "scenes/native/write_parts.h"

namespace metamer {
namespace {

JsonText corner(const glm::vec3& p) { return JsonText::numbers(std::array{p.x, p.y, p.z}); }

// A grid's side file, and what its values are.
JsonText write_grid(WriteContext& context, GridId id) {
  const Grid& grid = context.scene.grids[id];
  JsonText object = JsonText::object();
  object.add("file", JsonText::string(context.folder + "/" + context.grid_file_name(id)));
  if (grid.channels == 3 && grid.color_space != ColorSpace::srgb)
    object.add("space", JsonText::string(color_space_name(grid.color_space)));
  return object;
}

void write_grids(WriteContext& context, Entity entity, bool absorbs, JsonText& object) {
  const Registry& registry = context.scene.registry;
  const MediumGrid grids = registry.get<MediumGrid>(entity);
  const auto add = [&](std::string_view key, GridId id) {
    if (id != no_index) object.add(key, write_grid(context, id));
  };
  add("density", grids.density);
  add("sigma_a_grid", grids.sigma_a);
  add("sigma_s_grid", grids.sigma_s);
  add("emission_grid", grids.emission);
  if (grids.temperature != no_index && absorbs) {
    JsonText temperature = write_grid(context, grids.temperature);
    if (grids.temperature_offset != 0) temperature.add("offset", JsonText::number(grids.temperature_offset));
    if (grids.temperature_scale != 1) temperature.add("scale", JsonText::number(grids.temperature_scale));
    if (grids.blackbody == BlackbodyUnit::peak) temperature.add("normalized", JsonText::boolean(true));
    object.add("temperature", std::move(temperature));
  }
  if (grids.lookup == GridLookup::stochastic) object.add("lookup", JsonText::string("stochastic"));
  object.add("box", JsonText::array().add(corner(grids.lower)).add(corner(grids.upper)));
  if (registry.has<Transform>(entity)) object.add("transform", write_transform(registry.get<Transform>(entity)));
}

JsonText write_medium(WriteContext& context, Entity entity) {
  const Medium medium = context.scene.registry.get<Medium>(entity);
  const bool has_grids = context.scene.registry.has<MediumGrid>(entity);
  JsonText object = JsonText::object();
  object.add("type", JsonText::string(has_grids ? "grid" : "homogeneous"));
  const MediumGrid grids = has_grids ? context.scene.registry.get<MediumGrid>(entity) : MediumGrid{};
  const auto spectrum = [&](std::string_view key, SpectrumId id, bool is_one_without = false) {
    if (id != zero_spectrum || is_one_without) object.add(key, context.spectra.write(id));
  };
  const auto number = [&](std::string_view key, float value, float fallback) {
    if (value != fallback) object.add(key, JsonText::number(value));
  };
  spectrum("sigma_a", medium.sigma_a, grids.sigma_a != no_index);
  spectrum("sigma_s", medium.sigma_s, grids.sigma_s != no_index);
  number("scale", medium.scale, 1);
  number("g", medium.g, 0);
  number("g2", medium.g2, 0);
  number("g2_share", medium.g2_share, 0);
  const bool absorbs = context.own_spectra.max_value(medium.sigma_a) > 0;
  if (absorbs) {  // what absorbs nothing emits nothing
    if (grids.temperature == no_index) spectrum("emission", medium.emission);
    number("emission_scale", medium.emission_scale, 1);
  }
  if (has_grids) write_grids(context, entity, absorbs, object);
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
    media.add(name, write_medium(context, entity));
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
