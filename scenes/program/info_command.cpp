#include <fmt/format.h>
#include <json/json.h>

#include <array>
#include <unordered_set>

#include "engine/film/film.h"
#include "scenes/library.h"
#include "scenes/program/commands.h"
#include "scenes/program/failure.h"
#include "scenes/program/grid_report.h"
#include "scenes/program/load.h"
#include "scenes/program/outputs.h"
#include "scenes/program/progress.h"
#include "scenes/program/stats.h"

namespace metamer {
namespace {

struct Count {
  const char* name;
  size_t count = 0;
};
using Counts = std::vector<Count>;

struct SceneInfo {
  RenderSettings settings;
  size_t entities = 0;
  Counts components, shapes, materials, lights, memory;
  size_t meshes = 0;             // distinct
  uint64_t mesh_triangles = 0;   // held in memory
  uint64_t scene_triangles = 0;  // in the scene: every instance's
  uint64_t zero_area_triangles = 0;
  size_t light_choices = 0;  // what a light sample chooses among: triangles, quadrics and so on
  size_t spectra = 0, images = 0;
  std::vector<GridReport> grids;
  double load_seconds = 0, build_seconds = 0;
};

Counts count_components(const Registry& registry) {
  return {{"Transform", registry.table<Transform>().size()},
          {"Motion", registry.table<Motion>().size()},
          {"Parent", registry.table<Parent>().size()},
          {"Geometry", registry.table<Geometry>().size()},
          {"Material", registry.table<Material>().size()},
          {"MaterialSlot", registry.table<MaterialSlot>().size()},
          {"Light", registry.table<Light>().size()},
          {"Camera", registry.table<Camera>().size()},
          {"Name", registry.table<Name>().size()},
          {"Visibility", registry.table<Visibility>().size()},
          {"Medium", registry.table<Medium>().size()},
          {"MediumGrid", registry.table<MediumGrid>().size()},
          {"MediumSlot", registry.table<MediumSlot>().size()}};
}

// How often each of the values 0, 1, ... that `names` stand for is in a column.
template <class Kind, size_t N>
Counts count_kinds(const Column<Kind>& column, const std::array<const char*, N>& names) {
  Counts counts;
  for (const char* name : names) counts.push_back({name, 0});
  for (const Kind kind : column) ++counts.at(static_cast<size_t>(kind)).count;
  return counts;
}

void count_geometry(const Scene& scene, SceneInfo& info) {
  const Table<Geometry>& geometry = scene.registry.table<Geometry>();
  info.shapes = count_kinds<ShapeKind, 8>(
      geometry.column<&Geometry::kind>(),
      {"mesh", "sphere", "disk", "rectangle", "cylinder", "flat curves", "ribbons", "round curves"});
  std::unordered_set<MeshId> used;
  for (uint32_t row = 0; row < geometry.size(); ++row) {
    const Geometry shape = geometry.get(row);
    if (shape.kind == ShapeKind::rectangle) info.scene_triangles += 2;
    if (shape.kind != ShapeKind::mesh || shape.mesh >= scene.meshes.size()) continue;
    info.scene_triangles += scene.meshes[shape.mesh].indices.size() / 3;
    used.insert(shape.mesh);
  }
  info.meshes = used.size();
}

size_t scene_bytes(const Scene& scene) {
  size_t bytes = scene.registry.bytes() + scene.spectra.bytes();
  for (const Mesh& mesh : scene.meshes)
    bytes += mesh.positions.bytes() + mesh.normals.bytes() + mesh.uvs.bytes() + mesh.indices.bytes();
  for (const Curves& curves : scene.curves)
    bytes += curves.points.bytes() + curves.normals.bytes() + curves.segments.bytes();
  for (const Grid& grid : scene.grids) bytes += grid.bytes();
  for (const Image& image : scene.images) bytes += image.rgb.capacity() * sizeof(float);
  return bytes;
}

SceneInfo gather(const LoadedScene& loaded, const BuiltWorld& built) {
  const Scene& scene = loaded.scene;
  const World& world = *built.world;
  const TileRect rendered = rendered_pixels(scene.settings);
  SceneInfo info;
  info.settings = scene.settings;
  info.entities = scene.registry.entity_count();
  info.components = count_components(scene.registry);
  count_geometry(scene, info);
  info.mesh_triangles = world.triangle_vertices.size() / 3;
  info.zero_area_triangles = world.zero_area_triangles;
  info.materials = count_kinds<MaterialKind, 11>(scene.registry.table<Material>().column<&Material::kind>(),
                                                 {"diffuse", "conductor", "dielectric", "rough", "coated", "smooth",
                                                  "layered", "diffuse transmission", "mix", "hair", "interface"});
  info.lights =
      count_kinds<LightKind, 7>(scene.registry.table<Light>().column<&Light::kind>(),
                                {"area", "point", "spot", "directional", "environment", "goniometric", "projection"});
  info.light_choices = world.lights.size();
  info.spectra = scene.spectra.size();
  info.images = scene.images.size();
  info.grids = report_grids(scene);
  info.memory = {{"scene", scene_bytes(scene)},
                 {"world", world_bytes(world)},
                 {"film", film_bytes(rendered.width(), rendered.height(), scene.settings.band_count)},
                 {"peak", peak_rss_bytes()}};
  info.load_seconds = loaded.seconds;
  info.build_seconds = built.seconds;
  return info;
}

// "3 mesh, 1 sphere", without what there is none of.
std::string listed(const Counts& counts) {
  std::string text;
  for (const Count& c : counts)
    if (c.count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", c.count, c.name);
  return text.empty() ? "none" : text;
}

void print_table(const SceneInfo& info, const std::string& path) {
  const RenderSettings& s = info.settings;
  const auto row = [](const char* name, const std::string& text) { fmt::print("  {:<12}{}\n", name, text); };
  fmt::print("{}\n", path);
  row("frame", fmt::format("{}x{}, {} samples per pixel, max depth {}, seed {}", s.width, s.height, s.samples_per_pixel,
                           s.max_depth, s.seed));
  row("integrator", fmt::format("{}{}", integrator_name(s.integrator), s.shadows ? "" : ", without shadows"));
  if (s.band_count > 0) row("film", fmt::format("{} bands from {} to {} nm", s.band_count, band_min_nm, band_max_nm));
  row("color", std::string(color_mode_name(s.color)));
  row("entities", fmt::format("{}", info.entities));
  row("components", listed(info.components));
  row("shapes", listed(info.shapes) + fmt::format("; {} distinct meshes", info.meshes));
  row("triangles", fmt::format("{} in the scene, {} in memory, {} without area", info.scene_triangles,
                               info.mesh_triangles, info.zero_area_triangles));
  row("materials", listed(info.materials));
  row("lights", listed(info.lights) + fmt::format("; {} emitters to choose among", info.light_choices));
  row("spectra", fmt::format("{}; {} images", info.spectra, info.images));
  for (const GridReport& grid : info.grids) row("grid", describe(grid));
  std::string memory;
  for (const Count& m : info.memory)
    memory += fmt::format("{}{} {}", memory.empty() ? "" : ", ", m.name, short_bytes(static_cast<double>(m.count)));
  row("memory", memory);
  row("time", fmt::format("reading {}, building {}", short_time(info.load_seconds), short_time(info.build_seconds)));
}

Json::Value to_json(const Counts& counts) {
  Json::Value json(Json::objectValue);
  for (const Count& c : counts) json[c.name] = static_cast<Json::UInt64>(c.count);
  return json;
}

Json::Value to_json(const Diagnostics& diagnostics) {
  Json::Value json(Json::arrayValue);
  for (const Diagnostic& d : diagnostics.all()) {
    Json::Value remark;
    remark["severity"] = d.severity == Severity::warning ? "warning" : "note";
    remark["file"] = d.file;
    remark["line"] = d.line;
    remark["message"] = d.message;
    json.append(remark);
  }
  return json;
}

void print_json(const SceneInfo& info, const std::string& path, const LoadedScene& loaded, const BuiltWorld& built) {
  Json::Value json;
  json["scene"] = path;
  json["width"] = info.settings.width;
  json["height"] = info.settings.height;
  json["samples_per_pixel"] = info.settings.samples_per_pixel;
  json["max_depth"] = info.settings.max_depth;
  json["seed"] = info.settings.seed;
  json["integrator"] = std::string(integrator_name(info.settings.integrator));
  json["shadows"] = info.settings.shadows;
  json["bands"] = info.settings.band_count;
  json["color"] = std::string(color_mode_name(info.settings.color));
  json["entities"] = static_cast<Json::UInt64>(info.entities);
  json["components"] = to_json(info.components);
  json["shapes"] = to_json(info.shapes);
  json["materials"] = to_json(info.materials);
  json["lights"] = to_json(info.lights);
  json["light_choices"] = static_cast<Json::UInt64>(info.light_choices);
  json["meshes"] = static_cast<Json::UInt64>(info.meshes);
  json["triangles"] = static_cast<Json::UInt64>(info.scene_triangles);
  json["triangles_in_memory"] = static_cast<Json::UInt64>(info.mesh_triangles);
  json["zero_area_triangles"] = static_cast<Json::UInt64>(info.zero_area_triangles);
  json["spectra"] = static_cast<Json::UInt64>(info.spectra);
  json["images"] = static_cast<Json::UInt64>(info.images);
  json["grids"] = to_json(info.grids);
  json["memory_bytes"] = to_json(info.memory);
  json["load_seconds"] = info.load_seconds;
  json["build_seconds"] = info.build_seconds;
  Json::Value remarks = to_json(loaded.diagnostics);
  for (const Json::Value& remark : to_json(built.diagnostics)) remarks.append(remark);
  json["remarks"] = remarks;
  Json::StreamWriterBuilder builder;
  builder["indentation"] = "  ";
  fmt::print("{}\n", Json::writeString(builder, json));
}

}  // namespace

int run_info(const InfoArguments& arguments) {
  const std::string path = arguments.scene.empty() ? default_scene() : arguments.scene;
  const LoadedScene loaded = load_scene(path, {}, {false, arguments.strict});
  const BuiltWorld built = build_world(loaded, path, {false, arguments.strict});
  const SceneInfo info = gather(loaded, built);
  if (arguments.json)
    print_json(info, path, loaded, built);
  else
    print_table(info, path);
  return exit_done;
}

}  // namespace metamer
