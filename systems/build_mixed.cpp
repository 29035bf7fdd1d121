#include <fmt/format.h>

#include <cmath>

#include "systems/build_materials.h"

namespace metamer {
namespace {

// Rows of mixes, made when they are asked for, so that mixes may name others that come later.
struct Mixer {
  const Scene& scene;
  World& world;
  Diagnostics& diagnostics;
  std::vector<MaterialRow>& rows;  // by entity index; those of other materials are there
  enum class State : uint8_t { unseen, open, made };
  std::vector<State> states;

  void error(Entity entity, const std::string& what) {
    diagnostics.error(scene.location(entity), fmt::format("{}: {}", scene.describe(entity), what));
  }

  MaterialRow row_of(Entity entity) {
    if (!scene.registry.has<Material>(entity)) return {};
    const Material material = scene.registry.get<Material>(entity);
    if (material.kind != MaterialKind::mix) return rows[entity.index];
    State& state = states[entity.index];
    if (state == State::open) {
      error(entity, "it is mixed of itself");
      return {};
    }
    if (state == State::unseen) {
      state = State::open;
      rows[entity.index] = make(entity, material.mix);
      states[entity.index] = State::made;
    }
    return rows[entity.index];
  }

  MaterialRow make(Entity entity, const Mix& mix) {
    if (!std::isfinite(mix.amount)) error(entity, "'amount' is not a number");
    for (const Entity part : {mix.first, mix.second})
      if (!scene.registry.has<Material>(part)) error(entity, "it is mixed of something that is not a material");
    const bool varies = mix.amount_texture != no_index;
    if (!varies && mix.amount <= 0) return row_of(mix.first);
    if (!varies && mix.amount >= 1) return row_of(mix.second);
    MixRow row;
    const MaterialRow parts[2] = {row_of(mix.first), row_of(mix.second)};
    if (parts[0].kind == ShadeKind::interface || parts[1].kind == ShadeKind::interface)
      error(entity, "an interface cannot be mixed with other materials");
    for (size_t k = 0; k < 2; ++k) {
      row.kind[k] = static_cast<uint32_t>(parts[k].kind);
      row.row[k] = parts[k].row;
    }
    row.amount = mix.amount;
    row.amount_texture = mix.amount_texture;
    world.mixes.push_back(row);
    return {static_cast<ShadeKind>(mixed_kind), static_cast<uint32_t>(world.mixes.size() - 1)};
  }
};

}  // namespace

void add_mixes(const Scene& scene, std::vector<MaterialRow>& rows, World& world, Diagnostics& diagnostics) {
  Mixer mixer{scene, world, diagnostics, rows, {}};
  mixer.states.resize(rows.size(), Mixer::State::unseen);
  scene.registry.each<Material>([&](Entity entity, uint32_t) { mixer.row_of(entity); });
}

}  // namespace metamer
