// Messages about the files that a scene names: tables, meshes, pictures. Each with its file and line.
#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

const std::string ply_vertices =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";  // lines 3 to 6

struct FileMistake {
  const char* name;      // of a file beside the scene
  std::string content;   // of it
  const char* world;     // which names it; from line 2 on
  const char* expected;  // the only message; a file's folder is left out
};

void PrintTo(const FileMistake& mistake, std::ostream* out) { *out << mistake.expected; }

FileMistake mesh(std::string content, const char* expected) {
  return {"m.ply", std::move(content), "\nShape \"plymesh\" \"string filename\" \"m.ply\"", expected};
}
FileMistake table(std::string content, const char* expected) {
  return {"t.spd", std::move(content), "\nMaterial \"diffuse\"\n\"spectrum reflectance\" \"t.spd\"", expected};
}

class PbrtFileMistakes : public testing::TestWithParam<FileMistake> {};

TEST_P(PbrtFileMistakes, AreNamedWithFileAndLine) {
  const TemporaryFolder folder;
  folder.write(GetParam().name, GetParam().content);
  const ReadScene read =
      read_scene_at(folder.write("scene", std::string("Camera \"perspective\" WorldBegin\n") + GetParam().world));
  EXPECT_THAT(read.messages, testing::ElementsAre(GetParam().expected));
  EXPECT_FALSE(read.ok);
}

INSTANTIATE_TEST_SUITE_P(
    Tables, PbrtFileMistakes,
    testing::ValuesIn(std::vector<FileMistake>{
        table("400 .1\n500 x\n", "t.spd:2: error: expected wavelength and value, not 'x'"),
        table("400 .1\n\"500\" 1\n", "t.spd:2: error: expected wavelength and value, not \"500\""),
        table("400 .1 500",
              "scene:4: error: Material \"diffuse\": 'reflectance': 3 numbers are not pairs of wavelength and value"),
        table(
            "500 .1 400 .1",
            "scene:4: error: Material \"diffuse\": 'reflectance': wavelengths must ascend, but 400 nm follows 500 nm"),
        table("400 -1 500 1", "scene:4: error: Material \"diffuse\": 'reflectance': negative values are not possible"),
    }));

INSTANTIATE_TEST_SUITE_P(
    Meshes, PbrtFileMistakes,
    testing::ValuesIn(std::vector<FileMistake>{
        mesh("", "m.ply:1: error: the file is empty; expected a PLY mesh"),
        mesh("solid", "m.ply:1: error: not a PLY file: the first line must be 'ply'"),
        mesh("ply\n" + ply_vertices + "end_header\n", "m.ply:6: error: the header has no 'format' line"),
        mesh("ply\ncomment " + std::string(5000, 'x') + "\n",
             "m.ply:2: error: a header line of 5008 bytes; this is not a PLY file"),
        mesh("ply\nformat ascii 1.1\n",
             "m.ply:2: error: expected 'format ascii 1.0', 'format binary_little_endian 1.0' or 'format "
             "binary_big_endian 1.0'"),
        mesh("ply\nelemnt vertex 3\n",
             "m.ply:2: error: unknown header word 'elemnt'; expected format, comment, obj_info, element, property or "
             "end_header"),
        mesh("ply\nelement vertex many\n",
             "m.ply:2: error: expected 'element NAME COUNT' with a count from 0 to 2^64-1"),
        mesh("ply\nformat ascii 1.0\nelement face 0\nelement face 0\nend_header\n",
             "m.ply:4: error: element 'face' is declared twice"),
        mesh("ply\nproperty float x\n", "m.ply:2: error: 'property' before the first 'element'"),
        mesh("ply\nelement vertex 1\nproperty float\n",
             "m.ply:3: error: expected 'property TYPE NAME' or 'property list COUNT_TYPE TYPE NAME'"),
        mesh("ply\nelement vertex 1\nproperty half x\n",
             "m.ply:3: error: unknown type 'half'; expected char, uchar, short, ushort, int, uint, float or double"),
        mesh("ply\nelement face 1\nproperty list float int i\n",
             "m.ply:3: error: the count of a list must be of an integer type"),
        mesh("ply\nformat ascii 1.0\n", "m.ply:3: error: the header ends without 'end_header'"),
        mesh(
            "ply\nformat ascii 1.0\nelement vertex 900\nproperty float x\nend_header\n0",
            "m.ply:3: error: declares 900 rows of 'vertex', at least 2 bytes each, but only 1 bytes follow the header; "
            "the file was cut short or its header is wrong"),
        mesh("ply\nformat ascii 1.0\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n",
             "m.ply: error: the header declares no element 'vertex'"),
        mesh("ply\nformat ascii 1.0\n" + ply_vertices + "end_header\n0 0 0 0 0 0 0 0 0",
             "m.ply: error: the header declares no element 'face'; a point cloud is not a surface"),
        mesh("ply\nformat ascii 1.0\n" + ply_vertices + "element tristrips 0\nend_header\n0 0 0 0 0 0 0 0 0",
             "m.ply: error: triangle strips ('tristrips') are not supported; expected an element 'face'"),
        mesh("ply\nformat ascii 1.0\n" + ply_vertices +
                 "element face 1\nproperty int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0 1",
             "m.ply:7: error: element 'face' has no list 'vertex_indices'"),
        mesh("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nelement face 0\n"
             "property list uchar int vertex_indices\nend_header\n0 0",
             "m.ply:3: error: element 'vertex' has no number 'z'"),
        mesh("ply\nformat ascii 1.0\n" + ply_vertices +
                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n0.00 0.00 0.00\n1.00 0.00 "
                 "0.00\n0 1",
             "m.ply:12: error: the file ends within vertex 2 of 3; it was cut short"),
        mesh("ply\nformat ascii 1.0\n" + ply_vertices +
                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 a\n0 1 0\n3 0 1 2",
             "m.ply:11: error: expected a number in vertex 1"),
        mesh("ply\nformat ascii 1.0\n" + ply_vertices +
                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 inf\n0 1 0\n3 0 1 2",
             "m.ply:11: error: vertex 1: inf is not a finite number in single precision"),
        mesh("ply\nformat ascii 1.0\n" + ply_vertices +
                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3",
             "m.ply:13: error: face 0 names vertex 3, but the file has 3 vertices, 0 to 2"),
    }));

TEST(PbrtPlyWarnings, FacesOfTwoCornersAreLeftOut) {
  const TemporaryFolder folder;
  folder.write("m.ply", "ply\nformat ascii 1.0\n" + ply_vertices +
                            "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                            "0 0 0\n1 0 0\n0 1 0\n2 0 1");
  const ReadScene read =
      read_scene_at(folder.write("scene", "WorldBegin Shape \"plymesh\" \"string filename\" \"m.ply\""));
  EXPECT_THAT(read.messages, testing::Contains("m.ply:13: warning: face 0 has 2 corners and is left out"));
}

INSTANTIATE_TEST_SUITE_P(
    Pictures, PbrtFileMistakes,
    testing::ValuesIn(std::vector<FileMistake>{
        {"sky.pfm", std::string("PF\n1 1\n-1.0\n") + std::string(12, '\0'),
         "\nLightSource \"infinite\" \"string filename\" \"sky.pfm\"\n\"float illuminance\" 3",
         "scene:4: error: LightSource \"infinite\": the image is black above the horizon"},
        {"sky.pfm", std::string("PF\n1 1\n-1.0\n") + std::string(12, '\0'),
         "\nLightSource \"infinite\"\n\"string filename\" \"sky.pfm\" \"rgb L\" [1 1 1]",
         "scene:4: error: LightSource \"infinite\": 'L' and 'filename' exclude each other"},
        {"sky.pfm", std::string("PF\n1 1\n-1.0\n") + std::string(8, '\0') + std::string("\0\0\x80\xbf", 4),
         "LightSource \"infinite\" \"string filename\" \"sky.pfm\"",
         "sky.pfm: error: pixel (0, 0) holds -1; expected finite values of at least 0 (1 such values in all)"},
    }));

TEST(PbrtMeshMistakes, CountsAndNumbersOfAMeshAreCheckedAtItsShape) {
  const auto message = [](const std::string& rest) {
    const ReadScene read = read_world("\nShape \"trianglemesh\" " + rest);
    EXPECT_FALSE(read.ok);
    return read.messages.size() == 1 ? read.messages[0] : format_diagnostics(read.diagnostics);
  };
  const std::string positions = "\"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0] ";
  EXPECT_EQ(message(positions + "\"integer indices\" [0 1 2 3]"),
            "scene:3: error: 4 indices; expected three for each triangle");
  EXPECT_EQ(message(positions + "\"integer indices\" [0 1 2 0 7 -1]"),
            "scene:3: error: triangle 1 names vertex 7, but there are 4 vertices, counted from 0 (2 such indices in "
            "all)");
  EXPECT_EQ(message(positions + "\"integer indices\" [0 1 2] \"normal N\" [0 0 1]"),
            "scene:3: error: 1 normals for 4 positions; expected one for each, or none");
  EXPECT_EQ(message(positions + "\"integer indices\" [0 1 2] \"point2 uv\" [0 0 1 1]"),
            "scene:3: error: 2 uvs for 4 positions; expected one for each, or none");
}

TEST(PbrtValueMistakes, EveryTypeSaysWhatItExpects) {
  const auto message = [](const std::string& parameter) {
    return read_world("Shape \"sphere\"\n" + parameter).messages.at(0);
  };
  EXPECT_EQ(message("\"bool a\" 1"), "scene:3: error: 'bool a' expects true or false, not '1'");
  EXPECT_EQ(message("\"integer a\" \"x\""), "scene:3: error: 'integer a' expects integers, not \"x\"");
  EXPECT_EQ(message("\"float a\" \"x\""), "scene:3: error: 'float a' expects numbers, not \"x\"");
  EXPECT_EQ(message("\"string a\" 1"), "scene:3: error: 'string a' expects a string, not '1'");
  EXPECT_EQ(message("\"texture a\" 1"), "scene:3: error: 'texture a' expects a string, not '1'");
  EXPECT_EQ(message("\"spectrum a\" [ [ ]"), "scene:3: error: 'spectrum a' expects numbers or a name, not '['");
}

TEST(PbrtGuesses, EndAfterAHundredMistakesAsEachComparesWithAllNames) {
  std::string world = "MakeNamedMaterial \"blue\" \"string type\" \"diffuse\"\n";
  for (int i = 0; i < 300; ++i)
    world += std::string("NamedMaterial \"blue") + static_cast<char>('a' + i / 26) + static_cast<char>('a' + i % 26) +
             "\"\n";
  const ReadScene read = read_world(world);
  size_t guesses = 0;
  for (const Diagnostic& d : read.diagnostics.all()) guesses += d.message.find("did you mean") != std::string::npos;
  EXPECT_EQ(read.diagnostics.error_count(), 300u);
  EXPECT_EQ(guesses, 100u);
}

TEST(PbrtPower, ALightWithoutAreaCannotEmitIt) {
  const ReadScene read = read_world(
      "AreaLightSource \"diffuse\" \"float power\" 5\n"
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 1 1 2 2 2]");
  EXPECT_THAT(
      read.messages,
      testing::ElementsAre("scene:3: warning: a light without area cannot emit the 'power' of its AreaLightSource"));
}

}  // namespace
}  // namespace metamer
