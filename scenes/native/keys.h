// Every object of the native format and the keys it may have: the one list that the reader checks against, and that
// the schema and the page are tested against.
#pragma once
#include <span>
#include <string_view>

namespace metamer {

struct KeySpec {
  std::string_view name;
  bool is_required = false;
};

// Named as in "$defs" of the schema; objects that come in types are called "geometry.sphere" and so on.
struct ObjectSpec {
  std::string_view name;
  std::span<const KeySpec> keys;
};

std::span<const ObjectSpec> all_object_specs();

// The spec of that exact name, or null.
const ObjectSpec* find_object_spec(std::string_view name);

}  // namespace metamer
