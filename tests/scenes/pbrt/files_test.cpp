// Includes and imports, and files that are damaged or hostile.
#include <chrono>

#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

const std::string sample = R"(# a comment with "quotes" and [ brackets
LookAt 0 1 5  0 1 0  0 1 0
Camera "perspective" "float fov" [ 40 ]
Film "rgb" "integer xresolution" 32 "string filename" "a\"b.exr"
WorldBegin
MakeNamedMaterial "m" "string type" "conductor" "spectrum eta" "metal-Au-eta" "float roughness" .1
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 1 2 3 ] "bool twosided" true
  NamedMaterial "m" Translate 0 1 0
  Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 1 1 0 ] "integer indices" [ 0 1 2 ]
AttributeEnd
ObjectBegin "o" Shape "disk" ObjectEnd ObjectInstance "o"
LightSource "infinite" "blackbody L" 5000
)";

TEST(PbrtFiles, TheSampleIsRight) { EXPECT_TRUE(read_text(sample).ok); }

TEST(PbrtFiles, IncludeContinuesTheStateAndImportKeepsItApart) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "parts");
  folder.write("parts/move", "Translate 1 0 0\nInclude \"parts/shape\"");  // relative to the first file, as in pbrt
  folder.write("parts/shape", "\nShape \"sphere\"");
  const ReadScene read = read_scene_at(folder.write(
      "scene", "Camera \"perspective\" WorldBegin Include \"parts/move\" Import \"parts/move\" Shape \"sphere\""));
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  ASSERT_EQ(read.count<Geometry>(), 3u);
  const auto x = [&](uint32_t n) { return read.scene.registry.get<Transform>(read.entity<Geometry>(n)).row0.w; };
  EXPECT_EQ(x(0), 1.0f);
  EXPECT_EQ(x(1), 2.0f);
  EXPECT_EQ(x(2), 1.0f) << "the import's translation ended with it";
  const SourceLocation location = read.scene.location(read.entity<Geometry>());
  EXPECT_EQ(location.file, (folder.path() / "parts/shape").string());
  EXPECT_EQ(location.line, 2u);
}

TEST(PbrtFiles, MistakesInIncludedFilesHaveTheirOwnFileAndLine) {
  const TemporaryFolder folder;
  folder.write("part", "\n\nShape \"sphere\" \"float r\" 1\nAttributeBegin");
  const ReadScene read =
      read_scene_at(folder.write("scene", "Camera \"perspective\" WorldBegin\nImport \"part\"\nInclude \"none\""));
  ASSERT_EQ(read.messages.size(), 3u);
  EXPECT_THAT(read.messages[0], testing::StartsWith("part:3: error: Shape \"sphere\" has no parameter 'float r'"));
  EXPECT_EQ(read.messages[1], "part:4: error: this block is not closed at the end of the imported file");
  EXPECT_THAT(read.messages[2], testing::HasSubstr("No such file"));
  EXPECT_EQ(read.diagnostics.all()[2].line, 3u);
}

TEST(PbrtFiles, FilesThatIncludeThemselvesEachOtherOrTooDeepEnd) {
  const TemporaryFolder folder;
  folder.write("a", "Include \"b\"");
  folder.write("b", "\nInclude \"a\"");
  const ReadScene cycle = read_scene_at(folder.write("scene", "WorldBegin Include \"a\""));
  EXPECT_FALSE(cycle.ok);
  EXPECT_THAT(format_diagnostics(cycle.diagnostics),
              testing::HasSubstr("b:2: error: '" + (folder.path() / "a").string() + "' includes itself"));

  for (int i = 0; i < 100; ++i)
    folder.write("deep" + std::to_string(i), "Include \"deep" + std::to_string(i + 1) + "\"");
  const ReadScene deep = read_scene_at(folder.write("scene2", "WorldBegin Include \"deep0\""));
  EXPECT_THAT(format_diagnostics(deep.diagnostics), testing::HasSubstr("files are included more than 64 deep"));
}

TEST(PbrtFiles, AFanOfIncludesIsCut) {
  const TemporaryFolder folder;
  for (int i = 0; i < 40; ++i) {
    std::string twice;
    for (int k = 0; k < 2; ++k) twice.append("Include \"f").append(std::to_string(i + 1)).append("\" ");
    folder.write(std::string("f").append(std::to_string(i)), twice);
  }
  folder.write("f40", "");
  const ReadScene read = read_scene_at(folder.write("scene", "WorldBegin Include \"f0\""));
  EXPECT_THAT(format_diagnostics(read.diagnostics), testing::HasSubstr("more than 20000 files are included"));
}

TEST(PbrtFiles, AMissingFileAFolderAndOtherEncodingsAreErrors) {
  const TemporaryFolder folder;
  EXPECT_FALSE(read_scene_at((folder.path() / "none").string()).ok);
  EXPECT_FALSE(read_scene_at(folder.path().string()).ok);
  EXPECT_THAT(read_text("\xff\xfe W").messages[0], testing::StartsWith("scene:1: error: UTF-16 is not supported"));
  EXPECT_TRUE(read_text("\xef\xbb\xbf" + sample).ok) << "a UTF-8 byte order mark is harmless";
  EXPECT_TRUE(read_text("WorldBegin\r\nShape \"sphere\"\r\n").ok) << "so are carriage returns";
}

TEST(PbrtFiles, TruncationAtEveryByteAndEveryByteChangedEndsWithoutACrash) {
  const TemporaryFolder folder;
  for (size_t i = 0; i < sample.size(); ++i) {
    const ReadScene read = read_scene_at(folder.write("cut", sample.substr(0, i)));
    if (i < sample.find("WorldBegin")) {
      EXPECT_FALSE(read.ok) << i;
    }
    for (const char c : {'\0', '"', 'A'}) {
      std::string changed = sample;
      changed[i] = c;
      read_scene_at(folder.write("changed", changed));
    }
  }
}

TEST(PbrtFiles, GarbageStopsAfterAThousandMistakes) {
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 5000; ++i) text += "Q ]\n";
  const ReadScene read = read_text(text);
  EXPECT_EQ(read.diagnostics.error_count(), 1001u);
  EXPECT_EQ(read.diagnostics.all().back().message, "too many mistakes; the rest is not read");
}

TEST(PbrtFiles, DeepNestingIsHarmless) {
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 20000; ++i) text += "AttributeBegin\n";
  for (int i = 0; i < 20000; ++i) text += "AttributeEnd\n";
  EXPECT_TRUE(read_text(text).ok);
}

}  // namespace
}  // namespace metamer
