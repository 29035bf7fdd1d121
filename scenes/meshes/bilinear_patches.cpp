#include "scenes/meshes/bilinear_patches.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace metamer {
namespace {

constexpr double usual_tolerance = 1e-4;
constexpr size_t most_triangles = 20'000'000;

struct Patch {
  const uint32_t* corner;
  glm::dvec3 p[4];  // 00, 10, 01, 11

  Patch(const Mesh& patches, size_t first) : corner(&patches.indices[first]) {
    for (int k = 0; k < 4; ++k) p[k] = patches.positions[corner[k]];
  }
  double size() const {
    double longest = 0;
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < i; ++k) longest = std::max(longest, glm::distance(p[i], p[k]));
    return longest;
  }
  glm::dvec3 normal(double u, double v) const {
    return glm::cross((p[1] - p[0]) * (1 - v) + (p[3] - p[2]) * v, (p[2] - p[0]) * (1 - u) + (p[3] - p[1]) * u);
  }
};

// Whether the four corners lie in one plane and form a convex quadrilateral, which two triangles fill exactly.
bool is_flat_and_convex(const Patch& patch) {
  const glm::dvec3 around[4] = {patch.p[0], patch.p[1], patch.p[3], patch.p[2]};
  const glm::dvec3 normal = glm::cross(around[2] - around[0], around[3] - around[1]);
  const double size = std::sqrt(glm::length(normal));
  if (!(size > 0)) return true;
  if (std::abs(glm::dot(glm::normalize(normal), around[1] - around[0] + around[3] - around[2])) > 1e-5 * size)
    return false;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3 edge = around[(i + 1) % 4] - around[i], next = around[(i + 2) % 4] - around[(i + 1) % 4];
    if (glm::dot(normal, glm::cross(edge, next)) < 0) return false;
  }
  return true;
}

// With d = p00 - p10 - p01 + p11 a cell of 1 / n by 1 / n is off the two triangles over its corners by |d| / (4 n^2)
// in its middle, and nowhere more.
uint32_t steps_of(const Patch& patch, double tolerance) {
  if (is_flat_and_convex(patch)) return 1;
  const double twist = glm::length(patch.p[0] - patch.p[1] - patch.p[2] + patch.p[3]);
  return std::max(1u, static_cast<uint32_t>(std::ceil(std::sqrt(twist / (4 * tolerance * patch.size())))));
}

size_t triangles_of(const Mesh& patches, double tolerance) {
  size_t count = 0;
  for (size_t i = 0; i < patches.indices.size(); i += 4) {
    const size_t steps = steps_of(Patch(patches, i), tolerance);
    count += 2 * steps * steps;
  }
  return count;
}

template <class T>
T bilinear(const Column<T>& column, const uint32_t* corner, float u, float v) {
  const T bottom = column[corner[0]] * (1 - u) + column[corner[1]] * u;
  const T top = column[corner[2]] * (1 - u) + column[corner[3]] * u;
  return bottom * (1 - v) + top * v;
}

// The patch's normal; where two corners coincide that of a place a little further inside.
glm::vec3 patch_normal(const Patch& patch, double u, double v) {
  glm::dvec3 normal = patch.normal(u, v);
  const double least = 1e-9 * patch.size() * patch.size();
  if (!(glm::length(normal) > least)) normal = patch.normal(0.99 * u + 0.005, 0.99 * v + 0.005);
  if (!(glm::length(normal) > 0)) normal = patch.normal(0.5, 0.5);
  return glm::length(normal) > 0 ? glm::vec3(glm::normalize(normal)) : glm::vec3(0, 0, 1);
}

// The normal is dp/du x dp/dv, hence the counter-clockwise order 00, 10, 11, 01.
void add_patch(const Mesh& patches, const Patch& patch, uint32_t steps, bool needs_normals, Mesh& mesh) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (uint32_t row = 0; row <= steps; ++row) {
    for (uint32_t column = 0; column <= steps; ++column) {
      const float u = static_cast<float>(column) / static_cast<float>(steps),
                  v = static_cast<float>(row) / static_cast<float>(steps);
      mesh.positions.push_back(bilinear(patches.positions, patch.corner, u, v));
      if (!patches.normals.empty()) mesh.normals.push_back(bilinear(patches.normals, patch.corner, u, v));
      if (needs_normals) mesh.normals.push_back(patch_normal(patch, double{u}, double{v}));
      mesh.uvs.push_back(patches.uvs.empty() ? glm::vec2(u, v) : bilinear(patches.uvs, patch.corner, u, v));
    }
  }
  for (uint32_t row = 0; row < steps; ++row) {
    for (uint32_t column = 0; column < steps; ++column) {
      const uint32_t a = first + row * (steps + 1) + column, b = a + 1, c = b + steps + 1, d = c - 1;
      for (const uint32_t index : {a, b, c, a, c, d}) mesh.indices.push_back(index);
    }
  }
}

}  // namespace

PatchCut cut_patches(const Mesh& patches, Mesh& mesh) {
  double tolerance = usual_tolerance;
  while (triangles_of(patches, tolerance) > std::max(most_triangles, patches.indices.size() / 2)) tolerance *= 4;
  PatchCut cut;
  bool is_curved = false;
  for (size_t i = 0; i < patches.indices.size(); i += 4) {
    const Patch patch(patches, i);
    is_curved = is_curved || !is_flat_and_convex(patch);
    cut.most_steps = std::max(cut.most_steps, steps_of(patch, tolerance));
  }
  if (is_curved) cut.tolerance = tolerance;
  for (size_t i = 0; i < patches.indices.size(); i += 4) {
    const Patch patch(patches, i);
    add_patch(patches, patch, steps_of(patch, tolerance), is_curved && patches.normals.empty(), mesh);
  }
  return cut;
}

}  // namespace metamer
