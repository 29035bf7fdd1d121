#include "scenes/meshes/loop_subdivision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace metamer {
namespace {

Mesh subdivided(const Mesh& control, uint32_t levels) {
  Mesh mesh;
  Diagnostics diagnostics;
  EXPECT_TRUE(subdivide_loop(control, levels, {"here", 7}, mesh, diagnostics)) << format_diagnostics(diagnostics);
  return mesh;
}

Mesh control_of(std::initializer_list<glm::vec3> positions, std::initializer_list<uint32_t> indices) {
  Mesh mesh;
  for (const glm::vec3& p : positions) mesh.positions.push_back(p);
  for (const uint32_t i : indices) mesh.indices.push_back(i);
  return mesh;
}

Mesh tetrahedron() {
  return control_of({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2});
}
Mesh octahedron() {
  return control_of({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                    {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5});
}
// A hexagon around its middle, which is lifted.
Mesh hexagon(float lift) {
  Mesh mesh;
  mesh.positions.push_back({0, 0, lift});
  for (int i = 0; i < 6; ++i)
    mesh.positions.push_back({std::cos(float(i) * 1.0471976f), std::sin(float(i) * 1.0471976f), 0});
  for (uint32_t i = 0; i < 6; ++i)
    for (const uint32_t index : {0u, 1 + i, 1 + (i + 1) % 6}) mesh.indices.push_back(index);
  return mesh;
}

// The limit of a vertex of valence n is (1 - n g) v + g times the sum of its neighbours, g = 1 / (n + 3 / (8 b)), where
// b = (5/8 - (3/8 + cos(2 pi / n) / 4)^2) / n: Loop 1987; Hoppe et al., "Piecewise Smooth Surface Reconstruction",
// SIGGRAPH 1994.
double limit_weight(int n) {
  const double c = 3.0 / 8 + std::cos(2 * 3.14159265358979 / n) / 4;
  const double b = (5.0 / 8 - c * c) / n;
  return 1 / (n + 3 / (8 * b));
}

TEST(LoopSubdivision, VerticesLieOnTheLimitSurfaceAtEveryLevel) {
  // Neighbours sum to minus the vertex: a tetrahedron of valence 3. Of an octahedron's four they sum to zero.
  const double tetrahedral = 1 - 4 * limit_weight(3), octahedral = 1 - 4 * limit_weight(4);
  EXPECT_NEAR(tetrahedral, 0.2, 1e-12);
  for (uint32_t levels = 0; levels < 5; ++levels) {
    const Mesh four = subdivided(tetrahedron(), levels), eight = subdivided(octahedron(), levels);
    EXPECT_EQ(four.indices.size(), size_t{12} << (2 * levels));
    // The control vertices' children come last or first: look for the farthest points, which they are.
    double farthest4 = 0, farthest8 = 0;
    for (const glm::vec3& p : four.positions) farthest4 = std::max(farthest4, double(glm::length(p)));
    for (const glm::vec3& p : eight.positions) farthest8 = std::max(farthest8, double(glm::length(p)));
    EXPECT_NEAR(farthest4, tetrahedral * std::sqrt(3.0), 1e-6) << levels;
    EXPECT_NEAR(farthest8, octahedral, 1e-6) << levels;
  }
}

TEST(LoopSubdivision, ARegularVertexGoesHalfwayToItsNeighbours) {
  // Valence 6: g = 1/12, so half of the vertex stays. The normal there is the axis.
  const Mesh mesh = subdivided(hexagon(1), 2);
  bool found = false;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    if (std::hypot(mesh.positions[i].x, mesh.positions[i].y) > 1e-6) continue;
    found = true;
    EXPECT_NEAR(mesh.positions[i].z, 0.5, 1e-6);
    EXPECT_NEAR(mesh.normals[i].z, 1, 1e-6);
  }
  EXPECT_TRUE(found);
}

TEST(LoopSubdivision, BoundariesAreCubicSplinesOfTheirOwnVertices) {
  // A corner of the hexagon ends at 1/6 a + 2/3 b + 1/6 c, whatever the middle does.
  for (const float lift : {0.0f, 3.0f}) {
    const Mesh mesh = subdivided(hexagon(lift), 3);
    double farthest = 0;
    for (const glm::vec3& p : mesh.positions)
      if (p.z < 1e-6f) farthest = std::max(farthest, double(glm::length(p)));
    EXPECT_NEAR(farthest, 2.0 / 3 + 2 * 0.5 / 6, 1e-6);
  }
}

TEST(LoopSubdivision, NormalsAreOfTheLimitSurfaceOnTheCounterClockwiseSide) {
  const Mesh mesh = subdivided(octahedron(), 4);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  double worst = 1;
  for (size_t t = 0; t < mesh.indices.size(); t += 3) {
    const glm::vec3 a = mesh.positions[mesh.indices[t]];
    const glm::vec3 n =
        glm::normalize(glm::cross(mesh.positions[mesh.indices[t + 1]] - a, mesh.positions[mesh.indices[t + 2]] - a));
    for (size_t k = 0; k < 3; ++k) worst = std::min(worst, double(glm::dot(n, mesh.normals[mesh.indices[t + k]])));
  }
  EXPECT_GT(worst, 0.98) << "cosine between a triangle and its vertices' normals";
}

TEST(LoopSubdivision, UnusedVerticesAreDroppedAndFlatMeshesStayFlat) {
  Mesh control = hexagon(0);
  control.positions.push_back({5, 5, 5});
  const Mesh mesh = subdivided(control, 3);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_EQ(mesh.positions[i].z, 0);
    EXPECT_NEAR(mesh.normals[i].z, 1, 1e-6) << "also on the boundary";
  }
}

TEST(LoopSubdivision, SurvivesTrianglesThatAreNoManifold) {
  // Three on one edge, two that turn the other way, one twice, and two that share a vertex only.
  Mesh control = control_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {5, 0, 0}, {5, 1, 0}},
                            {0, 1, 2, 0, 1, 3, 0, 1, 4, 0, 1, 4, 0, 5, 6});
  const Mesh mesh = subdivided(control, 3);
  EXPECT_EQ(mesh.indices.size(), 5u * 64 * 3);
  for (const glm::vec3& p : mesh.positions) EXPECT_LE(glm::length(p), 6.0f);
}

TEST(LoopSubdivision, RefusesWhatItCannotDivide) {
  Mesh mesh;
  Diagnostics diagnostics;
  EXPECT_FALSE(subdivide_loop(control_of({{0, 0, 0}, {1, 0, 0}}, {0, 1, 1}), 1, {"here", 7}, mesh, diagnostics));
  EXPECT_FALSE(subdivide_loop(octahedron(), 12, {"here", 8}, mesh, diagnostics));
  EXPECT_FALSE(subdivide_loop(octahedron(), 2'000'000'000, {"here", 9}, mesh, diagnostics));
  EXPECT_EQ(format_diagnostics(diagnostics),
            "here:7: error: triangle 0 of the control mesh names a vertex twice\n"
            "here:8: error: 8 triangles divided into four 12 times are more than 50000000\n"
            "here:9: error: 8 triangles divided into four 2000000000 times are more than 50000000\n");
}

}  // namespace
}  // namespace metamer
