#include <gmock/gmock.h>

#include <bit>
#include <cstring>
#include <fstream>

#include "scenes/file_bytes.h"
#include "scenes/meshes/read_mesh.h"

namespace metamer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct PlyResult {
  bool ok = false;
  Mesh mesh;
  Diagnostics diagnostics;
  std::string messages() const { return format_diagnostics(diagnostics); }
};

PlyResult read(const std::string& content) {
  PlyResult result;
  // A copy of exactly that size, so that the address sanitizer sees a read beyond the end.
  const FileBytes bytes = copy_bytes(content);
  result.ok = read_ply_text(bytes.text(), "mesh.ply", result.mesh, result.diagnostics);
  return result;
}

std::vector<uint32_t> indices(const Mesh& mesh) { return {mesh.indices.begin(), mesh.indices.end()}; }

std::string ascii_header(int vertices, int faces) {
  return "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}
const std::string square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

template <class T>
void append(std::string& bytes, T value, bool big_endian) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

// A pentagon with a normal, a uv, a property and an element nobody knows, a list among the vertices' properties, in
// types that are not the usual ones.
std::string rich_binary(bool big_endian) {
  std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\nelement camera 2\nproperty double aperture\nproperty list ushort short tags\n"
                      "element vertex 5\nproperty uchar red\nproperty double x\nproperty short y\nproperty float z\n"
                      "property list uchar float weights\nproperty float nx\nproperty float ny\nproperty float nz\n"
                      "property float s\nproperty float t\nelement face 1\nproperty uchar flags\n"
                      "property list int ushort vertex_index\nelement edge 1\nproperty int vertex1\nend_header\n";
  for (int i = 0; i < 2; ++i) {
    append(bytes, 1.5, big_endian);
    append<uint16_t>(bytes, 2, big_endian);
    append<int16_t>(bytes, -1, big_endian);
    append<int16_t>(bytes, 7, big_endian);
  }
  for (int i = 0; i < 5; ++i) {
    append<uint8_t>(bytes, 200, big_endian);
    append<double>(bytes, 0.25 * i, big_endian);
    append<int16_t>(bytes, static_cast<int16_t>(-300 * i), big_endian);
    append<float>(bytes, 2.5f, big_endian);
    append<uint8_t>(bytes, static_cast<uint8_t>(i), big_endian);
    for (int k = 0; k < i; ++k) append<float>(bytes, 9.0f, big_endian);
    for (const float n : {0.0f, 0.0f, 1.0f, 0.1f * static_cast<float>(i), 0.5f}) append(bytes, n, big_endian);
  }
  append<uint8_t>(bytes, 1, big_endian);
  append<int32_t>(bytes, 5, big_endian);
  for (uint16_t i = 0; i < 5; ++i) append(bytes, i, big_endian);
  append<int32_t>(bytes, 3, big_endian);
  return bytes;
}

TEST(Ply, ReadsAsciiAndFansPolygons) {
  const PlyResult result = read(ascii_header(4, 2) + square + "4 0 1 2 3\n3 0 1 2\n");
  ASSERT_TRUE(result.ok) << result.messages();
  EXPECT_THAT(indices(result.mesh), ElementsAre(0, 1, 2, 0, 2, 3, 0, 1, 2));
  EXPECT_EQ(result.mesh.positions[2], glm::vec3(1, 1, 0));
  EXPECT_TRUE(result.mesh.normals.empty());
  EXPECT_TRUE(result.mesh.uvs.empty());
}

TEST(Ply, ReadsBothByteOrdersAnyTypesAndSkipsTheUnknown) {
  for (const bool big_endian : {false, true}) {
    const PlyResult result = read(rich_binary(big_endian));
    ASSERT_TRUE(result.ok) << result.messages();
    ASSERT_EQ(result.mesh.positions.size(), 5u);
    EXPECT_EQ(result.mesh.positions[3], glm::vec3(0.75f, -900, 2.5f));
    EXPECT_EQ(result.mesh.normals[4], glm::vec3(0, 0, 1));
    EXPECT_EQ(result.mesh.uvs[2], glm::vec2(0.2f, 0.5f));
    EXPECT_THAT(indices(result.mesh), ElementsAre(0, 1, 2, 0, 2, 3, 0, 3, 4));
  }
}

TEST(Ply, TakesWindowsAndOldMacLineEnds) {
  const std::string unix_text = ascii_header(4, 1) + square + "4 0 1 2 3";
  for (const char* line_end : {"\r\n", "\r"}) {
    std::string text;
    for (const char c : unix_text) c == '\n' ? text.append(line_end) : text.append(1, c);
    const PlyResult result = read(text);
    ASSERT_TRUE(result.ok) << result.messages();
    EXPECT_EQ(result.mesh.indices.size(), 6u);
  }
}

TEST(Ply, NamesTheLineOfABadNumberInText) {
  EXPECT_THAT(read(ascii_header(4, 1) + "0 0 0\n1 zero 0\n1 1 0\n0 1 0\n3 0 1 2\n").messages(),
              HasSubstr("mesh.ply:12: error: expected a number in vertex 1"));
}

TEST(Ply, RefusesPositionsThatAreNotFinite) {
  for (const char* bad : {"nan", "inf", "-inf", "1e39", "1e999"}) {
    const PlyResult result = read(ascii_header(4, 1) + "0 0 0\n1 0 0\n1 " + bad + " 0\n0 1 0\n3 0 1 2\n");
    EXPECT_FALSE(result.ok);
    EXPECT_THAT(result.messages(), HasSubstr("mesh.ply:13: error: vertex 2:")) << bad;
  }
}

TEST(Ply, RefusesIndicesOutOfRangeAndCountsThem) {
  for (const char* bad : {"4", "-1", "4294967296", "1.5"}) {
    const PlyResult result = read(ascii_header(4, 2) + square + "3 0 1 2\n3 0 " + bad + " 9\n");
    EXPECT_FALSE(result.ok);
    EXPECT_THAT(result.messages(), HasSubstr("mesh.ply:16: error: face 1 names vertex " + std::string(bad)));
    EXPECT_THAT(result.messages(), HasSubstr("the file has 4 vertices, 0 to 3 (and 1 more of this kind)"));
  }
}

TEST(Ply, RefusesAbsurdSizesBeforeAllocating) {
  const PlyResult ascii = read(
      "ply\nformat ascii 1.0\nelement vertex 4000000000000\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n");
  EXPECT_THAT(ascii.messages(), HasSubstr("mesh.ply:3: error: declares 4000000000000 rows of 'vertex'"));
  const PlyResult binary = read(
      "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 18446744073709551615\nproperty list uchar int vertex_indices\nend_header\n\x03");
  EXPECT_THAT(binary.messages(), HasSubstr("mesh.ply:7: error: declares 18446744073709551615 rows of 'face'"));
  const PlyResult list = read(
      "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uint int vertex_indices\nend_header\n\xff\xff\xff\xff\x01");
  EXPECT_THAT(list.messages(), HasSubstr("the file ends within face 0 of 1"));
}

TEST(Ply, SaysWhatIsWrongWithAHeader) {
  const auto mistakes = [](const std::string& text) { return read(text).messages(); };
  EXPECT_THAT(mistakes(""), HasSubstr("mesh.ply:1: error: the file is empty"));
  EXPECT_THAT(mistakes("solid cube"), HasSubstr("mesh.ply:1: error: not a PLY file"));
  EXPECT_THAT(mistakes("ply\nformat ascii 2.0\n"), HasSubstr("mesh.ply:2: error: expected 'format ascii 1.0'"));
  EXPECT_THAT(mistakes("ply\nelement vertex -3\n"), HasSubstr("mesh.ply:2: error: expected 'element NAME COUNT'"));
  EXPECT_THAT(mistakes("ply\nproperty float x\n"), HasSubstr("mesh.ply:2: error: 'property' before"));
  EXPECT_THAT(mistakes("ply\nelement vertex 3\nproperty half x\n"),
              HasSubstr("mesh.ply:3: error: unknown type 'half'"));
  EXPECT_THAT(mistakes("ply\nhello\n"), HasSubstr("mesh.ply:2: error: unknown header word 'hello'"));
  EXPECT_THAT(mistakes("ply\nformat ascii 1.0\n"),
              HasSubstr("mesh.ply:3: error: the header ends without 'end_header'"));
  EXPECT_THAT(mistakes("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n"),
              testing::AllOf(HasSubstr("mesh.ply:3: error: element 'vertex' has no number 'y'"),
                             HasSubstr("a point cloud is not a surface")));
}

TEST(Ply, ReportsAMissingFileWhereItWasNamed) {
  Mesh mesh;
  Diagnostics diagnostics;
  EXPECT_FALSE(read_ply("/nowhere/mesh.ply", {"scene.json", 7}, mesh, diagnostics));
  EXPECT_EQ(format_diagnostics(diagnostics),
            "scene.json:7: error: cannot read '/nowhere/mesh.ply': No such file or directory\n");
  Diagnostics folder;
  EXPECT_FALSE(read_ply("/tmp", {"scene.json", 7}, mesh, folder));
  EXPECT_THAT(format_diagnostics(folder), HasSubstr("it is a folder"));
}

TEST(Ply, LeavesOutFacesWithoutAreaWithAWarning) {
  const PlyResult result = read(ascii_header(4, 3) + square + "2 0 1\n3 0 1 2\n0\n");
  EXPECT_TRUE(result.ok);
  EXPECT_EQ(result.mesh.indices.size(), 3u);
  EXPECT_THAT(result.messages(), HasSubstr("mesh.ply:15: warning: face 0 has 2 corners and is left out (and 1 more"));
}

TEST(Ply, SurvivesBeingCutAtEveryByte) {
  for (const std::string& whole : {rich_binary(false), rich_binary(true), ascii_header(4, 1) + square + "4 0 1 2 3"}) {
    // The last four bytes of the rich file belong to an element nobody reads; the text's last number may lose digits
    // and be a number still.
    const size_t needed = whole.find("format ascii") == 4 ? whole.size() : whole.size() - 4;
    for (size_t length = 0; length < needed; ++length) {
      const PlyResult result = read(whole.substr(0, length));
      EXPECT_FALSE(result.ok) << "of " << whole.size() << " bytes, " << length;
      EXPECT_TRUE(result.diagnostics.has_errors());
    }
    EXPECT_TRUE(read(whole).ok);
  }
}

TEST(Ply, SurvivesEveryByteBeingReplaced) {
  const std::string whole = rich_binary(false);
  for (size_t i = 0; i < whole.size(); ++i) {
    for (const char garbage : {'\0', '\xff', '9', '\n', '\x7f'}) {
      std::string damaged = whole;
      damaged[i] = garbage;
      const PlyResult result = read(damaged);
      EXPECT_NE(result.ok, result.diagnostics.has_errors());
      if (!result.ok) continue;
      for (const uint32_t index : result.mesh.indices) EXPECT_LT(index, result.mesh.positions.size());
    }
  }
}

TEST(Ply, ReadsThePublishedMeshes) {
  const std::string path = METAMER_SOURCE_DIR "/../shared/scenes/kitchen/models/Mesh013.ply";
  if (!std::ifstream(path)) GTEST_SKIP() << "no " << path;
  Mesh mesh;
  Diagnostics diagnostics;
  ASSERT_TRUE(read_mesh(path, {}, mesh, diagnostics)) << format_diagnostics(diagnostics);
  EXPECT_TRUE(validate_mesh(mesh, {path, 0}, diagnostics));
  EXPECT_GT(mesh.indices.size(), 0u);
}

}  // namespace
}  // namespace metamer
