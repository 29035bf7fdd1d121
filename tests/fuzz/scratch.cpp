#include "tests/fuzz/scratch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "scenes/meshes/read_mesh.h"

namespace metamer::fuzz {
namespace {

constexpr std::string_view a_triangle =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0 3 0 1 2\n";

// 2 x 2 pixels of 24 bits, uncompressed.
std::string a_picture() {
  std::string tga(18, '\0');
  tga[2] = 2;
  tga[12] = tga[14] = 2;
  tga[16] = 24;
  for (int i = 0; i < 12; ++i) tga += static_cast<char>(20 * i);
  return tga;
}

// 4 x 4 pixels of single precision.
std::string a_sky() {
  std::string pfm = "PF\n4 4\n-1.0\n";
  for (int i = 0; i < 48; ++i) {
    const float value = static_cast<float>(i % 7);
    pfm.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  return pfm;
}

bool is_finite(const glm::vec4& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

void require_valid_light(const Scene& scene, const Light& light) {
  require(light.spectrum < scene.spectra.size(), "a light has a spectrum");
  require(light.image == no_index || light.image < scene.images.size(), "a light has an image, or none");
  require(light.scale >= 0 && std::isfinite(light.scale), "a light's scale is finite");
}

void require_valid_material(const Scene& scene, const Material& m) {
  for (const SpectrumId id : {m.reflectance, m.eta, m.kappa, m.kd, m.ks})
    require(id < scene.spectra.size(), "a material has its spectra");
  require(m.alpha_x >= 0 && m.alpha_y >= 0, "roughness is not negative");
}

}  // namespace

void require(bool kept, std::string_view promise) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %.*s\n", static_cast<int>(promise.size()), promise.data());
  std::abort();
}

void require_consistent(bool ok, const Diagnostics& diagnostics) {
  require(ok != diagnostics.has_errors(), "a reader fails if and only if it reports an error");
  const std::string text = format_diagnostics(diagnostics);
  require(text.size() < (size_t{1} << 20), "messages are of a readable length");
  const auto unsafe = [](char c) { return c != '\n' && ((c >= 0 && c < ' ') || c == 0x7f); };
  require(std::none_of(text.begin(), text.end(), unsafe), "messages leave the terminal alone");
}

void require_valid(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    Diagnostics mistakes;
    require(validate_mesh(mesh, {}, mistakes), "meshes are valid");
  }
  const Registry& registry = scene.registry;
  registry.each<Geometry>([&](Entity entity, uint32_t row) {
    const Geometry geometry = registry.table<Geometry>().get(row);
    require(geometry.kind != ShapeKind::mesh || geometry.mesh < scene.meshes.size(), "a mesh shape has a mesh");
    require(registry.is_alive(entity), "shapes are alive");
    require(scene.location(entity).line > 0, "a shape knows where it was said");
  });
  registry.each<Transform>([&](Entity, uint32_t row) {
    const Transform m = registry.table<Transform>().get(row);
    require(is_finite(m.row0) && is_finite(m.row1) && is_finite(m.row2), "transforms are finite");
  });
  registry.each<Light>([&](Entity, uint32_t row) { require_valid_light(scene, registry.table<Light>().get(row)); });
  registry.each<Material>(
      [&](Entity, uint32_t row) { require_valid_material(scene, registry.table<Material>().get(row)); });
  registry.each<MaterialSlot>([&](Entity, uint32_t row) {
    const Entity material = registry.table<MaterialSlot>().get(row).material;
    require(registry.has<Material>(material), "a slot holds a material");
  });
}

bool names_outside(std::string_view input) {
  // A name that begins with a slash, climbs, or hides either from this search.
  return input.find("\"/") != std::string_view::npos || input.find("..") != std::string_view::npos ||
         input.find("\\u") != std::string_view::npos || input.find("\\/") != std::string_view::npos;
}

Scratch::Scratch() {
  std::string pattern = (std::filesystem::temp_directory_path() / "metamer-fuzz-XXXXXX").string();
  require(mkdtemp(pattern.data()) != nullptr, "a scratch folder can be made");
  folder_ = pattern;
  write("map.tga", a_picture());
  write("sky.pfm", a_sky());
  write("mesh.ply", a_triangle);
  written_.clear();
}

Scratch::~Scratch() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::string Scratch::write(std::string_view name, std::string_view content) {
  std::string file = path(name);
  std::ofstream(file, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
  written_.emplace_back(name);
  return file;
}

void Scratch::clear() {
  std::error_code ignored;
  bool mesh_changed = false;
  for (const std::string& name : written_) {
    std::filesystem::remove(folder_ / name, ignored);
    mesh_changed = mesh_changed || name == "mesh.ply";
  }
  if (mesh_changed) write("mesh.ply", a_triangle);
  written_.clear();
}

Scratch& scratch() {
  static Scratch folder;
  return folder;
}

}  // namespace metamer::fuzz
