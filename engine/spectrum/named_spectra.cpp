#include "engine/spectrum/named_spectra.h"

#include <algorithm>
#include <string>
#include <vector>

#include "engine/spectrum/sources.h"

namespace metamer {
namespace {

struct NamedSpectrum {
  std::string name;
  const DataTable* table;  // null: computed
  size_t column;
};

// Glass makers' catalogue names (with the prefix of lead-free glass, the suffix of a revision) against everyday ones.
struct Alias {
  std::string_view name;
  std::string_view data;
  size_t column;
};
constexpr Alias aliases[] = {
    {"BK7", "dispersion/N-BK7", 0},           {"SF11", "dispersion/N-SF11", 0},
    {"SF66", "dispersion/N-SF66", 0},         {"LAK33", "dispersion/N-LAK33B", 0},
    {"FK51", "dispersion/N-FK51A", 0},        {"sapphire", "dispersion/sapphire-o", 0},
    {"glass-BK7", "dispersion/N-BK7", 0},     {"glass-SF10", "dispersion/SF10", 0},
    {"glass-SF11", "dispersion/N-SF11", 0},   {"glass-FK51A", "dispersion/N-FK51A", 0},
    {"stdillum-A", "illuminant/A", 1},        {"stdillum-D50", "illuminant/D50", 1},
    {"stdillum-D65", "illuminant/D65", 1},    {"stdillum-F1", "illuminant/FL1", 1},
    {"stdillum-F2", "illuminant/FL2", 1},     {"stdillum-F7", "illuminant/FL7", 1},
    {"stdillum-F11", "illuminant/FL11", 1},   {"stdillum-F12", "illuminant/FL12", 1},
    {"stdillum-F3", "illuminant/FL3", 1},     {"stdillum-F4", "illuminant/FL4", 1},
    {"stdillum-F5", "illuminant/FL5", 1},     {"stdillum-F6", "illuminant/FL6", 1},
    {"stdillum-F8", "illuminant/FL8", 1},     {"stdillum-F9", "illuminant/FL9", 1},
    {"stdillum-F10", "illuminant/FL10", 1},   {"glass-BAF10", "dispersion/N-BAF10", 0},
    {"glass-LASF9", "dispersion/N-LASF9", 0}, {"glass-SF5", "dispersion/SF5", 0},
};

// The part of a data table's name after "folder/", or nothing if it is not in that folder.
std::optional<std::string> name_in(std::string_view folder, const DataTable& table) {
  if (!table.name.starts_with(folder)) return std::nullopt;
  return std::string(table.name.substr(folder.size()));
}

void append_patches(const DataTable& table, std::vector<NamedSpectrum>& all) {
  size_t begin = table.header.find(',') + 1;
  for (size_t column = 1; column < table.columns; ++column) {
    const size_t end = std::min(table.header.find(',', begin), table.header.size());
    all.push_back({"colorchecker." + std::string(table.header.substr(begin, end - begin)), &table, column});
    begin = end + 1;
  }
}

std::vector<NamedSpectrum> make_names() {
  std::vector<NamedSpectrum> all = {{"E", nullptr, 0}, {"illum-acesD60", nullptr, 0}};
  for (const DataTable& table : embedded_data()) {
    if (const auto metal = name_in("nk/", table)) {
      all.push_back({*metal + ".n", &table, 1});
      all.push_back({*metal + ".k", &table, 2});
      all.push_back({"metal-" + *metal + "-eta", &table, 1});
      all.push_back({"metal-" + *metal + "-k", &table, 2});
    } else if (const auto medium = name_in("dispersion/", table)) {
      all.push_back({*medium, &table, 0});
    } else if (const auto lamp = name_in("illuminant/", table); lamp && *lamp != "D_series") {
      all.push_back({*lamp, &table, 1});
    } else if (table.name == "reflectance/colorchecker_ohta") {
      append_patches(table, all);
    }
  }
  for (const Alias& alias : aliases) {
    all.push_back({std::string(alias.name), &require_embedded_data(alias.data), alias.column});
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return all;
}

const std::vector<NamedSpectrum>& names() {
  static const std::vector<NamedSpectrum> all = make_names();
  return all;
}

}  // namespace

std::optional<Samples> named_spectrum(std::string_view name) {
  const auto found =
      std::lower_bound(names().begin(), names().end(), name,
                       [](const NamedSpectrum& entry, std::string_view key) { return entry.name < key; });
  if (found == names().end() || found->name != name) return std::nullopt;
  if (found->name == "E") return cie_illuminant("E");
  if (found->name == "illum-acesD60") return daylight(6000.0 * daylight_shift);
  if (const auto lamp = name_in("illuminant/", *found->table)) return cie_illuminant(*lamp);
  if (const auto medium = name_in("dispersion/", *found->table)) return dispersion_index(*medium);
  return resample(*found->table, found->column, Extend::constant);
}

std::span<const std::string_view> spectrum_names() {
  static const std::vector<std::string_view> views([] {
    std::vector<std::string_view> list;
    for (const NamedSpectrum& entry : names()) list.push_back(entry.name);
    return list;
  }());
  return views;
}

}  // namespace metamer
