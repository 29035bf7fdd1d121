#include "scenes/native/write_spectra.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "engine/spectrum/named_spectra.h"
#include "engine/spectrum/rgb_fit.h"

namespace metamer {
namespace {

// The samples of a table as bytes, to be compared and searched for.
std::string table_content(const SpectrumSet& set, uint32_t table) {
  const SpectrumView view = set.view();
  return {reinterpret_cast<const char*>(view.tables + table * view.table_stride), lambda_count * sizeof(float)};
}

struct BuiltIn {
  std::string_view name;
  float scale;
};

// Every built-in spectrum by the content of its table; of several names the shortest, of those the first.
const std::map<std::string, BuiltIn>& built_in_tables() {
  static const std::map<std::string, BuiltIn> tables([] {
    std::map<std::string, BuiltIn> found;
    SpectrumSet set;
    for (const std::string_view name : spectrum_names()) {
      const SpectrumRow row = set.row(set.add_named(name).value_or(zero_spectrum));
      if (row.table == 0) continue;
      const auto [at, is_new] = found.try_emplace(table_content(set, row.table), BuiltIn{name, row.scale});
      if (!is_new && name.size() < at->second.name.size()) at->second = {name, row.scale};
    }
    return found;
  }());
  return tables;
}

// x to that many decimals, and as the JSON says it.
double rounded(double x, int decimals, std::string& text) {
  text = fmt::format("{}", std::strtod(fmt::format("{:.{}f}", x, decimals).c_str(), nullptr));
  return std::strtod(text.c_str(), nullptr);
}

bool is_fit(const SpectrumRow& row, ColorSpace space, const Color3& rgb) {
  for (const double channel : rgb)
    if (!(channel >= 0 && channel <= 1)) return false;
  const SigmoidCoefficients c = fit_sigmoid(space, rgb).c;
  return static_cast<float>(c[0]) == row.c0 && static_cast<float>(c[1]) == row.c1 && static_cast<float>(c[2]) == row.c2;
}

}  // namespace

JsonText SpectrumWriter::write_reflectance(SpectrumId id) {
  const SpectrumRow& row = set_.row(id);
  if (row.table != 0 || row.scale != 1 || set_.is_constant(id)) return write(id);
  for (size_t space = 0; space < color_space_count; ++space) {
    const Color3 exact = sigmoid_rgb(static_cast<ColorSpace>(space), {row.c0, row.c1, row.c2});
    for (int decimals = 1; decimals <= 6; ++decimals) {
      Color3 rgb;
      std::array<std::string, 3> texts;
      for (size_t c = 0; c < 3; ++c) rgb[c] = rounded(exact[c], decimals, texts[c]);
      if (!is_fit(row, static_cast<ColorSpace>(space), rgb)) continue;
      JsonText numbers = JsonText::array();
      for (const std::string& text : texts) numbers.add(JsonText::decimal(text));
      JsonText object = JsonText::object().add("rgb", std::move(numbers));
      if (space != 0) object.add("space", JsonText::string(color_space_names()[space]));
      return object;
    }
  }
  return write(id);
}

// Samples are read as they are where the largest is from 1/2 to below 1, see SpectrumSet::store_table; a table whose
// largest was rounded up to 1 is halved, which changes no product.
SpectrumWriter::NamedTable SpectrumWriter::define(const std::string& content) {
  std::array<float, lambda_count> samples;
  std::memcpy(samples.data(), content.data(), content.size());
  float largest = 0;
  for (const float sample : samples) largest = std::max(largest, std::abs(sample));
  const float scale = largest < 1 ? 1.0f : 2.0f;
  for (float& sample : samples) sample /= scale;
  NamedTable table{fmt::format("spectrum {}", ++defined_), 1 / scale};
  definitions_.add(table.name, JsonText::object().add("samples", JsonText::numbers(samples)).break_lines());
  return table;
}

const SpectrumWriter::NamedTable& SpectrumWriter::named_table(uint32_t table) {
  const auto known = tables_.find(table);
  if (known != tables_.end()) return known->second;
  const std::string content = table_content(set_, table);
  const auto built_in = built_in_tables().find(content);
  const NamedTable named = built_in != built_in_tables().end()
                               ? NamedTable{std::string(built_in->second.name), built_in->second.scale}
                               : define(content);
  return tables_.emplace(table, named).first->second;
}

JsonText SpectrumWriter::write(SpectrumId id) {
  const SpectrumRow& row = set_.row(id);
  const SpectrumRow& unit = set_.row(unit_spectrum);
  const bool is_flat = row.c0 == unit.c0 && row.c1 == unit.c1 && row.c2 == unit.c2;
  if (is_flat && row.table == 0) return JsonText::number(row.scale);
  JsonText object = JsonText::object();
  float scale = row.scale;
  if (!is_flat) object.add("sigmoid", JsonText::numbers(std::array{row.c0, row.c1, row.c2}));
  if (row.table != 0) {
    const NamedTable& table = named_table(row.table);
    scale /= table.scale;  // a power of two
    if (is_flat && scale == 1) return JsonText::string(table.name);
    object.add(is_flat ? "named" : "times", JsonText::string(table.name));
  }
  if (scale != 1) object.add("scale", JsonText::number(scale));
  return object;
}

}  // namespace metamer
