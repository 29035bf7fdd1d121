#include <cstring>

#include "systems/systems.h"

namespace metamer {

void sort_hits(const World& world, uint32_t size, const HitStream& hits, uint32_t* order, Groups& groups) {
  constexpr uint32_t miss = static_cast<uint32_t>(ShadeKind::miss), phase = static_cast<uint32_t>(ShadeKind::phase);
  const uint32_t* kind_of_object = world.objects.shade_kind.data();
  uint8_t kinds[batch_capacity];
  uint32_t counts[shade_kind_count] = {};
  for (uint32_t i = 0; i < size; ++i) {
    const uint32_t object = hits.object[i];
    const uint32_t kind = object < scattered ? kind_of_object[object] : object == scattered ? phase : miss;
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
