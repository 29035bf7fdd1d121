// Compressed files: what zlib packed is read, and everything that can be wrong with one is an error that names it.
#include "scenes/gzip.h"

#include <gmock/gmock.h>
#include <zlib.h>

#include "scenes/meshes/read_mesh.h"
#include "scenes/read_scene.h"
#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

using testing::HasSubstr;

std::string gzip(const std::string& text, int level = 6) {
  z_stream stream = {};
  EXPECT_EQ(deflateInit2(&stream, level, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

struct Unpacked {
  bool ok = false;
  std::string text, messages;
};
Unpacked unpack(const std::string& content) {
  const TemporaryFolder folder;
  FileBytes bytes;
  Diagnostics diagnostics;
  Unpacked result;
  result.ok = read_packed_file(folder.write("file", content), {"scene", 3}, bytes, diagnostics);
  if (result.ok) result.text = bytes.text();
  result.messages = format_diagnostics(diagnostics);
  return result;
}

const std::string triangle =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST(Gzip, PlainFilesAreReadAsTheyAre) {
  EXPECT_EQ(unpack("plain").text, "plain");
  EXPECT_EQ(unpack("\x1f").text, "\x1f");
  EXPECT_TRUE(unpack("").ok);
}

TEST(Gzip, UnpacksOneMemberManyAndPadding) {
  std::string text;
  for (int i = 0; i < 100'000; ++i) text += std::to_string(i * 7919 % 10007) + ' ';
  EXPECT_EQ(unpack(gzip(text)).text, text);
  EXPECT_EQ(unpack(gzip(text, 0)).text, text) << "stored";
  EXPECT_EQ(unpack(gzip(text) + gzip("more") + gzip("")).text, text + "more");
  EXPECT_EQ(unpack(gzip("x") + std::string(512, '\0')).text, "x");
  EXPECT_EQ(unpack(gzip("")).text, "");
}

TEST(Gzip, FilesCutShortAnywhereAreErrorsThatNameThem) {
  const std::string packed = gzip(triangle);
  for (size_t i = 2; i < packed.size(); ++i) {
    const Unpacked cut = unpack(packed.substr(0, i));
    ASSERT_FALSE(cut.ok) << i;
    EXPECT_THAT(cut.messages, testing::StartsWith("scene:3: error: cannot unpack '"));
    EXPECT_THAT(cut.messages, HasSubstr("/file': the compressed data ends too early; the file was cut short"));
  }
}

TEST(Gzip, DamageIsFoundByTheChecksum) {
  const std::string packed = gzip(triangle);
  for (size_t i = 10; i < packed.size(); ++i) {
    std::string damaged = packed;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    EXPECT_FALSE(unpack(damaged).ok) << i;
  }
  EXPECT_THAT(unpack(packed + "rest").messages, HasSubstr("it has bytes behind the end of the compressed data"));
  std::string wrong_sum = packed;
  wrong_sum[packed.size() - 6] = static_cast<char>(wrong_sum[packed.size() - 6] ^ 1);
  EXPECT_THAT(unpack(wrong_sum).messages, HasSubstr("the compressed data is damaged: incorrect data check"));
}

TEST(Gzip, BombsAreBounded) {
  // 400 MB of zeros in 2 MB: more than most_unpacked_bytes allows.
  const std::string member = gzip(std::string(100'000'000, '\0'), 1);
  const Unpacked bomb = unpack(member + member + member + member);
  EXPECT_FALSE(bomb.ok);
  EXPECT_THAT(bomb.messages,
              HasSubstr(std::to_string(most_unpacked_bytes(4 * member.size())) + ", which no scene or mesh does"));
}

TEST(Gzip, MeshesAndScenesMayBeCompressedWhateverTheirNames) {
  const TemporaryFolder folder;
  folder.write("t.ply.gz", gzip(triangle));
  folder.write("odd.ply", gzip(triangle));
  folder.write("part.pbrt.gz", gzip("Shape \"plymesh\" \"string filename\" \"t.ply.gz\"\n"));
  folder.write("cut.ply.gz", gzip(triangle).substr(0, 40));
  const ReadScene read = read_scene_at(folder.write(
      "scene.pbrt.gz", gzip("Camera \"perspective\" WorldBegin\nInclude \"part.pbrt.gz\"\n"
                            "Shape \"plymesh\" \"string filename\" \"odd.ply\"\nImport \"part.pbrt.gz\"\n")));
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_EQ(read.count<Geometry>(), 3u);
  EXPECT_EQ(read.scene.meshes.size(), 2u);
  EXPECT_EQ(read.scene.location(read.entity<Geometry>(1)).line, 3u) << "lines are those of the text";
  const ReadScene cut =
      read_world("\nShape \"plymesh\" \"string filename\" \"" + (folder.path() / "cut.ply.gz").string() + "\"");
  EXPECT_THAT(format_diagnostics(cut.diagnostics), HasSubstr("scene:3: error: cannot unpack '"));

  Scene scene;
  Mesh mesh;
  Diagnostics diagnostics;
  EXPECT_TRUE(read_scene((folder.path() / "scene.pbrt.gz").string(), scene, diagnostics));
  EXPECT_TRUE(read_mesh((folder.path() / "t.ply.gz").string(), {}, mesh, diagnostics));
  EXPECT_EQ(packed_file_extension("a/b.PBRT.GZ"), "pbrt");
  EXPECT_EQ(packed_file_extension("a/b.gz"), "");
  EXPECT_EQ(packed_file_extension("a/b.json"), "json");
}

}  // namespace
}  // namespace metamer
