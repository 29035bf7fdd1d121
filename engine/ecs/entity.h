// An entity is a name for a set of components: a slot and the generation of what lives in it.
#pragma once
#include <compare>
#include <cstdint>

namespace metamer {

inline constexpr uint32_t no_index = 0xffffffffu;

struct Entity {
  uint32_t index = no_index;
  uint32_t generation = 0;
  bool is_null() const { return index == no_index; }
  friend auto operator<=>(const Entity&, const Entity&) = default;
};

}  // namespace metamer
