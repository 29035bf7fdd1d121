// Arrays of rows of numbers, such as positions.
#pragma once
#include <fmt/format.h>

#include <array>

#include "engine/simd/column.h"
#include "scenes/native/scene_context.h"

namespace metamer {

// Rows of as many numbers as a V has.
template <class V>
void read_rows(const SceneContext& context, const Json::Value& value, std::string_view what, Column<V>& column) {
  constexpr size_t n = sizeof(V) / sizeof(float);
  if (!context.reader.array(value, what, fmt::format("arrays of {} numbers", n))) return;
  column.resize(value.size());
  for (Json::ArrayIndex i = 0; i < value.size(); ++i) {
    std::array<double, n> row{};
    context.reader.numbers(value[i], fmt::format("{}[{}]", what, i), any_number, row);
    for (size_t c = 0; c < n; ++c) column[i][static_cast<int>(c)] = static_cast<float>(row[c]);
  }
}

}  // namespace metamer
