#include "scenes/native/grids.h"

#include <fmt/format.h>

#include <array>
#include <glm/ext/matrix_transform.hpp>

#include "scenes/native/transforms.h"
#include "scenes/volumes/bricks.h"
#include "scenes/volumes/medium_box.h"
#include "scenes/volumes/noise_grid.h"

namespace metamer {
namespace {

constexpr std::string_view sources[] = {"file", "noise"};

// [[x, y, z], [x, y, z]], lower and upper corner, in units of the file; false where it is wrong.
bool read_box(const JsonReader& reader, const Json::Value& value, glm::dvec3& lower, glm::dvec3& upper) {
  if (!value.isArray() || value.size() != 2) {
    reader.expected(value, "box", "[lower corner, upper corner]");
    return false;
  }
  const size_t before = reader.diagnostics().error_count();
  const glm::dvec3 a = reader.vector(value[0], "box[0]", lower), b = reader.vector(value[1], "box[1]", upper);
  if (reader.diagnostics().error_count() != before) return false;
  for (int i = 0; i < 3; ++i)
    if (!(static_cast<float>(a[i]) < static_cast<float>(b[i]))) {
      reader.error(value, fmt::format("'box' has its lower corner at {} and its upper one at {} along {}; expected the "
                                      "lower one to be below",
                                      a[i], b[i], "xyz"[i]));
      return false;
    }
  lower = a;
  upper = b;
  return true;
}

}  // namespace

GridId MediumGrids::add_grid(Grid&& grid) {
  const double metres = context_.metres_per_unit;
  if (metres != 1) grid.index_to_local = glm::scale(glm::dmat4(1.0), glm::dvec3(metres)) * grid.index_to_local;
  settle_transform(grid.index_to_local);
  context_.scene.grids.push_back(std::move(grid));
  return static_cast<GridId>(context_.scene.grids.size() - 1);
}

GridId MediumGrids::add_noise(const JsonObject& noise, std::string_view key) {
  constexpr uint32_t most_voxels = 1024, most_octaves = 16;
  constexpr Range factor{0, 1};
  NoiseShape shape;
  const size_t before = context_.reader.diagnostics().error_count();
  shape.seed = noise.integer("seed", 0, 0xffffffffu, shape.seed);
  shape.octaves = noise.integer("octaves", 1, most_octaves, shape.octaves);
  shape.roughness = noise.number("roughness", factor, shape.roughness);
  shape.frequency = noise.number("frequency", positive, shape.frequency);
  shape.bias = noise.number("bias", any_number, shape.bias);
  shape.falloff = noise.number("falloff", factor, shape.falloff);
  shape.resolution = noise.integer("resolution", 1, most_voxels, shape.resolution);
  if (noise.has("box")) read_box(context_.reader, *noise.find("box"), shape.lower, shape.upper);
  if (context_.reader.diagnostics().error_count() != before) return no_index;
  Grid grid = noise_grid(shape);
  grid.name = key;
  return add_grid(std::move(grid));
}

void MediumGrids::add_file(const JsonObject& object, Use use) {
  const JsonReader& reader = context_.reader;
  const std::string file = reader.text(*object.find("file"), "file");
  const std::string name = object.has("grid") ? reader.text(*object.find("grid"), "grid") : "";
  const auto space = static_cast<ColorSpace>(object.choice("space", color_space_names(), 0));
  if (file.empty()) return;
  const std::string path = resolve_path(file, reader.document().path());
  const bool is_temperature = use.handle == &MediumGrid::temperature;
  for (Pending& known : pending_) {
    if (known.request.path != path || known.request.grid_name != name || known.space != space) continue;
    known.request.may_be_negative = known.request.may_be_negative && is_temperature;
    return known.uses.push_back(use);
  }
  const Json::Value* place = object.has("grid") ? object.find("grid") : object.find("file");
  GridRequest request{path, name, reader.document().at(*place), is_temperature};
  pending_.push_back({std::move(request), space, {use}});
}

void MediumGrids::read_grid(Entity medium, const JsonObject& object, std::string_view key, MediumGrid& grids,
                            GridId MediumGrid::*handle) {
  if (!object.has(key)) return;
  const bool is_temperature = handle == &MediumGrid::temperature;
  const std::string_view spec = is_temperature ? "temperature_grid" : "medium_grid";
  const JsonObject grid(context_.reader, *object.find(key), *find_object_spec(spec), key);
  if (!grid.is_valid()) return;
  if (is_temperature) {
    grids.temperature_offset = grid.number_f("offset", any_number, 0);
    grids.temperature_scale = grid.number_f("scale", not_negative, 1);
    if (grid.boolean("normalized", false)) grids.blackbody = BlackbodyUnit::peak;
  }
  const std::string_view source = grid.one_of(sources);
  for (const std::string_view of_files : {"grid", "space"})
    if (source == "noise" && grid.has(of_files))
      context_.reader.error(*grid.find(of_files), fmt::format("'{}' goes with 'file' only", of_files));
  if (source == "file") add_file(grid, {medium, handle});
  if (source != "noise") return;
  const JsonObject noise(context_.reader, *grid.find("noise"), *find_object_spec("noise"), "noise");
  if (noise.is_valid()) grids.*handle = add_noise(noise, key);
}

void MediumGrids::add(Entity medium, const JsonObject& object) {
  constexpr std::string_view lookups[] = {"trilinear", "stochastic"};
  MediumGrid grids;
  const auto read = [&](std::string_view key, GridId MediumGrid::*handle) {
    read_grid(medium, object, key, grids, handle);
  };
  read("density", &MediumGrid::density);
  read("sigma_a_grid", &MediumGrid::sigma_a);
  read("sigma_s_grid", &MediumGrid::sigma_s);
  read("emission_grid", &MediumGrid::emission);
  read("temperature", &MediumGrid::temperature);
  grids.lookup = static_cast<GridLookup>(object.choice("lookup", lookups, 0));
  if (object.has("density") + object.has("sigma_a_grid") + object.has("sigma_s_grid") == 0)
    context_.reader.error(object.value(),
                          "a medium of type 'grid' needs a 'density', a 'sigma_a_grid' or a 'sigma_s_grid'");
  if (object.has("emission") && object.has("temperature"))
    context_.reader.error(*object.find("emission"), "'emission' and 'temperature' exclude each other");
  glm::dvec3 lower(0), upper(1);
  if (!object.has("box")) {
    boxless_.push_back(medium);
  } else if (read_box(context_.reader, *object.find("box"), lower, upper)) {
    grids.lower = glm::vec3(lower * context_.metres_per_unit);
    grids.upper = glm::vec3(upper * context_.metres_per_unit);
  }
  Registry& registry = context_.scene.registry;
  registry.set(medium, grids);
  if (object.has("transform")) registry.set(medium, read_transform(context_, object.find("transform")));
}

// Where there is no density, there is nothing; without one, what has a sigma somewhere.
void MediumGrids::complete_box(Entity medium) {
  Registry& registry = context_.scene.registry;
  MediumGrid grids = registry.get<MediumGrid>(medium);
  std::vector<const Grid*> filled;
  const auto add = [&](GridId id) {
    if (id != no_index) filled.push_back(&context_.scene.grids[id]);
  };
  add(grids.density);
  if (filled.empty()) {
    add(grids.sigma_a);
    add(grids.sigma_s);
  }
  if (filled.empty()) return;  // which has been reported
  set_medium_box(grids, filled, 1);
  registry.set(medium, grids);
}

void MediumGrids::read_files() {
  std::vector<GridRequest> requests;
  for (Pending& pending : pending_) requests.push_back(std::move(pending.request));
  read_grids(requests, context_.reader.diagnostics());
  Registry& registry = context_.scene.registry;
  for (size_t i = 0; i < requests.size(); ++i) {
    if (!requests[i].found) continue;
    Grid& grid = requests[i].grid;
    grid.name = requests[i].path + ":" + requests[i].grid_name;
    grid.color_space = pending_[i].space;
    const GridId id = add_grid(std::move(grid));
    for (const Use& use : pending_[i].uses) {
      MediumGrid grids = registry.get<MediumGrid>(use.medium);
      grids.*use.handle = id;
      registry.set(use.medium, grids);
    }
  }
  for (const Entity medium : boxless_) complete_box(medium);
}

}  // namespace metamer
