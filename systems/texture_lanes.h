// Lanes in order of the texture program they need, so that each program runs on whole vectors.
#pragma once
#include <algorithm>

#include "engine/ecs/world.h"

namespace metamer {

// Lanes that need something, and what: a program or an image.
struct TexturedLanes {
  uint32_t count = 0;
  uint32_t lane[sorted_capacity], key[sorted_capacity];

  void add(uint32_t new_lane, uint32_t new_key) {
    lane[count] = new_lane;
    key[count++] = new_key;
  }
};

// Those of a group whose material has something at its row, which may lie beyond the column's end.
inline void collect_lanes(const Group& group, const ShadeStream& shade, const Column<uint32_t>& of_material,
                          TexturedLanes& lanes) {
  if (of_material.empty()) return;
  for (uint32_t i = group.begin; i < group.end; ++i) {
    const uint32_t row = shade.material[i];
    if (row < of_material.size() && of_material[row] != no_index) lanes.add(i, of_material[row]);
  }
}

// Counting sorts by the bytes of the key, the lowest first; as many as the largest possible key has.
inline void sort_by_key(size_t key_count, TexturedLanes& lanes) {
  uint32_t lane[sorted_capacity], key[sorted_capacity];
  for (uint32_t shift = 0; shift < 32 && (key_count - 1) >> shift != 0; shift += 8) {
    uint32_t at[257] = {};
    for (uint32_t i = 0; i < lanes.count; ++i) ++at[(lanes.key[i] >> shift & 255) + 1];
    for (uint32_t k = 0; k < 256; ++k) at[k + 1] += at[k];
    for (uint32_t i = 0; i < lanes.count; ++i) {
      const uint32_t to = at[lanes.key[i] >> shift & 255]++;
      lane[to] = lanes.lane[i];
      key[to] = lanes.key[i];
    }
    std::copy_n(lane, lanes.count, lanes.lane);
    std::copy_n(key, lanes.count, lanes.key);
  }
}

// Calls run(key, first lane, number of lanes) for each key; the lanes must be sorted.
template <class Run>
void for_each_key(const TexturedLanes& lanes, const Run& run) {
  for (uint32_t begin = 0; begin < lanes.count;) {
    uint32_t end = begin + 1;
    while (end < lanes.count && lanes.key[end] == lanes.key[begin]) ++end;
    run(lanes.key[begin], lanes.lane + begin, end - begin);
    begin = end;
  }
}

}  // namespace metamer
