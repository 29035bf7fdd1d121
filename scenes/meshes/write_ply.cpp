#include "scenes/meshes/write_ply.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

namespace metamer {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
void put(char*& at, const T& value) {
  std::memcpy(at, &value, sizeof(T));
  at += sizeof(T);
}

}  // namespace

std::string ply_bytes(const Mesh& mesh) {
  const size_t vertices = mesh.positions.size(), triangles = mesh.indices.size() / 3;
  const bool has_normals = !mesh.normals.empty(), has_uvs = !mesh.uvs.empty();
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment written by metamer\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n{}{}element face {}\n"
      "property list uchar uint vertex_indices\nend_header\n",
      vertices, has_normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
      has_uvs ? "property float u\nproperty float v\n" : "", triangles);
  const size_t header = bytes.size();
  const size_t vertex_bytes = sizeof(float) * (3u + (has_normals ? 3u : 0u) + (has_uvs ? 2u : 0u));
  bytes.resize(header + vertices * vertex_bytes + triangles * (1 + 3 * sizeof(uint32_t)));
  char* at = bytes.data() + header;
  for (size_t v = 0; v < vertices; ++v) {
    put(at, mesh.positions[v]);
    if (has_normals) put(at, mesh.normals[v]);
    if (has_uvs) put(at, mesh.uvs[v]);
  }
  for (size_t t = 0; t < triangles; ++t) {
    put(at, uint8_t{3});
    for (size_t k = 0; k < 3; ++k) put(at, mesh.indices[3 * t + k]);
  }
  return bytes;
}

}  // namespace metamer
