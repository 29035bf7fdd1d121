#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/file_bytes.h"
#include "scenes/meshes/read_mesh.h"
#include "scenes/native/components.h"
#include "scenes/native/rows.h"
#include "scenes/native/varying.h"

namespace metamer {
namespace {

// Polygons become fans around their first vertex.
void read_polygons(const SceneContext& context, const Json::Value& value, size_t vertices, Column<uint32_t>& indices) {
  const JsonReader& reader = context.reader;
  if (!reader.array(value, "indices", "arrays of 3 or more vertex numbers")) return;
  for (Json::ArrayIndex i = 0; i < value.size(); ++i) {
    const Json::Value& polygon = value[i];
    const std::string what = fmt::format("indices[{}]", i);
    if (!polygon.isArray() || polygon.size() < 3) {
      reader.expected(polygon, what, "an array of 3 or more vertex numbers");
      continue;
    }
    std::vector<uint32_t> corners;
    for (const Json::Value& corner : polygon) {
      const bool in_range = corner.isNumeric() && corner.asDouble() >= 0 &&
                            corner.asDouble() < static_cast<double>(vertices) &&
                            corner.asDouble() == std::floor(corner.asDouble());
      if (!in_range)
        reader.expected(corner, what, fmt::format("the number of one of the {} positions, counted from 0", vertices));
      corners.push_back(in_range ? static_cast<uint32_t>(corner.asDouble()) : 0);
    }
    for (size_t c = 2; c < corners.size(); ++c)
      for (const uint32_t index : {corners[0], corners[c - 1], corners[c]}) indices.push_back(index);
  }
}

void scale_positions(Mesh& mesh, double factor) {
  if (factor == 1) return;
  for (glm::vec3& p : mesh.positions) p = glm::vec3(glm::dvec3(p) * factor);
}

MeshId add_mesh(SceneContext& context, Mesh&& mesh) {
  scale_positions(mesh, context.metres_per_unit);
  context.scene.meshes.push_back(std::move(mesh));
  return static_cast<MeshId>(context.scene.meshes.size() - 1);
}

MeshId read_mesh_file(SceneContext& context, const Json::Value& value) {
  const std::string file = context.reader.text(value, "file");
  if (file.empty()) return no_index;
  const std::string path = resolve_path(file, context.reader.document().path());
  const auto [known, is_new] = context.mesh_files.try_emplace(path, no_index);
  if (!is_new) return known->second;
  Mesh mesh;
  if (read_mesh(path, context.reader.document().at(value), mesh, context.reader.diagnostics()))
    known->second = add_mesh(context, std::move(mesh));
  return known->second;
}

MeshId read_inline_mesh(SceneContext& context, const JsonObject& object, const std::string& name) {
  const JsonReader& reader = context.reader;
  const size_t errors_before = reader.diagnostics().error_count();
  Mesh mesh;
  mesh.name = name;
  read_rows(context, *object.find("positions"), "positions", mesh.positions);
  if (object.has("normals")) read_rows(context, *object.find("normals"), "normals", mesh.normals);
  if (object.has("uvs")) read_rows(context, *object.find("uvs"), "uvs", mesh.uvs);
  if (const Json::Value* indices = object.find("indices"))
    read_polygons(context, *indices, mesh.positions.size(), mesh.indices);
  else
    reader.error(object.value(), "a mesh with 'positions' lacks the required key 'indices'");
  if (reader.diagnostics().error_count() != errors_before) return no_index;
  if (!validate_mesh(mesh, reader.document().at(object.value()), reader.diagnostics())) return no_index;
  return add_mesh(context, std::move(mesh));
}

MeshId read_mesh_object(SceneContext& context, const Json::Value& value, const std::string& name) {
  constexpr std::string_view sources[] = {"file", "positions"};
  const JsonObject object(context.reader, value, *find_object_spec("mesh"), "a mesh");
  const std::string_view source = object.one_of(sources);
  if (source == "positions") return read_inline_mesh(context, object, name);
  for (const std::string_view key : {"indices", "normals", "uvs"})
    if (object.has(key)) context.reader.error(*object.find(key), fmt::format("'{}' goes with 'positions' only", key));
  return source == "file" ? read_mesh_file(context, *object.find("file")) : no_index;
}

MeshId read_mesh_reference(SceneContext& context, const Json::Value& value) {
  if (!value.isString()) {
    const SourceLocation at = context.reader.document().at(value);
    return read_mesh_object(context, value, fmt::format("{}:{}", at.file, at.line));
  }
  const auto known = context.meshes.find(value.asString());
  if (known != context.meshes.end()) return known->second;
  context.reader.error(value, fmt::format("unknown mesh '{}'{}", printable_text(value.asString()),
                                          did_you_mean_key(value.asString(), context.meshes)));
  return no_index;
}

// Whether some of a shape is left between the heights; else a mistake.
void check_heights(const SceneContext& context, const Json::Value& value, float z_min, float z_max) {
  if (!(z_min < z_max)) context.reader.error(value, "'z_min' is not below 'z_max'; expected a height between them");
}

}  // namespace

void read_meshes(SceneContext& context, const Json::Value& meshes) {
  if (!meshes.isObject()) {
    context.reader.expected(meshes, "meshes", "an object of named meshes");
    return;
  }
  for (auto it = meshes.begin(); it != meshes.end(); ++it)
    if (!is_repeated_key(it.name())) context.meshes[it.name()] = read_mesh_object(context, *it, it.name());
}

std::optional<Geometry> read_geometry(SceneContext& context, const Json::Value& value) {
  const JsonObject object(context.reader, value, "geometry");
  if (!object.is_valid()) return std::nullopt;
  Geometry geometry;
  constexpr Range angle{0, 360, true};
  const auto length = [&](std::string_view key, const Range& range, float fallback) {
    return object.has(key) ? context.metres(object.number(key, range, 1)) : fallback;
  };
  geometry.flip_normal = object.boolean("flip_normal", false) ? 1 : 0;
  geometry.alpha_texture = read_alpha(context, object);
  if (object.type() == "mesh") {
    geometry.kind = ShapeKind::mesh;
    if (object.has("mesh")) geometry.mesh = read_mesh_reference(context, *object.find("mesh"));
    if (geometry.mesh == no_index) return std::nullopt;
  } else if (object.type() == "sphere") {
    geometry.kind = ShapeKind::sphere;
    geometry.radius = length("radius", positive, context.metres(1));
    geometry.z_min = length("z_min", any_number, geometry.z_min);
    geometry.z_max = length("z_max", any_number, geometry.z_max);
    geometry.phi_max_deg = object.number_f("phi_max", angle, 360);
    check_heights(context, value, std::max(geometry.z_min, -geometry.radius),
                  std::min(geometry.z_max, geometry.radius));
  } else if (object.type() == "cylinder") {
    geometry.kind = ShapeKind::cylinder;
    geometry.radius = length("radius", positive, context.metres(1));
    geometry.z_min = length("z_min", any_number, context.metres(-1));
    geometry.z_max = length("z_max", any_number, context.metres(1));
    geometry.phi_max_deg = object.number_f("phi_max", angle, 360);
    check_heights(context, value, geometry.z_min, geometry.z_max);
  } else if (object.type() == "curves") {
    if (!read_curves_geometry(context, object, geometry)) return std::nullopt;
  } else if (object.type() == "disk") {
    geometry.kind = ShapeKind::disk;
    geometry.radius = length("radius", positive, context.metres(1));
    geometry.height = length("height", any_number, 0);
    geometry.inner_radius = length("inner_radius", not_negative, 0);
    geometry.phi_max_deg = object.number_f("phi_max", angle, 360);
    if (geometry.inner_radius >= geometry.radius)
      context.reader.error(value, "'inner_radius' is not smaller than 'radius'; expected a ring or a disk");
  } else {
    geometry.kind = ShapeKind::rectangle;
    geometry.width = length("width", positive, context.metres(1));
    geometry.depth = length("depth", positive, context.metres(1));
  }
  return geometry;
}

}  // namespace metamer
