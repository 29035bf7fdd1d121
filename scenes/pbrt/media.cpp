// Media, and which of them are where.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/common.hpp>

#include "engine/spectrum/embedded_data.h"
#include "engine/spectrum/observers.h"
#include "scenes/pbrt/matrix.h"
#include "scenes/pbrt/reader.h"
#include "scenes/volumes/bricks.h"

namespace metamer::pbrt {
namespace {

constexpr std::string_view medium_kinds[] = {"homogeneous", "uniformgrid", "rgbgrid", "cloud", "nanovdb"};
constexpr std::string_view preset_tables[] = {"media/jensen2001", "media/narasimhan2006"};

// Media may be named before they are made; the entity is the same.
NamedMedium& named_medium(Reader& reader, const std::string& name, Source source) {
  const auto [entry, fresh] = reader.media.try_emplace(name);
  if (fresh) {
    const Entity entity = reader.scene.registry.create();
    reader.scene.registry.set(entity, Name{reader.scene.names.add(name)});
    entry->second = {entity, source, false};
  }
  return entry->second;
}

SpectrumId unbounded_rgb(Reader& reader, const Color3& rgb) {
  return reader.scene.spectra.add_rgb(rgb, RgbKind::unbounded).id;
}

// Reduced scattering and absorption per millimetre, as the preset's table has them: scene units are taken for
// millimetres, as in pbrt.
bool read_preset(Reader& reader, Parameters& parameters, Medium& medium) {
  const std::string name = parameters.string("preset", "");
  if (name.empty()) return false;
  std::vector<std::string_view> known;
  for (const std::string_view table_name : preset_tables) {
    const DataTable& table = require_embedded_data(table_name);
    std::string_view rest = table.header;
    for (size_t column = 0; column < table.columns; ++column) {
      const std::string_view preset = rest.substr(0, rest.find(','));
      rest.remove_prefix(std::min(rest.size(), preset.size() + 1));
      known.push_back(preset);
      if (preset != name) continue;
      medium.sigma_s = unbounded_rgb(reader, {table.at(0, column), table.at(1, column), table.at(2, column)});
      medium.sigma_a = unbounded_rgb(reader, {table.at(3, column), table.at(4, column), table.at(5, column)});
      return true;
    }
  }
  parameters.error("preset", fmt::format("there is no preset '{}'{}", name, did_you_mean(name, known)));
  return false;
}

void read_coefficients(Reader& reader, Parameters& parameters, SpectrumId sigma_a, SpectrumId sigma_s, Medium& medium) {
  const auto read = [&](std::string_view name, SpectrumId fallback) {
    const auto value = read_spectrum(reader, parameters, name, RgbKind::unbounded, SpectrumAlso::nothing);
    return value ? value->id : fallback;
  };
  medium.sigma_a = read("sigma_a", sigma_a);
  medium.sigma_s = read("sigma_s", sigma_s);
}

// As lights: an emission's spectrum is divided by its luminance, for rgb by its white's.
void read_emission(Reader& reader, Parameters& parameters, Medium& medium) {
  SpectrumSet& spectra = reader.scene.spectra;
  const auto value = read_spectrum(reader, parameters, "Le", RgbKind::illuminant, SpectrumAlso::nothing);
  if (!value || !(spectra.max_value(value->id) > 0)) return;
  const double luminance = spectra.luminance(value->rgb ? spectra.add_white(*value->rgb) : value->id);
  if (!(luminance > 0)) return parameters.error("Le", "'Le' has no luminance, by which pbrt divides it");
  medium.emission = value->id;
  medium.emission_scale = static_cast<float>(1 / luminance);
}

void read_emission_scale(Parameters& parameters, Medium& medium) {
  const double scale = parameters.number_from("Lescale", 1, 0);
  medium.emission_scale = to_light_scale(parameters, double{medium.emission_scale} * scale);
}

void read_common(Parameters& parameters, Medium& medium) {
  medium.scale = static_cast<float>(parameters.number_from("scale", 1, 0));
  const double g = parameters.number("g", 0);
  medium.g = static_cast<float>(g);
  if (medium.g > -1 && medium.g < 1) return;
  parameters.error("g", fmt::format("'g' is {:g}; expected a number between -1 and 1, both excluded", g));
  medium.g = 0;
}

Medium read_homogeneous(Reader& reader, Parameters& parameters) {
  Medium medium;
  // Whole milk, as in pbrt.
  const bool is_preset = read_preset(reader, parameters, medium);
  const SpectrumId sigma_a = is_preset ? medium.sigma_a : unbounded_rgb(reader, {0.0011, 0.0024, 0.014});
  const SpectrumId sigma_s = is_preset ? medium.sigma_s : unbounded_rgb(reader, {2.55, 3.21, 3.77});
  if (is_preset && (parameters.has("sigma_a") || parameters.has("sigma_s")))
    parameters.messages().warning(parameters.source(), "'preset' is given, so 'sigma_a' and 'sigma_s' are not used");
  Medium own;
  read_coefficients(reader, parameters, sigma_a, sigma_s, own);
  medium.sigma_a = is_preset ? sigma_a : own.sigma_a;
  medium.sigma_s = is_preset ? sigma_s : own.sigma_s;
  read_emission(reader, parameters, medium);
  read_emission_scale(parameters, medium);
  read_common(parameters, medium);
  return medium;
}

struct GridShape {
  glm::ivec3 cells{1};
  glm::dvec3 lower{0}, upper{1};
  size_t count() const { return size_t(cells.x) * size_t(cells.y) * size_t(cells.z); }
  // The centre of cell (0, 0, 0) is half a cell from the lower corner.
  glm::dmat4 index_to_local() const {
    const glm::dvec3 cell = (upper - lower) / glm::dvec3(cells);
    return translation(lower + 0.5 * cell) * scaling(cell);
  }
};

// The values of a parameter as a grid; no_index if it is absent or wrong.
GridId read_grid(Reader& reader, Parameters& parameters, std::string_view name, ParameterType type,
                 const GridShape& shape) {
  const uint32_t channels = type == ParameterType::rgb ? 3 : 1;
  const Parameter* parameter = parameters.find(name, type);
  if (parameter == nullptr) return no_index;
  const std::vector<double>& numbers = parameter->numbers;
  if (numbers.size() != channels * shape.count()) {
    parameters.error(name, fmt::format("'{}' has {} values; expected nx * ny * nz = {}{}", name, numbers.size(),
                                       shape.count(), channels == 3 ? " times 3" : ""));
    return no_index;
  }
  if (*std::min_element(numbers.begin(), numbers.end()) < 0) {
    parameters.error(name, fmt::format("'{}' has negative values", name));
    return no_index;
  }
  Grid grid;
  grid.name = name;
  grid.stored_as = channels == 3 ? "rgb" : "float";
  grid.channels = channels;
  grid.color_space = parameter->color_space;
  grid.index_to_local = shape.index_to_local();
  settle_transform(grid.index_to_local);
  set_dense_values(grid, shape.cells, std::vector<float>(numbers.begin(), numbers.end()));
  reader.scene.grids.push_back(std::move(grid));
  return static_cast<GridId>(reader.scene.grids.size() - 1);
}

GridShape read_box(Parameters& parameters, MediumGrid& grid) {
  const auto count = [&](std::string_view name) { return static_cast<int>(parameters.integer(name, 1, 1)); };
  const glm::dvec3 a = parameters.point3("p0", glm::dvec3(0)), b = parameters.point3("p1", glm::dvec3(1));
  const GridShape shape{{count("nx"), count("ny"), count("nz")}, glm::min(a, b), glm::max(a, b)};
  grid.lower = glm::vec3(shape.lower);
  grid.upper = glm::vec3(shape.upper);
  for (int i = 0; i < 3; ++i) {
    if (grid.lower[i] == grid.upper[i]) return parameters.error("p1", "the box from 'p0' to 'p1' has no volume"), shape;
  }
  return shape;
}

// What glows by its temperature: pbrt divides Planck's law by its peak, and leaves out the 683 lm/W of the luminance.
constexpr double temperature_emission_scale = 1 / luminous_efficacy;

void read_temperature(Parameters& parameters, MediumGrid& grid) {
  const double cutoff = parameters.number("temperaturecutoff", 0);
  grid.temperature_offset = static_cast<float>(parameters.number("temperatureoffset", cutoff));
  grid.temperature_scale = static_cast<float>(parameters.number_from("temperaturescale", 1, 0));
  grid.blackbody = BlackbodyUnit::peak;
}

Medium read_uniform_grid(Reader& reader, Parameters& parameters, MediumGrid& grid) {
  Medium medium;
  const GridShape shape = read_box(parameters, grid);
  if (!parameters.has("density")) parameters.error("density", "'float density' is missing");
  grid.density = read_grid(reader, parameters, "density", ParameterType::real, shape);
  grid.temperature = read_grid(reader, parameters, "temperature", ParameterType::real, shape);
  read_temperature(parameters, grid);
  if (grid.temperature != no_index) medium.emission_scale = static_cast<float>(temperature_emission_scale);
  read_coefficients(reader, parameters, unit_spectrum, unit_spectrum, medium);
  read_emission(reader, parameters, medium);
  if (parameters.has("Le") && parameters.has("temperature"))
    parameters.error("Le", "'Le' and 'temperature' exclude each other");
  grid.emission = read_grid(reader, parameters, "Lescale", ParameterType::real, shape);
  read_common(parameters, medium);
  return medium;
}

Medium read_rgb_grid(Reader& reader, Parameters& parameters, MediumGrid& grid) {
  Medium medium;
  const GridShape shape = read_box(parameters, grid);
  if (!parameters.has("sigma_a") && !parameters.has("sigma_s"))
    parameters.error("sigma_a", "'rgb sigma_a' or 'rgb sigma_s' is missing");
  if (parameters.has("Le") && !parameters.has("sigma_a"))
    parameters.error("Le", "'rgb Le' needs 'rgb sigma_a': what absorbs nothing emits nothing");
  grid.sigma_a = read_grid(reader, parameters, "sigma_a", ParameterType::rgb, shape);
  grid.sigma_s = read_grid(reader, parameters, "sigma_s", ParameterType::rgb, shape);
  grid.emission = read_grid(reader, parameters, "Le", ParameterType::rgb, shape);
  // A coefficient without a grid is 1 everywhere, as in pbrt.
  medium.sigma_a = medium.sigma_s = unit_spectrum;
  if (grid.emission != no_index) {
    SpectrumSet& spectra = reader.scene.spectra;
    medium.emission = spectra.add_white(reader.scene.grids[grid.emission].color_space);
    medium.emission_scale = static_cast<float>(1 / spectra.luminance(medium.emission));
  }
  read_emission_scale(parameters, medium);
  read_common(parameters, medium);
  return medium;
}

// The grid of a file that a medium, of which the entity is known, will have.
void add_pending_grid(Reader& reader, const Parameters& parameters, Entity medium, const std::string& path,
                      const std::string& name, GridId MediumGrid::*handle) {
  const bool is_temperature = handle == &MediumGrid::temperature;
  for (PendingGrid& pending : reader.pending_grids) {
    const GridRequest& request = pending.request;
    if (request.path != path || request.grid_name != name || request.may_be_missing != is_temperature) continue;
    pending.uses.push_back({medium, handle});
    return;
  }
  GridRequest request{path, name, reader.messages.at(parameters.source())};
  request.may_be_negative = request.may_be_missing = is_temperature;
  reader.pending_grids.push_back({std::move(request), {{medium, handle}}});
}

Medium read_nanovdb(Reader& reader, Parameters& parameters, MediumGrid& grid, Entity entity) {
  Medium medium;
  const std::string name = parameters.string("filename", "");
  if (name.empty()) {
    parameters.error("filename", "'string filename' is missing");
  } else {
    const std::string path = reader.resolve(name);
    const auto add = [&](std::string_view key, const std::string& fallback, GridId MediumGrid::*handle) {
      add_pending_grid(reader, parameters, entity, path, parameters.string(key, fallback), handle);
    };
    add("densityname", "density", &MediumGrid::density);
    add("temperaturename", "temperature", &MediumGrid::temperature);
  }
  read_coefficients(reader, parameters, unit_spectrum, unit_spectrum, medium);
  read_temperature(parameters, grid);
  medium.emission_scale = static_cast<float>(temperature_emission_scale);
  read_emission_scale(parameters, medium);
  read_common(parameters, medium);
  return medium;
}

void refuse_medium(std::string_view kind, Parameters& parameters) {
  parameters.ignore_the_rest();
  if (kind == "cloud")
    return parameters.error("type", "media of type \"cloud\" are not supported; a grid of their density would be");
  parameters.error("type", fmt::format("there is no medium of type \"{}\"{}", kind, did_you_mean(kind, medium_kinds)));
}

std::optional<Medium> read_medium(Reader& reader, std::string_view kind, Parameters& parameters, MediumGrid& grid,
                                  Entity entity) {
  if (kind == "homogeneous") return read_homogeneous(reader, parameters);
  if (kind == "uniformgrid") return read_uniform_grid(reader, parameters, grid);
  if (kind == "rgbgrid") return read_rgb_grid(reader, parameters, grid);
  if (kind == "nanovdb") return read_nanovdb(reader, parameters, grid, entity);
  refuse_medium(kind, parameters);
  return std::nullopt;
}

}  // namespace

void make_named_medium(Reader& reader, std::string_view name, Parameters& parameters) {
  NamedMedium& entry = named_medium(reader, std::string(name), parameters.source());
  if (entry.defined) reader.messages.error(parameters.source(), fmt::format("medium '{}' is made twice", name));
  entry.defined = true;
  if (!parameters.has("type")) parameters.error("type", "'string type' is missing");
  const std::string kind = parameters.string("type", "homogeneous");
  MediumGrid grid;
  const std::optional<Medium> medium = read_medium(reader, kind, parameters, grid, entry.entity);
  Registry& registry = reader.scene.registry;
  registry.set(entry.entity, parameters.source());
  registry.set(entry.entity, medium.value_or(Medium{}));
  if (!medium || kind == "homogeneous") return;
  registry.set(entry.entity, grid);
  registry.set(entry.entity, to_component(reader.state.transform));
}

void use_media(Reader& reader, const std::string& inside, const std::string& outside, Source source) {
  const auto entity_of = [&](const std::string& name) {
    return name.empty() ? Entity{} : named_medium(reader, name, source).entity;
  };
  reader.state.media = {entity_of(inside), entity_of(outside)};
}

void report_unmade_media(Reader& reader) {
  std::vector<std::string_view> made;
  for (const auto& [name, medium] : reader.media)
    if (medium.defined) made.push_back(name);
  for (const auto& [name, medium] : reader.media) {
    if (medium.defined) continue;
    reader.messages.error(medium.first_use, fmt::format("there is no medium '{}'{}", name, did_you_mean(name, made)));
  }
}

}  // namespace metamer::pbrt
