// The measured data of engine/spectrum/data, compiled in.
#pragma once
#include <cstddef>
#include <span>
#include <string_view>

namespace metamer {

struct DataTable {
  std::string_view name;    // path below engine/spectrum/data without ".csv": "nk/Au"
  std::string_view source;  // the publication
  std::string_view header;  // column names, comma-separated; the first is the abscissa where there is one
  size_t columns;
  std::span<const double> values;  // row by row

  size_t rows() const { return values.size() / columns; }
  double at(size_t row, size_t column) const { return values[row * columns + column]; }
};

// All tables, sorted by name.
std::span<const DataTable> embedded_data();

// The table of that exact name, or null.
const DataTable* find_embedded_data(std::string_view name);

// The table of that exact name; stops the program if there is none (a broken build).
const DataTable& require_embedded_data(std::string_view name);

}  // namespace metamer
