#include "engine/sampling/points.h"
#include "systems/dimensions.h"
#include "systems/systems.h"

namespace metamer {
namespace {

RayHit ray_hit(const World& world, const PathStream& paths, const HitStream& hits, uint32_t path) {
  RayHit hit;
  for (size_t i = 0; i < 3; ++i) {
    hit.origin[i] = paths.origin[i][path];
    hit.direction[i] = paths.direction[i][path];
  }
  if (world.has_motion) hit.time = paths.time[path];
  hit.object = hits.object[path];
  hit.primitive = hits.primitive[path];
  hit.distance = hits.distance[path];
  hit.u = hits.u[path];
  return hit;
}

// Of mixed materials, one within the other, the one that the path meets: its kind, and its row in `material`.
uint32_t choose_mixed(const World& world, uint32_t depth, const PathStream& paths, const HitStream& hits, uint32_t path,
                      uint32_t* material) {
  const PointKeyScalar key{paths.pixel_seed[path], paths.index[path]};
  uint32_t kind = mixed_kind;
  for (uint32_t level = 0; kind == mixed_kind; ++level) {
    const MixRow& mix = world.mixes[*material];
    float amount = mix.amount;
    if (mix.amount_texture != no_index)
      amount = number_at_hit(world, mix.amount_texture, ray_hit(world, paths, hits, path));
    const size_t which = sample_1d(key, nested_mix_dimension(depth, level)) < amount ? 1 : 0;
    kind = mix.kind[which];
    *material = mix.row[which];
  }
  return kind;
}

}  // namespace

void sort_hits(const World& world, uint32_t depth, const PathStream& paths, HitStream& hits, uint32_t* order,
               Groups& groups) {
  const uint32_t size = paths.size;
  constexpr uint32_t miss = static_cast<uint32_t>(ShadeKind::miss), phase = static_cast<uint32_t>(ShadeKind::phase);
  const uint32_t* kind_of_object = world.objects.shade_kind.data();
  uint8_t kinds[batch_capacity];
  uint32_t counts[shade_kind_count] = {};
  for (uint32_t i = 0; i < size; ++i) {
    const uint32_t object = hits.object[i];
    uint32_t kind = miss;
    if (object == scattered) {
      kind = phase;
    } else if (object != no_index) {
      kind = kind_of_object[object];
      hits.material[i] = world.objects.material[object];
      if (kind == mixed_kind) kind = choose_mixed(world, depth, paths, hits, i, &hits.material[i]);
    }
    kinds[i] = static_cast<uint8_t>(kind);
    ++counts[kind];
  }
  uint32_t cursor[shade_kind_count];
  uint32_t begin = 0;
  for (uint32_t kind = 0; kind < shade_kind_count; ++kind) {
    groups[kind] = {begin, begin + counts[kind]};
    cursor[kind] = begin;
    const uint32_t padded = groups[kind].padded_end();
    for (uint32_t lane = groups[kind].end; lane < padded; ++lane) order[lane] = dead_lane;
    begin = padded;
  }
  for (uint32_t i = 0; i < size; ++i) order[cursor[kinds[i]]++] = i;
}

}  // namespace metamer
