#include <gmock/gmock.h>

#include "scenes/meshes/read_mesh.h"
#include "tests/scenes/support/files.h"

namespace metamer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct ObjResult {
  bool ok = false;
  Mesh mesh;
  std::string messages;
};

ObjResult read(const std::string& content) {
  static const TemporaryFolder folder;
  ObjResult result;
  Diagnostics diagnostics;
  result.ok = read_mesh(folder.write("mesh.obj", content), {"scene.json", 7}, result.mesh, diagnostics);
  EXPECT_NE(result.ok, diagnostics.has_errors());
  result.messages = format_diagnostics(diagnostics);
  return result;
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::vector<uint32_t> indices(const Mesh& mesh) { return {mesh.indices.begin(), mesh.indices.end()}; }

TEST(Obj, TriangulatesAndMergesShapes) {
  const ObjResult r = read("o a\n" + square + "f 1 2 3 4\no b\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf -3 -2 -1\nusemtl none\n");
  ASSERT_TRUE(r.ok) << r.messages;
  EXPECT_EQ(r.mesh.indices.size(), 9u);
  EXPECT_EQ(r.mesh.positions.size(), 7u);
  EXPECT_TRUE(r.mesh.normals.empty());
  EXPECT_EQ(r.mesh.positions[r.mesh.indices[8]], glm::vec3(0, 1, 1));
  EXPECT_EQ(count_zero_area_triangles(r.mesh), 0u);
}

TEST(Obj, VerticesWithDifferentNormalsOrUvsAreSplit) {
  const ObjResult r =
      read(square + "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nvn 0 1 0\nf 1/1/1 2/2/1 3/3/1\nf 1/1/2 3/3/2 4/2/2\n");
  ASSERT_TRUE(r.ok) << r.messages;
  EXPECT_EQ(r.mesh.positions.size(), 6u);
  EXPECT_EQ(r.mesh.uvs[r.mesh.indices[2]], glm::vec2(1, 1));
  EXPECT_EQ(r.mesh.normals[r.mesh.indices[3]], glm::vec3(0, 1, 0));
}

TEST(Obj, CornersWithoutNormalGetTheirTriangles) {
  const ObjResult r = read(square + "vn 1 0 0\nf 1//1 2//1 3//1\nf 1 3 4\n");
  ASSERT_TRUE(r.ok) << r.messages;
  EXPECT_EQ(r.mesh.positions.size(), 6u);
  EXPECT_EQ(r.mesh.normals[r.mesh.indices[0]], glm::vec3(1, 0, 0));
  EXPECT_EQ(r.mesh.normals[r.mesh.indices[4]], glm::vec3(0, 0, 1));
}

TEST(Obj, NamesTheLineOfEveryMistake) {
  EXPECT_THAT(read("v 0 0 0\nv 1 nan 0\nv 1 0\nv 1 1 x\nv 0 1e39 0\nf 1 2 3\n").messages,
              testing::AllOf(HasSubstr("mesh.obj:2: error: 'nan' is not a finite number"),
                             HasSubstr("mesh.obj:3: error: 'v' with 2 numbers; expected at least 3"),
                             HasSubstr("mesh.obj:4: error: 'x' is not a finite number"),
                             HasSubstr("mesh.obj:5: error: '1e39' is not a finite number")));
  EXPECT_THAT(
      read(square + "f 1 2 3\nf 1 2 5\nf 0 1 2\nf 1 2 -5\nf 1/1 2 3\nf 1 2\nf 1 2 a\nf 1/2/3/4 2 3\n").messages,
      testing::AllOf(HasSubstr("mesh.obj:6: error: face corner '5' names no vertex; the file has 4"),
                     HasSubstr("mesh.obj:7: error: face corner '0' names no vertex"),
                     HasSubstr("mesh.obj:8: error: face corner '-5' names no vertex"),
                     HasSubstr("mesh.obj:9: error: face corner '1/1' names no uv; the file has 0"),
                     HasSubstr("mesh.obj:10: error: a face of 2 corners; expected at least 3"),
                     HasSubstr("mesh.obj:11: error: face corner 'a'"), HasSubstr("mesh.obj:12: error: face corner")));
}

TEST(Obj, RefusesWhatIsNoSurface) {
  EXPECT_THAT(read("").messages, HasSubstr("no vertex ('v x y z') in the file"));
  EXPECT_THAT(read("\x7f\x45LF\x02\xff\xfe").messages, HasSubstr("no vertex"));
  EXPECT_THAT(read(square + "l 1 2 3\n").messages, HasSubstr("no face ('f 1 2 3') in the file"));
}

TEST(Obj, SurvivesDamage) {
  const std::string whole = square + "vt 0 0\r\nvn 0 0 1\ng x\nf 1/1/1 2/1/1 3/1/1 4/1/1 # all\ns off\nf -4 -3 -2\n";
  ASSERT_TRUE(read(whole).ok);
  for (size_t i = 0; i < whole.size(); ++i) {
    read(whole.substr(0, i));
    for (const char garbage : {'\0', '\xff', '9', '\n'}) {
      std::string damaged = whole;
      damaged[i] = garbage;
      const ObjResult r = read(damaged);
      if (!r.ok) continue;
      for (const uint32_t index : indices(r.mesh)) ASSERT_LT(index, r.mesh.positions.size());
    }
  }
}

TEST(Meshes, AreToldApartByExtension) {
  Mesh mesh;
  Diagnostics diagnostics;
  EXPECT_FALSE(read_mesh("mesh.stl", {"scene.json", 7}, mesh, diagnostics));
  EXPECT_EQ(format_diagnostics(diagnostics),
            "scene.json:7: error: 'mesh.stl': unknown kind of mesh; expected a file ending in .ply or .obj, or these "
            "with .gz\n");
}

TEST(Meshes, ValidationCountsEachKindOfMistake) {
  Mesh mesh;
  for (const float x : {0.f, 1.f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
    mesh.positions.push_back({x, 0, 0});
  for (const uint32_t index : {0u, 1u, 9u, 4u}) mesh.indices.push_back(index);
  mesh.uvs.push_back({0, 0});
  Diagnostics diagnostics;
  EXPECT_FALSE(validate_mesh(mesh, {"scene.pbrt", 3}, diagnostics));
  EXPECT_EQ(format_diagnostics(diagnostics),
            "scene.pbrt:3: error: 4 indices; expected three for each triangle\n"
            "scene.pbrt:3: error: triangle 0 names vertex 9, but there are 4 vertices, counted from 0 (2 such indices "
            "in all)\n"
            "scene.pbrt:3: error: 1 uvs for 4 positions; expected one for each, or none\n"
            "scene.pbrt:3: error: position 2 is not finite (2 such in all)\n");
}

TEST(Meshes, ZeroAreaTrianglesAreCounted) {
  Mesh mesh;
  for (const glm::vec3 p : {glm::vec3(0, 0, 0), {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}) mesh.positions.push_back(p);
  for (const uint32_t index : {0u, 1u, 2u, 0u, 1u, 3u, 3u, 3u, 0u}) mesh.indices.push_back(index);
  EXPECT_EQ(count_zero_area_triangles(mesh), 2u);
}

}  // namespace
}  // namespace metamer
