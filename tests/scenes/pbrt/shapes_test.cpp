#include <glm/geometric.hpp>

#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

ReadScene read_good(const std::string& world) {
  ReadScene read = read_world(world);
  EXPECT_TRUE(read.ok) << world << "\n" << format_diagnostics(read.diagnostics);
  return read;
}

TEST(PbrtShapes, SpheresAndDisksMayStateTheirFullParameters) {
  const ReadScene read = read_good(R"(Shape "sphere" "float radius" 2 "float zmin" -2 "float zmax" 2 "float phimax" 360
Shape "disk" "float height" 3 "float radius" 2 "float innerradius" 1 "float phimax" 360
Shape "disk")");
  ASSERT_EQ(read.count<Geometry>(), 3u);
  EXPECT_EQ(read.get<Geometry>(0).kind, ShapeKind::sphere);
  EXPECT_EQ(read.get<Geometry>(0).radius, 2.0f);
  EXPECT_EQ(read.get<Geometry>(1).kind, ShapeKind::disk);
  EXPECT_EQ(read.get<Geometry>(1).height, 3.0f);
  EXPECT_EQ(read.get<Geometry>(1).inner_radius, 1.0f);
  EXPECT_EQ(read.get<Geometry>(2).radius, 1.0f);
  EXPECT_EQ(read.get<Geometry>(2).height, 0.0f);
}

TEST(PbrtShapes, ATriangleMeshHasPositionsNormalsUvsAndIndices) {
  const ReadScene read =
      read_good(R"(Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0] "integer indices" [0 1 2 0 2 3]
"normal N" [0 0 1 0 0 1 0 0 1 0 0 1] "point2 uv" [0 0 1 0 1 1 0 1] "vector3 S" [1 0 0 1 0 0 1 0 0 1 0 0] "integer faceIndices" [0 0])");
  const Mesh& mesh = read.scene.meshes[read.get<Geometry>().mesh];
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, 0));
  EXPECT_EQ(mesh.normals[3], glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.uvs[2], glm::vec2(1, 1));
  EXPECT_EQ(std::vector<uint32_t>(mesh.indices.begin(), mesh.indices.end()), (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
}

TEST(PbrtShapes, ASingleTriangleNeedsNoIndices) {
  const ReadScene read = read_good("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0]");
  EXPECT_EQ(read.scene.meshes[0].indices.size(), 3u);
}

TEST(PbrtShapes, PlyFilesAreFoundBesideTheSceneAndReadOnce) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "models");
  folder.write("models/t.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const std::string shape = "Shape \"plymesh\" \"string filename\" \"models/t.ply\"\n";
  const ReadScene read = read_scene_at(folder.write("scene", "Camera \"perspective\" WorldBegin\n" + shape + shape));
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_EQ(read.count<Geometry>(), 2u);
  ASSERT_EQ(read.scene.meshes.size(), 1u);
  EXPECT_EQ(read.scene.meshes[0].positions[1], glm::vec3(1, 0, 0));
}

TEST(PbrtShapes, AFlatPatchIsTwoTrianglesFacingDpduTimesDpdv) {
  const ReadScene read = read_good("Shape \"bilinearmesh\" \"point3 P\" [0 0 0 2 0 0 0 1 0 2 1 0]");
  const Mesh& mesh = read.scene.meshes[0];
  ASSERT_EQ(mesh.indices.size(), 6u);
  float area = 0;
  for (size_t i = 0; i < 6; i += 3) {
    const glm::vec3 a = mesh.positions[mesh.indices[i + 1]] - mesh.positions[mesh.indices[i]];
    const glm::vec3 b = mesh.positions[mesh.indices[i + 2]] - mesh.positions[mesh.indices[i]];
    EXPECT_GT(a.x * b.y - a.y * b.x, 0.0f) << "u is x, v is y: the normal is +z";
    area += 0.5f * (a.x * b.y - a.y * b.x);
  }
  EXPECT_FLOAT_EQ(area, 2.0f);
  EXPECT_TRUE(read.messages.empty());
}

// z = x y, whose normal is (-y, -x, 1): within 1e-4 of its size, the square root of 3, and shaded as it is.
TEST(PbrtShapes, ACurvedPatchIsCutFinely) {
  const ReadScene read = read_good("Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]");
  const Mesh& mesh = read.scene.meshes[0];
  EXPECT_EQ(mesh.indices.size(), 38u * 38u * 6u);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 p = mesh.positions[i];
    EXPECT_NEAR(p.z, p.x * p.y, 1e-6f);
    EXPECT_LT(glm::distance(mesh.normals[i], glm::normalize(glm::vec3(-p.y, -p.x, 1))), 1e-6f);
  }
  float worst = 0;
  for (size_t i = 0; i < mesh.indices.size(); i += 3)
    for (const float t : {0.1f, 0.5f}) {  // towards the diagonal's middle
      const glm::vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                      c = mesh.positions[mesh.indices[i + 2]];
      for (const glm::vec3 p : {glm::mix(a, c, t), glm::mix(a, b, t), glm::mix(b, c, t)})
        worst = std::max(worst, std::abs(p.z - p.x * p.y));
    }
  EXPECT_LT(worst, 1.0001e-4f * std::sqrt(3.0f));
  EXPECT_GT(worst, 0.9e-4f * std::sqrt(3.0f)) << "no more pieces than that takes";
  EXPECT_THAT(read.messages, testing::ElementsAre(
                                 "scene:2: note: Shape \"bilinearmesh\": curved patches are cut into up to 38 x 38 "
                                 "pieces, which are off by 0.0001 of a patch's size at most; normals are the patch's"));
}

// A tent with a twist in one of its sides, and a patch whose corners 10 and 11 are one: everywhere a unit normal.
TEST(PbrtShapes, EveryPatchOfACurvedMeshHasNormals) {
  const ReadScene read = read_good(R"(Shape "bilinearmesh" "integer indices" [0 1 2 3 4 5 4 6]
"point3 P" [0 0 0 1 0 0 0 1 0 1 1 1  5 0 0 6 0 0 5 1 0.5])");
  const Mesh& mesh = read.scene.meshes[0];
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const glm::vec3& normal : mesh.normals) EXPECT_NEAR(glm::length(normal), 1, 1e-5f);
}

TEST(PbrtShapes, LoopsubdivIsDividedAndPushedToTheLimitWithNormals) {
  const ReadScene read = read_good(R"(Shape "loopsubdiv" "integer levels" 2 "string scheme" "loop"
"point3 P" [1 1 1  1 -1 -1  -1 1 -1  -1 -1 1] "integer indices" [0 1 2 0 3 1 0 2 3 1 3 2]
Shape "loopsubdiv" "point3 P" [0 0 0 1 0 0 0 1 0])");
  const Mesh& mesh = read.scene.meshes[read.get<Geometry>(0).mesh];
  EXPECT_EQ(mesh.indices.size(), 4u * 16 * 3);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  // pbrt's normals: the other side than that from which the triangles run counter-clockwise.
  for (size_t i = 0; i < mesh.positions.size(); ++i) EXPECT_LT(glm::dot(mesh.positions[i], mesh.normals[i]), 0.0f);
  EXPECT_EQ(read.scene.meshes[read.get<Geometry>(1).mesh].indices.size(), 64u * 3) << "three levels by default";
  const ReadScene wrong = read_world(R"(Shape "loopsubdiv" "integer levels" -1
Shape "loopsubdiv" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 1]
Shape "loopsubdiv" "point3 P" [0 0 0 1 0 0 0 1 0] "normal N" [0 0 1 0 0 1 0 0 1])");
  EXPECT_EQ(wrong.count<Geometry>(), 1u);
  EXPECT_THAT(
      format_diagnostics(wrong.diagnostics),
      testing::AllOf(testing::HasSubstr("scene:2: error: Shape \"loopsubdiv\": 'levels' is -1, but must be at least 0"),
                     testing::HasSubstr("scene:2: error: Shape \"loopsubdiv\": 'P', the positions, is missing"),
                     testing::HasSubstr("scene:3: error: triangle 0 of the control mesh names a vertex twice"),
                     testing::HasSubstr("scene:4: error: Shape \"loopsubdiv\" has no parameter 'normal N'")));
}

TEST(PbrtShapes, QuadricsMayBeParts) {
  const ReadScene read = read_good(R"(Shape "sphere" "float radius" 2 "float zmin" 1 "float zmax" -1.5 "float phimax" 90
Shape "sphere" "float radius" 2 "float zmax" 1
Shape "disk" "float phimax" 45
Shape "cylinder"
Shape "cylinder" "float radius" 3 "float zmin" 5 "float zmax" 2 "float phimax" 400)");
  const auto zone = read.get<Geometry>(0), cap = read.get<Geometry>(1), pipe = read.get<Geometry>(4);
  EXPECT_EQ(zone.z_min, -1.5f) << "in whichever order they are given";
  EXPECT_EQ(zone.z_max, 1.0f);
  EXPECT_EQ(zone.phi_max_deg, 90.0f);
  EXPECT_EQ(cap.z_min, -std::numeric_limits<float>::infinity());
  EXPECT_EQ(cap.z_max, 1.0f);
  EXPECT_EQ(read.get<Geometry>(2).phi_max_deg, 45.0f);
  EXPECT_EQ(read.get<Geometry>(3).kind, ShapeKind::cylinder);
  EXPECT_EQ(read.get<Geometry>(3).z_min, -1.0f);
  EXPECT_EQ(read.get<Geometry>(3).z_max, 1.0f);
  EXPECT_EQ(pipe.radius, 3.0f);
  EXPECT_EQ(pipe.z_min, 2.0f);
  EXPECT_EQ(pipe.z_max, 5.0f);
  EXPECT_EQ(pipe.phi_max_deg, 360.0f);
  EXPECT_TRUE(read.messages.empty());
}

// pi times the area that pbrt gives the part in its own space, 1/4 of 2 pi r h, divides it.
TEST(PbrtShapes, ThePowerOfAPartGoesByItsOwnArea) {
  const ReadScene read = read_good(R"(AreaLightSource "diffuse" "float power" 30
Shape "cylinder" "float radius" 2 "float zmin" 0 "float zmax" 3 "float phimax" 90
Shape "sphere" "float radius" 2 "float zmin" -1 "float zmax" 2 "float phimax" 90
Shape "disk" "float radius" 4 "float innerradius" 2 "float phimax" 90)");
  const double area = 3 * 3.14159265358979;
  const double per_area = double{read.get<Light>(0).scale} * area;
  for (uint32_t i = 0; i < 3; ++i) EXPECT_NEAR(read.get<Light>(i).scale * area / per_area, 1, 1e-6) << i;
  const ReadScene whole = read_good(
      "AreaLightSource \"diffuse\" \"float power\" 30 Shape \"cylinder\" \"float radius\" 2 "
      "\"float zmin\" 0 \"float zmax\" 3");
  EXPECT_NEAR(read.get<Light>(0).scale / whole.get<Light>().scale, 4, 1e-5);
}

TEST(PbrtShapes, PartsOfNothingAreErrors) {
  const ReadScene read = read_world(R"(Shape "sphere" "float zmin" 3 "float zmax" 2
Shape "cylinder" "float zmin" 1
Shape "disk" "float phimax" 0
Shape "cilinder")");
  EXPECT_THAT(read.messages, testing::ElementsAre(
                                 "scene:2: error: Shape \"sphere\": 'zmin' 3 and 'zmax' 2 leave nothing of the shape",
                                 "scene:3: error: Shape \"cylinder\": 'zmin' 1 and 'zmax' 1 leave nothing of the shape",
                                 "scene:4: error: Shape \"disk\": 'phimax' is 0, but must be positive",
                                 "scene:5: error: there is no shape \"cilinder\" (did you mean 'cylinder'?)"));
}

}  // namespace
}  // namespace metamer
