#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "scenes/meshes/read_mesh.h"

namespace metamer {
namespace {

bool is_finite(float x) { return std::abs(x) <= std::numeric_limits<float>::max(); }
bool is_finite(const glm::vec2& v) { return is_finite(v.x) && is_finite(v.y); }
bool is_finite(const glm::vec3& v) { return is_finite(v.x) && is_finite(v.y) && is_finite(v.z); }

template <class T>
void check_finite(const Column<T>& column, std::string_view what, const SourceLocation& at, Diagnostics& diagnostics) {
  size_t count = 0, first = 0;
  for (size_t i = 0; i < column.size(); ++i)
    if (!is_finite(column[i]) && count++ == 0) first = i;
  if (count > 0) diagnostics.error(at, fmt::format("{} {} is not finite ({} such in all)", what, first, count));
}

void check_count(size_t found, size_t vertices, std::string_view what, const SourceLocation& at,
                 Diagnostics& diagnostics) {
  if (found != 0 && found != vertices)
    diagnostics.error(at, fmt::format("{} {} for {} positions; expected one for each, or none", found, what, vertices));
}

}  // namespace

bool validate_mesh(const Mesh& mesh, const SourceLocation& at, Diagnostics& diagnostics) {
  const size_t errors_before = diagnostics.error_count();
  if (mesh.indices.size() % 3 != 0)
    diagnostics.error(at, fmt::format("{} indices; expected three for each triangle", mesh.indices.size()));
  size_t bad = 0, first_bad = 0;
  for (size_t i = 0; i < mesh.indices.size(); ++i)
    if (mesh.indices[i] >= mesh.positions.size() && bad++ == 0) first_bad = i;
  if (bad > 0) {
    diagnostics.error(at, fmt::format("triangle {} names vertex {}, but there are {} vertices, counted from 0 ({} such "
                                      "indices in all)",
                                      first_bad / 3, mesh.indices[first_bad], mesh.positions.size(), bad));
  }
  check_count(mesh.normals.size(), mesh.positions.size(), "normals", at, diagnostics);
  check_count(mesh.uvs.size(), mesh.positions.size(), "uvs", at, diagnostics);
  check_finite(mesh.positions, "position", at, diagnostics);
  check_finite(mesh.normals, "normal", at, diagnostics);
  check_finite(mesh.uvs, "uv", at, diagnostics);
  return diagnostics.error_count() == errors_before;
}

size_t count_zero_area_triangles(const Mesh& mesh) {
  size_t count = 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::vec3 a = mesh.positions[mesh.indices[i]];
    const glm::vec3 normal =
        glm::cross(mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a);
    if (normal == glm::vec3(0)) ++count;
  }
  return count;
}

}  // namespace metamer
