#include "scenes/pbrt/mesh_shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "scenes/meshes/bilinear_patches.h"
#include "scenes/meshes/loop_subdivision.h"
#include "scenes/meshes/read_mesh.h"

namespace metamer::pbrt {
namespace {

std::string place_name(const Reader& reader, Source source) {
  return fmt::format("{}:{}", reader.scene.names[source.file], source.line);
}

Column<glm::vec3> to_vec3(std::span<const double> numbers) {
  Column<glm::vec3> column(numbers.size() / 3);
  for (size_t i = 0; i < column.size(); ++i) {
    for (int k = 0; k < 3; ++k) column[i][k] = static_cast<float>(numbers[3 * i + static_cast<size_t>(k)]);
  }
  return column;
}

Column<glm::vec2> to_vec2(std::span<const double> numbers) {
  Column<glm::vec2> column(numbers.size() / 2);
  for (size_t i = 0; i < column.size(); ++i) {
    column[i] = {static_cast<float>(numbers[2 * i]), static_cast<float>(numbers[2 * i + 1])};
  }
  return column;
}

// Indices; without the parameter those of a single face. Negative ones become large: validate_mesh reports both.
Column<uint32_t> read_indices(Parameters& parameters, size_t vertices, uint32_t per_face) {
  Column<uint32_t> indices;
  const bool given = parameters.has("indices");
  for (const double index : parameters.array("indices", ParameterType::integer, 1)) {
    indices.push_back(static_cast<uint32_t>(static_cast<int64_t>(index)));
  }
  if (!given && vertices == per_face) {
    for (uint32_t i = 0; i < per_face; ++i) indices.push_back(i);
  } else if (!given && vertices > 0) {
    parameters.error("indices",
                     fmt::format("'indices' is missing, and there are {} vertices instead of {}", vertices, per_face));
  }
  return indices;
}

// The vertices that triangle and bilinear meshes have in common.
bool read_vertices(Parameters& parameters, Mesh& mesh, uint32_t per_face) {
  const size_t errors = parameters.messages().diagnostics.error_count();
  mesh.positions = to_vec3(parameters.array("P", ParameterType::point3, 3));
  mesh.normals = to_vec3(parameters.array("N", ParameterType::normal, 3));
  const std::string_view uv_name = parameters.has("st") ? "st" : "uv";
  mesh.uvs = to_vec2(parameters.array(uv_name, ParameterType::point2, 2));
  mesh.indices = read_indices(parameters, mesh.positions.size(), per_face);
  parameters.array("faceIndices", ParameterType::integer, 1);  // only Ptex textures ask for them
  if (!parameters.has("P")) parameters.error("P", "'P', the positions, is missing");
  return parameters.messages().diagnostics.error_count() == errors;
}

std::optional<ReadMesh> add_mesh(Reader& reader, Parameters& parameters, Mesh&& mesh, size_t faces = 0) {
  if (!validate_mesh(mesh, parameters.messages().at(parameters.source()), reader.messages.diagnostics))
    return std::nullopt;
  reader.scene.meshes.push_back(std::move(mesh));
  return ReadMesh{static_cast<MeshId>(reader.scene.meshes.size() - 1), faces};
}

// validate_mesh for patches: it knows triangles only.
bool validate_patches(Parameters& parameters, const Mesh& patches) {
  const size_t vertices = patches.positions.size();
  if (patches.indices.size() % 4 != 0) {
    parameters.error("indices", fmt::format("{} indices are not a multiple of 4", patches.indices.size()));
    return false;
  }
  for (const uint32_t index : patches.indices) {
    if (index < vertices) continue;
    parameters.error("indices", fmt::format("index {} is out of range: there are {} vertices",
                                            static_cast<int32_t>(index), vertices));
    return false;
  }
  if ((!patches.normals.empty() && patches.normals.size() != vertices) ||
      (!patches.uvs.empty() && patches.uvs.size() != vertices)) {
    parameters.error("P", "there must be one normal and one uv per vertex, or none");
    return false;
  }
  return true;
}

}  // namespace

std::optional<ReadMesh> read_triangle_mesh(Reader& reader, Parameters& parameters) {
  Mesh mesh;
  mesh.name = place_name(reader, parameters.source());
  parameters.array("S", ParameterType::vector3, 3);  // tangents: only anisotropic and hair-like materials would notice
  if (!read_vertices(parameters, mesh, 3)) return std::nullopt;
  return add_mesh(reader, parameters, std::move(mesh));
}

// pbrt's normals point to the side from which the control triangles run clockwise, and so does the shape's outside.
std::optional<ReadMesh> read_loop_mesh(Reader& reader, Parameters& parameters) {
  Mesh control, mesh;
  const auto levels = static_cast<uint32_t>(parameters.integer("levels", 3, 0));
  parameters.string("scheme", "loop");
  const size_t errors = parameters.messages().diagnostics.error_count();
  control.positions = to_vec3(parameters.array("P", ParameterType::point3, 3));
  control.indices = read_indices(parameters, control.positions.size(), 3);
  if (!parameters.has("P")) parameters.error("P", "'P', the positions, is missing");
  const SourceLocation at = parameters.messages().at(parameters.source());
  if (parameters.messages().diagnostics.error_count() != errors ||
      !validate_mesh(control, at, reader.messages.diagnostics) ||
      !subdivide_loop(control, levels, at, mesh, reader.messages.diagnostics))
    return std::nullopt;
  for (glm::vec3& normal : mesh.normals) normal = -normal;
  mesh.name = place_name(reader, parameters.source());
  return add_mesh(reader, parameters, std::move(mesh));
}

std::optional<ReadMesh> read_bilinear_mesh(Reader& reader, Parameters& parameters) {
  Mesh patches, mesh;
  mesh.name = place_name(reader, parameters.source());
  parameters.string("emissionfilename", "");  // where pbrt looks for light: it changes its noise only
  if (!read_vertices(parameters, patches, 4) || !validate_patches(parameters, patches)) return std::nullopt;
  const PatchCut cut = cut_patches(patches, mesh);
  if (cut.tolerance > 0) {
    reader.messages.note_once("curved patch", parameters.source(),
                              fmt::format("Shape \"bilinearmesh\": curved patches are cut into up to {0} x {0} pieces, "
                                          "which are off by {1} of a patch's size at most; normals are the patch's",
                                          cut.most_steps, cut.tolerance));
  }
  return add_mesh(reader, parameters, std::move(mesh), patches.indices.size() / 4);
}

std::optional<ReadMesh> read_ply_mesh(Reader& reader, Parameters& parameters) {
  const std::string name = parameters.string("filename", "");
  parameters.unsupported("displacement", "the surface stays as it is");
  parameters.number("edgelength", 1);
  if (name.empty()) {
    if (!parameters.has("filename")) parameters.error("filename", "'filename' is missing");
    return std::nullopt;
  }
  const std::string path = reader.resolve(name);
  const auto known = reader.files_of_meshes.find(path);
  if (known != reader.files_of_meshes.end()) return ReadMesh{known->second};
  const auto id = static_cast<MeshId>(reader.scene.meshes.size());
  reader.scene.meshes.emplace_back();
  reader.pending_files.push_back({path, parameters.messages().at(parameters.source()), id});
  reader.files_of_meshes.emplace(path, id);
  return ReadMesh{id};
}

}  // namespace metamer::pbrt
