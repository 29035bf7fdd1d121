// What is said about files that are wrong: each mistake with its line, all of a file in one go, and never a crash.
#include <gmock/gmock.h>
#include <json/reader.h>

#include <fstream>
#include <memory>
#include <set>
#include <sstream>

#include "scenes/native/keys.h"
#include "scenes/native/read_native.h"
#include "scenes/read_scene.h"
#include "tests/scenes/support/native_messages.h"

namespace metamer {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

// The messages about one entity, which stands on line 3.
std::string messages_of_entity(const std::string& entity) {
  return messages_of("{\"metamer\": 1, \"entities\": [\n\n" + entity + "\n]}");
}

std::string messages_of_material(const std::string& material) {
  return messages_of("{\"metamer\": 1, \"materials\": {\n\"m\": " + material + "\n}, \"entities\": []}");
}

std::string messages_of_transform(const std::string& transform) {
  return messages_of_entity("{\"transform\": " + transform + "}");
}

TEST(NativeMistakes, FilesThatCannotBeRead) {
  const auto messages = [](const std::string& path) {
    Scene scene;
    Diagnostics diagnostics;
    EXPECT_FALSE(read_scene(path, scene, diagnostics));
    return format_diagnostics(diagnostics);
  };
  EXPECT_EQ(messages("/nowhere.json"),
            "/nowhere.json: error: cannot read '/nowhere.json': No such file or directory\n");
  EXPECT_THAT(messages("/tmp"), HasSubstr("it is a folder"));
  EXPECT_THAT(messages("/dev/zero"), HasSubstr("not a regular file"));
  EXPECT_THAT(messages(""), HasSubstr("not a file name"));
  const TemporaryFile text("scene.txt", "Cornell box");
  EXPECT_THAT(messages(text.path()), HasSubstr("expected a file ending in .json or .pbrt"));
}

TEST(NativeMistakes, ContentDecidesWhereTheExtensionDoesNot) {
  const TemporaryFile file("scene", "// mine\n{\"metamer\": 1, \"entities\": []}");
  Scene scene;
  Diagnostics diagnostics;
  EXPECT_TRUE(read_scene(file.path(), scene, diagnostics)) << format_diagnostics(diagnostics);
}

TEST(NativeMistakes, TextThatIsNoJson) {
  EXPECT_THAT(messages_of(""), StartsWith("scene.json:1: error: the file is empty"));
  EXPECT_THAT(messages_of(" \n\n "), StartsWith("scene.json:1: error: the file is empty"));
  EXPECT_THAT(messages_of("{\n\"metamer\": 1\n\"entities\": []}"),
              StartsWith("scene.json:3: error: not JSON: Missing ',' or '}'"));
  EXPECT_THAT(messages_of("{\"metamer\": 1,\n\"entities\": [\n"), StartsWith("scene.json:3: error: not JSON:"));
  EXPECT_THAT(messages_of("{\"metamer\": 1, \"entities\": []}\n}"), StartsWith("scene.json:2: error: not JSON: Extra"));
  EXPECT_THAT(messages_of("{\"metamer\": NaN, \"entities\": []}"), StartsWith("scene.json:1: error: not JSON"));
  EXPECT_THAT(messages_of("\n\xff\xfe\x12\x80"), StartsWith("scene.json:2: error: not JSON"));
  EXPECT_THAT(messages_of(std::string("{\n\0}", 4)), StartsWith("scene.json:2: error: a zero byte"));
  EXPECT_THAT(messages_of("[1, 2]"), StartsWith("scene.json:1: error: 'a scene' is an array of 2; expected an object"));
  EXPECT_THAT(messages_of("{\n}"), AllOf(HasSubstr("scene.json:1: error: a scene lacks the required key 'metamer'"),
                                         HasSubstr("a scene lacks the required key 'entities'")));
}

TEST(NativeMistakes, NestingWithoutEnd) {
  EXPECT_THAT(messages_of("{\n\"metamer\": " + std::string(1000000, '[')),
              "scene.json:2: error: brackets nest deeper than 100\n");
  EXPECT_THAT(messages_of(std::string(100, '[') + std::string(100, ']')),
              StartsWith("scene.json:1: error: 'a scene' is"));
  std::string objects = "{\"metamer\": 1, \"entities\": ";
  for (int i = 0; i < 50000; ++i) objects += "{\"a\":";
  EXPECT_THAT(messages_of(objects), HasSubstr("brackets nest deeper than 100"));
  // Brackets in strings and comments do not count.
  EXPECT_EQ(messages_of("// " + std::string(200, '[') + "\n/* " + std::string(200, '{') +
                        "*/{\"metamer\": 1, \"entities\": [{\"name\": \"\\\"" + std::string(200, '[') + "\"}]}"),
            "");
}

TEST(NativeMistakes, RepeatedKeysAndImpossibleNumbersDoNotHideOthers) {
  EXPECT_EQ(messages_of("{\"metamer\": 1,\n\"settings\": {\"samples\": 1e999,\n\"seed\": -1e400,\n\"size\": \"big\"},\n"
                        "\"settings\": {},\n\"entities\": [],\n\"units\": \"km\"}"),
            "scene.json:2: error: the number 1e999 is malformed, or beyond what double precision holds\n"
            "scene.json:3: error: the number -1e400 is malformed, or beyond what double precision holds\n"
            "scene.json:4: error: 'size' is the string \"big\"; expected [width, height] in pixels\n"
            "scene.json:5: error: the key 'settings' stands twice in one object\n"
            "scene.json:7: error: 'units' is the string \"km\"; expected 'm', 'cm' or 'mm' (did you mean 'm'?)\n");
}

TEST(NativeMistakes, UnknownKeysNameTheNearest) {
  EXPECT_EQ(
      messages_of("{\"metamer\": 1,\n\"setings\":\n\n{}, \"entities\": [\n{\"nme\": \"x\"},\n{\"color\": 1}]}"),
      "scene.json:2: error: unknown key 'setings' in a scene (did you mean 'settings'?)\n"
      "scene.json:5: error: unknown key 'nme' in an entity (did you mean 'name'?)\n"
      "scene.json:6: error: unknown key 'color' in an entity; it may have 'name', 'parent', 'transform', 'motion', "
      "'geometry', 'material', 'light', 'camera', 'visibility' or 'media'\n");
  EXPECT_EQ(messages_of_entity("{\"geometry\": {\"type\": \"sphere\", \"radis\": 2}}"),
            "scene.json:3: error: unknown key 'radis' in geometry of type 'sphere' (did you mean 'radius'?)\n");
}

TEST(NativeMistakes, TypesOfObjects) {
  EXPECT_EQ(messages_of_entity("{\"geometry\": {\"type\": \"shpere\"}}"),
            "scene.json:3: error: 'type' is the string \"shpere\"; expected 'mesh', 'sphere', 'disk', 'cylinder', "
            "'curves' or 'rectangle' "
            "(did you mean 'sphere'?)\n");
  EXPECT_EQ(messages_of_entity("{\"light\": {}}"),
            "scene.json:3: error: 'light' has no 'type'; expected 'area', 'point', 'spot', 'directional', "
            "'environment', 'goniometric', 'projection' or 'sky'\n");
  EXPECT_EQ(messages_of_entity("{\"camera\": \"front\"}"),
            "scene.json:3: error: 'camera' is the string \"front\"; expected an object with a 'type' of 'perspective', "
            "'orthographic' or 'spherical'\n");
}

TEST(NativeMistakes, NumbersOutOfRange) {
  EXPECT_EQ(messages_of_material("{\"type\": \"diffuse\",\n\"reflectance\": -0.1}"),
            "scene.json:3: error: 'reflectance' is the number -0.1; expected a number from 0 to 1 (in material 'm')\n");
  EXPECT_THAT(messages_of_material("{\"type\": \"diffuse\", \"reflectance\": 1.01}"), HasSubstr("from 0 to 1"));
  EXPECT_THAT(
      messages_of_material("{\"type\": \"diffuse\",\n\"reflectance\": {\"table\": [[400, 0.5],\n[500, 1.5]]}}"),
      "scene.json:4: error: 'table[1][1]' is the number 1.5; expected a number from 0 to 1 (in material 'm')\n");
  EXPECT_THAT(messages_of_material("{\"type\": \"diffuse\", \"reflectance\": {\"rgb\": [0.5, -1, 2]}}"),
              AllOf(HasSubstr("'rgb[1]' is the number -1"), HasSubstr("'rgb[2]' is the number 2")));
  EXPECT_THAT(
      messages_of_material("{\"type\": \"diffuse\", \"reflectance\": {\"rgb\": [0.4, 0.4, 0.6], \"scale\": 3}}"),
      AllOf(HasSubstr("scene.json:2: error: 'reflectance' reaches "), HasSubstr("expected values from 0 to 1")));
  EXPECT_THAT(messages_of_material("{\"type\": \"diffuse\", \"reflectance\": \"D65\"}"),
              HasSubstr("'reflectance' reaches 11"));
  EXPECT_THAT(messages_of_material("{\"type\": \"dielectric\", \"eta\": 0}"), HasSubstr("expected a number above 0"));
  EXPECT_THAT(messages_of_material("{\"type\": \"dielectric\", \"eta\": 1e-60}"),
              HasSubstr("expected a number above 0"));
  EXPECT_THAT(messages_of_material("{\"type\": \"conductor\", \"eta\": 1, \"kappa\": -2}"),
              HasSubstr("'kappa' is the number -2; expected a number of at least 0"));
  EXPECT_THAT(messages_of_material("{\"type\": \"conductor\", \"metal\": \"Au\", \"roughness\": -1.5}"),
              HasSubstr("'roughness' is the number -1.5; expected a number of at least 0"));
  for (const char* fov : {"0", "180", "-45", "1e30", "179.999999999"}) {
    EXPECT_THAT(messages_of_entity("{\"camera\": {\"type\": \"perspective\", \"fov\": " + std::string(fov) + "}}"),
                HasSubstr("expected a number above 0 and below 180"))
        << fov;
  }
  EXPECT_THAT(messages_of_entity("{\"geometry\": {\"type\": \"sphere\", \"radius\": 1e39}}"),
              HasSubstr("expected a number"));
  EXPECT_THAT(messages_of_entity("{\"geometry\": {\"type\": \"disk\", \"radius\": 1, \"inner_radius\": 1}}"),
              HasSubstr("'inner_radius' is not smaller than 'radius'"));
  EXPECT_THAT(messages_of("{\"metamer\": 2, \"entities\": [], \"settings\": {\"size\": [0, 1.5], \"samples\": 0}}"),
              AllOf(HasSubstr("'metamer' is the number 2; expected 1\n"),
                    HasSubstr("'size[0]' is the number 0; expected a whole number from 1"),
                    HasSubstr("'size[1]' is the number 1.5"), HasSubstr("'samples' is the number 0")));
  EXPECT_THAT(
      messages_of("{\"metamer\": 1, \"entities\": [], \"settings\": {\n\"integrator\": \"locl\",\n\"shadows\": 1}}"),
      AllOf(HasSubstr("scene.json:2: error: 'integrator' is"), HasSubstr("did you mean 'local'?"),
            HasSubstr("scene.json:3: error: 'shadows' is the number 1; expected")));
}

TEST(NativeMistakes, SpectraThatAreNone) {
  const auto messages = [](const std::string& spectrum) {
    return messages_of_material("{\"type\": \"dielectric\", \"eta\": " + spectrum + "}");
  };
  EXPECT_THAT(messages("true"), HasSubstr("'eta' is true; expected a spectrum: a number, a name, or an object"));
  EXPECT_THAT(messages("{}"), HasSubstr("expected 'constant', 'table', 'named', 'blackbody', 'daylight', 'rgb', "));
  EXPECT_THAT(messages("{\"constant\": 1, \"named\": \"BK7\"}"),
              HasSubstr("'constant' and 'named' exclude each other"));
  EXPECT_THAT(messages("{\"constant\": 1.5, \"space\": \"srgb\"}"), HasSubstr("'space' belongs to 'rgb' only"));
  EXPECT_THAT(messages("{\"table\": [[400, 1]]}"), HasSubstr("a table needs at least two wavelengths"));
  EXPECT_THAT(messages("{\"table\": [[400, 1], [400, 2]]}"),
              HasSubstr("wavelengths must ascend, but 400 nm follows 400 nm"));
  EXPECT_THAT(messages("{\"table\": [[400, 1], 5]}"),
              HasSubstr("'table[1]' is the number 5; expected a pair [nm, value]"));
  EXPECT_THAT(messages("\"BK8\""), HasSubstr("unknown spectrum 'BK8' (did you mean 'BK7'?)"));
  EXPECT_THAT(messages("{\"blackbody\": -5}"), HasSubstr("'blackbody' is the number -5; expected a number above 0"));
  EXPECT_THAT(messages("{\"daylight\": 100}"), HasSubstr("expected a number from 4000 to 25000"));
  EXPECT_THAT(messages("{\"rgb\": [1, 2, 3], \"space\": \"srbg\"}"), HasSubstr("(did you mean 'srgb'?)"));
}

TEST(NativeMistakes, SpectraOfTheFile) {
  EXPECT_EQ(
      messages_of("{\"metamer\": 1, \"spectra\": {\n\"a\": {\"blackbdy\": 3000},\n\"b\": \"a\",\n\"high\": 2},\n"
                  "\"materials\": {\n\"m\": {\"type\": \"diffuse\", \"reflectance\": \"high\"},\n"
                  "\"n\": {\"type\": \"diffuse\", \"reflectance\": \"hihg\"},\n"
                  "\"o\": {\"type\": \"dielectric\", \"eta\": \"high\"}}, \"entities\": []}"),
      "scene.json:2: error: unknown key 'blackbdy' in a spectrum (did you mean 'blackbody'?)\n"
      "scene.json:2: error: expected 'constant', 'table', 'named', 'blackbody', 'daylight', 'rgb', 'samples' or "
      "'sigmoid'\n"
      "scene.json:3: error: unknown spectrum 'a'; entries of 'spectra' may name built-in spectra only\n"
      "scene.json:6: error: 'reflectance' reaches 2; expected values from 0 to 1 at every wavelength (in material "
      "'m')\nscene.json:7: error: unknown spectrum 'hihg' (did you mean 'high'?) (in material 'n')\n");
}

TEST(NativeMistakes, MaterialsThatAreIncomplete) {
  EXPECT_THAT(messages_of_material("{\"type\": \"diffuse\"}"), HasSubstr("lacks the required key 'reflectance'"));
  EXPECT_THAT(messages_of_material("{\"type\": \"conductor\"}"),
              HasSubstr("scene.json:2: error: expected 'metal', 'eta' or 'reflectance'"));
  EXPECT_THAT(messages_of_material("{\"type\": \"conductor\", \"eta\": 1}"),
              HasSubstr("lacks the required key 'kappa'"));
  EXPECT_THAT(messages_of_material("{\"type\": \"conductor\", \"metal\": \"Au\", \"kappa\": 1}"),
              HasSubstr("'metal' and 'kappa' exclude each other"));
  EXPECT_THAT(messages_of_material("{\"type\": \"conductor\", \"metal\": \"Gold\"}"),
              HasSubstr("unknown metal 'Gold'; known are Ag, Al, Au, Cr, Cu, CuZn, Fe, MgO, Ni, Pt, Ti, TiO2, W"));
  EXPECT_THAT(messages_of_material("{\"type\": \"dielectric\", \"glass\": \"D65\"}"), HasSubstr("unknown glass 'D65'"));
  EXPECT_THAT(messages_of_material("{\"type\": \"dielectric\", \"glass\": \"BK7\", \"fresnel\": \"fast\"}"),
              HasSubstr("expected 'exact' or 'schlick'"));
}

TEST(NativeMistakes, RoughMaterials) {
  const auto messages = [](const std::string& keys) {
    return messages_of_material("{\"type\": \"rough\", " + keys + "}");
  };
  EXPECT_EQ(messages("\"kd\": 0.3, \"ks\": 5, \"shininess\": 500"), "");
  EXPECT_EQ(messages("\"kd\": {\"rgb\": [0.3, 0.2, 0.1]}"), "");
  EXPECT_THAT(messages("\"kd\": 0.3, \"ks\": 0.5, \"shininess\": -1"),
              HasSubstr("scene.json:2: error: 'shininess' is the number -1; expected a number from 0 to 1000000"));
  EXPECT_THAT(messages("\"kd\": -0.1"), HasSubstr("'kd' is the number -0.1; expected a number of at least 0"));
  EXPECT_THAT(messages("\"ks\": {\"table\": [[400, 1], [500, -1]]}, \"shininess\": 3"),
              HasSubstr("'table[1][1]' is the number -1"));
  EXPECT_THAT(messages("\"kd\": 0.3, \"ks\": 0.5"), HasSubstr("lacks the required key 'shininess'"));
  EXPECT_THAT(messages("\"ks\": 1.5, \"shininess\": 3, \"normalized\": true"),
              HasSubstr("'ks' is the number 1.5; expected a number from 0 to 1"));
  EXPECT_THAT(messages("\"kd\": 0.1, \"shinyness\": 3"), HasSubstr("(did you mean 'shininess'?)"));
}

TEST(NativeMistakes, NamesThatNobodyHas) {
  EXPECT_EQ(
      messages_of("{\"metamer\": 1,\n\"materials\": {\"steel\": {\"type\": \"diffuse\", \"reflectance\": 0.5}},\n"
                  "\"meshes\": {\"bunny\": {\"positions\": [], \"indices\": []}},\n\"entities\": [\n"
                  "{\"name\": \"table\"},\n{\"material\": \"stele\"},\n{\"parent\": \"tabel\"},\n"
                  "{\"geometry\": {\"type\": \"mesh\", \"mesh\": \"bunni\"}},\n{\"material\": \"table\"},\n"
                  "{\"name\": \"table\"},\n{\"name\": \"steel\"},\n{\"name\": \"\"}]}"),
      "scene.json:6: error: unknown material 'stele' (did you mean 'steel'?)\n"
      "scene.json:7: error: unknown entity 'tabel' (did you mean 'table'?)\n"
      "scene.json:8: error: unknown mesh 'bunni' (did you mean 'bunny'?)\n"
      "scene.json:9: error: 'table' (line 5) has no material of its own\n"
      "scene.json:10: error: the name 'table' is taken by line 5; entities and materials need names of their own\n"
      "scene.json:11: error: the name 'steel' is taken by line 2; entities and materials need names of their own\n"
      "scene.json:12: error: 'name' is the string \"\"; expected a string with at least one character\n");
}

TEST(NativeMistakes, ParentsInACircle) {
  EXPECT_EQ(messages_of("{\"metamer\": 1, \"entities\": [\n{\"name\": \"a\", \"parent\": \"c\"},\n{\"name\": \"b\", "
                        "\"parent\": \"a\"},\n{\"name\": \"c\", \"parent\": \"b\"},\n{\"parent\": \"a\"},\n"
                        "{\"name\": \"self\", \"parent\": \"self\"}]}"),
            "scene.json:2: error: parents run in a circle: 'a' in 'c' in 'b' in 'a'\n"
            "scene.json:6: error: parents run in a circle: 'self' in 'self'\n");
  std::string many = "{\"metamer\": 1, \"entities\": [{\"name\": \"0\", \"parent\": \"19999\"}";
  for (int i = 1; i < 20000; ++i)
    many += ", {\"name\": \"" + std::to_string(i) + "\", \"parent\": \"" + std::to_string(i - 1) + "\"}";
  EXPECT_THAT(messages_of(many + "]}"), AllOf(HasSubstr("parents run in a circle"), HasSubstr("in ...")));
}

TEST(NativeMistakes, TransformsThatFlatten) {
  EXPECT_EQ(
      messages_of_transform("[{\"translate\": [1, 2, 3]},\n{\"scale\": [1, 0, 1]},\n{\"scale\": 2}]"),
      "scene.json:4: error: the transform is singular: it flattens everything; expected one that can be inverted\n");
  const std::string singular = "scene.json:3: error: the transform is singular";
  EXPECT_THAT(messages_of_transform("{\"matrix\": [[1, 2, 3, 0], [4, 5, 6, 0], [7, 8, 9, 0]]}"), HasSubstr(singular));
  EXPECT_THAT(messages_of_transform("{\"scale\": 0}"), HasSubstr(singular));
  EXPECT_THAT(messages_of_transform("{\"scale\": 1e-60}"), HasSubstr(singular));
  EXPECT_THAT(messages_of_transform("[{\"scale\": 1e30}, {\"scale\": 1e30}]"), HasSubstr("beyond single precision"));
  EXPECT_EQ(messages_of_transform("{\"scale\": [1e-12, 1, -1e9]}"), "");
  EXPECT_THAT(messages_of_transform("{\"rotate\": {\"axis\": [0, 0, 0], \"degrees\": 5}}"),
              HasSubstr("'axis' is zero"));
  EXPECT_THAT(messages_of_transform("{\"look_at\": {\"from\": [1, 1, 1], \"to\": [1, 1, 1]}}"),
              HasSubstr("the same point"));
  EXPECT_THAT(messages_of_transform("{\"look_at\": {\"from\": [0, 5, 0], \"to\": [0, 0, 0]}}"),
              HasSubstr("'up' is parallel"));
  EXPECT_THAT(messages_of_transform("{\"matrix\": [[1, 0, 0, 0], [0, 1, 0], [0, 0, 1, 0]]}"),
              HasSubstr("'matrix' is an array of 3; expected an array of 4 numbers"));
  EXPECT_THAT(messages_of_transform("{\"translate\": [0, 0, 0], \"scale\": 2}"), HasSubstr("exclude each other"));
}

TEST(NativeMistakes, MeshesOfTheFile) {
  EXPECT_EQ(
      messages_of("{\"metamer\": 1, \"entities\": [], \"meshes\": {\n\"a\": {\"positions\": [[0, 0, 0], [1, 0, 0],\n"
                  "[1, 1e39, 0]],\n\"indices\": [[0, 1, 2],\n[0, 1, 3],\n[0, 1]]},\n\"b\": {},\n"
                  "\"c\": {\"file\": \"none.ply\"},\n\"d\": {\"file\": \"mesh.stl\", \"uvs\": []},\n"
                  "\"e\": {\"positions\": [[0, 0, 0]], \"normals\": [[0, 0, 1], [0, 0, 1]], \"indices\": []}}}"),
      "scene.json:3: error: 'positions[2][1]' is the number 1e+39; expected a number within single precision\n"
      "scene.json:5: error: 'indices[1]' is the number 3; expected the number of one of the 3 positions, counted from "
      "0\n"
      "scene.json:6: error: 'indices[2]' is an array of 2; expected an array of 3 or more vertex numbers\n"
      "scene.json:7: error: expected 'file' or 'positions'\n"
      "scene.json:8: error: cannot read 'none.ply': No such file or directory\n"
      "scene.json:9: error: 'uvs' goes with 'positions' only\n"
      "scene.json:9: error: 'mesh.stl': unknown kind of mesh; expected a file ending in .ply or .obj, or these with "
      ".gz\n"
      "scene.json:10: error: 2 normals for 1 positions; expected one for each, or none\n");
}

TEST(NativeMistakes, Lights) {
  EXPECT_THAT(messages_of_entity("{\"light\": {\"type\": \"area\", \"radiance\": 1}}"),
              HasSubstr("an area light needs a 'geometry' on the same entity"));
  EXPECT_THAT(messages_of_entity("{\"light\": {\"type\": \"point\"}}"),
              HasSubstr("expected 'intensity', 'candela' or 'lumens'"));
  EXPECT_THAT(messages_of_entity("{\"light\": {\"type\": \"point\", \"candela\": 1, \"lumens\": 5}}"),
              HasSubstr("'candela' and 'lumens' exclude each other"));
  EXPECT_THAT(messages_of_entity("{\"light\": {\"type\": \"directional\", \"irradiance\": 1, \"spectrum\": \"A\"}}"),
              HasSubstr("'spectrum' is the shape for 'lux'"));
  EXPECT_THAT(messages_of_entity("{\"light\": {\"type\": \"directional\", \"lux\": -1}}"),
              HasSubstr("'lux' is the number -1"));
  EXPECT_THAT(messages_of_entity("{\"light\": {\"type\": \"point\", \"candela\": 1, \"spectrum\": 0}}"),
              HasSubstr("its luminance is 0"));
  EXPECT_THAT(
      messages_of_entity("{\"light\": {\"type\": \"point\", \"intensity\": {\"table\": [[400, 1], [500, -1]]}}}"),
      HasSubstr("'table[1][1]' is the number -1"));
  EXPECT_THAT(
      messages_of_entity("{\"light\": {\"type\": \"environment\", \"radiance\": 1, \"mapping\": \"equal_area\"}}"),
      HasSubstr("'mapping' goes with 'image' only"));
  EXPECT_THAT(messages_of_entity("{\"light\": {\"type\": \"environment\", \"image\": \"none.exr\"}}"),
              HasSubstr("scene.json:3: error: cannot read 'none.exr': No such file or directory"));
  EXPECT_THAT(messages_of_entity("{\"camera\": {\"type\": \"perspective\"}, \"geometry\": {\"type\": \"sphere\"}}"),
              HasSubstr("an entity with a camera cannot have 'geometry'; make it a child"));
}

// Calls f(value, key or empty) for every value below.
template <class F>
void each_value(const Json::Value& value, const F& f) {
  for (auto it = value.begin(); it != value.end(); ++it) {
    f(*it, it.name());
    if (it->isObject() || it->isArray()) each_value(*it, f);
  }
}

Json::Value parse(const std::string& text) {
  Json::Value root;
  std::string errors;
  const std::unique_ptr<Json::CharReader> reader(Json::CharReaderBuilder().newCharReader());
  EXPECT_TRUE(reader->parse(text.data(), text.data() + text.size(), &root, &errors)) << errors;
  return root;
}

TEST(NativeMistakes, EveryKeyIsReadAndAWrongTypeIsReportedOnItsLine) {
  std::set<std::string> seen;
  const auto break_each = [&](const std::string& text) {
    each_value(parse(text), [&](const Json::Value& value, const std::string& key) {
      if (key.empty()) return;
      seen.insert(key);
      const auto begin = static_cast<size_t>(value.getOffsetStart()), end = static_cast<size_t>(value.getOffsetLimit());
      const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<ptrdiff_t>(begin), '\n');
      const std::string wrong = text.substr(0, begin) + "[[null]]" + text.substr(end);
      EXPECT_THAT(messages_of(wrong), HasSubstr("scene.json:" + std::to_string(line) + ": error: ")) << key;
    });
  };
  break_each(text_of_file(native_folder + "every_key.json"));
  // A scene has one filter.
  for (const char* filter : {"\"mitchell\", \"radius\": 2,\n\"b\": 0.2,\n\"c\": 0.4", "\"sinc\",\n\"tau\": 2"})
    break_each(std::string("{\"metamer\": 1, \"entities\": [],\n\"settings\": {\n\"filter\": {\"type\": ") + filter +
               "}}}");
  for (const ObjectSpec& spec : all_object_specs())
    for (const KeySpec& key : spec.keys) EXPECT_TRUE(seen.contains(std::string(key.name))) << key.name;
}

TEST(NativeMistakes, SurvivesHugeArrays) {
  std::string numbers = "[0";
  for (int i = 0; i < 300000; ++i) numbers += ",0";
  numbers += "]";
  for (const char* key : {"matrix", "translate", "scale"})
    EXPECT_THAT(messages_of_transform("{\"" + std::string(key) + "\": " + numbers + "}"),
                HasSubstr("an array of 300001"));
  EXPECT_THAT(messages_of_material("{\"type\": \"diffuse\", \"reflectance\": {\"rgb\": " + numbers + "}}"),
              HasSubstr("an array of 300001"));
}

}  // namespace
}  // namespace metamer
