#include "engine/spectrum/observers.h"

#include <algorithm>

namespace metamer {
namespace {

constexpr std::array<std::string_view, observer_count> names = {"cie1931", "cie1964", "cie2015-2", "cie2015-10",
                                                                "stiles-burch1955"};
constexpr std::array<std::string_view, observer_count> files = {"cmf/cie1931_2deg_xyz", "cmf/cie1964_10deg_xyz",
                                                                "cmf/cie2015_2deg_xyz", "cmf/cie2015_10deg_xyz",
                                                                "cmf/stiles_burch1955_2deg_rgb"};

ObserverTable make_table(std::string_view file) {
  const DataTable& data = require_embedded_data(file);
  ObserverTable table;
  for (size_t c = 0; c < 3; ++c) {
    table.matching[c] = resample(data, c + 1, Extend::zero);
    table.integrals[c] = 0.0;
    for (size_t i = 0; i < lambda_stride; ++i) {
      table.columns[c * lambda_stride + i] = static_cast<float>(table.matching[c][std::min(i, lambda_count - 1)]);
    }
    for (const double value : table.matching[c]) table.integrals[c] += value;
  }
  return table;
}

}  // namespace

const ObserverTable& observer_table(Observer observer) {
  static const std::array<ObserverTable, observer_count> tables = {
      make_table(files[0]), make_table(files[1]), make_table(files[2]), make_table(files[3]), make_table(files[4])};
  return tables[static_cast<size_t>(observer)];
}

std::array<double, 3> observer_value(Observer observer, double lambda_nm) {
  if (!(lambda_nm >= lambda_min_nm && lambda_nm <= lambda_max_nm)) return {0.0, 0.0, 0.0};
  const ObserverTable& table = observer_table(observer);
  return {interpolate(table.matching[0], lambda_nm), interpolate(table.matching[1], lambda_nm),
          interpolate(table.matching[2], lambda_nm)};
}

WavelengthRange observer_range(Observer observer) {
  const DataTable& data = require_embedded_data(files[static_cast<size_t>(observer)]);
  return {data.at(0, 0), data.at(data.rows() - 1, 0)};
}

std::span<const std::string_view> observer_names() { return names; }

std::string_view observer_name(Observer observer) { return names[static_cast<size_t>(observer)]; }

std::optional<Observer> find_observer(std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Observer>(found - names.begin());
}

}  // namespace metamer
