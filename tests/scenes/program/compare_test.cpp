// metamer compare as its users see it.
#include <fstream>

#include "engine/files/exr_picture.h"
#include "tests/scenes/program/run_program.h"

namespace metamer {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class CompareCommand : public ProgramTest {
 protected:
  // The numbers after "mean", "median" and so on.
  static double number(const std::string& out, const std::string& word) {
    const size_t at = out.find(word + " ");
    EXPECT_NE(at, std::string::npos) << word << " in " << out;
    return at == std::string::npos ? -1 : std::stod(out.substr(at + word.size() + 1));
  }
};

TEST_F(CompareCommand, APictureDoesNotDifferFromItself) {
  ASSERT_EQ(run({"render", "small.json", "-q"}).exit_code, 0);
  const ProgramResult result = run({"compare", "small.exr", "small.exr"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("CIEDE2000  mean 0.000, median 0.000, 95 % 0.000, max 0.000 at pixel 0,0\n"));
  EXPECT_THAT(result.out, Not(HasSubstr("map")));
}

TEST_F(CompareCommand, TwoFilesMakeNumbersAndAMap) {
  ASSERT_EQ(run({"render", "small.json", "-q", "--exposure", "0.75"}).exit_code, 0);
  ASSERT_EQ(run({"render", "small.json", "-q", "-o", "other.exr", "--seed", "5", "--preview-only"}).exit_code, 0);
  const ProgramResult result = run({"compare", "small.exr", "other.exr", "-o", "map.png"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GT(number(result.out, "mean"), 0);
  EXPECT_GE(number(result.out, "max"), number(result.out, "95 %"));
  EXPECT_GE(number(result.out, "95 %"), number(result.out, "median"));
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("exposure   +0.75 stops"), HasSubstr("map.png: black is 0, white 10 and more")));
  const std::string map = bytes("map.png");
  EXPECT_THAT(map, StartsWith("\x89PNG"));
  EXPECT_EQ(run({"compare", "small.exr", "other.exr", "-o", "map.png", "--map-scale", "2", "-q"}).exit_code, 0);
  EXPECT_NE(bytes("map.png"), map);
  EXPECT_NE(run({"compare", "small.exr", "other.exr", "--exposure", "-3"}).out, result.out);
  EXPECT_EQ(run({"compare", "small.exr", "other.exr", "--exposure", "auto"}).exit_code, 0);
}

TEST_F(CompareCommand, ASceneIsRenderedBothWays) {
  const ProgramResult result = run({"compare", "small.json", "--spp", "8", "--size", "20x10"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("CIEDE2000  mean"), HasSubstr("noise      median"), HasSubstr("small-spectral.png"),
                    HasSubstr("small-rgb.png"), HasSubstr("small-difference.png")));
  for (const char* name : {"small-spectral.png", "small-rgb.png", "small-difference.png"})
    EXPECT_THAT(bytes(name), StartsWith("\x89PNG")) << name;
  // The same as rendering twice and comparing the files.
  ASSERT_EQ(run({"render", "small.json", "-q", "--spp", "8", "--size", "20x10", "-o", "a.exr"}).exit_code, 0);
  ASSERT_EQ(
      run({"render", "small.json", "-q", "--spp", "8", "--size", "20x10", "-o", "b.exr", "--color", "rgb"}).exit_code,
      0);
  const ProgramResult files = run({"compare", "a.exr", "b.exr"});
  EXPECT_NEAR(number(files.out, "mean"), number(result.out, "mean"), 0.0021);
  EXPECT_EQ(bytes("a.png"), bytes("small-spectral.png"));
  EXPECT_EQ(bytes("b.png"), bytes("small-rgb.png"));
  EXPECT_EQ(run({"compare", "small.json", "-q", "--spp", "1", "--color", "lamps", "-o", "error.png"}).exit_code, 0);
  EXPECT_THAT(bytes("error-lamps.png"), StartsWith("\x89PNG"));
}

TEST_F(CompareCommand, RefusesWhatItCannotCompare) {
  ASSERT_EQ(run({"render", "small.json", "-q"}).exit_code, 0);
  ASSERT_EQ(run({"render", "small.json", "-q", "-o", "wide.exr", "--size", "21x12"}).exit_code, 0);
  std::ofstream(folder() / "broken.exr") << "not an EXR";
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{}, "two EXR files or one scene were expected, not nothing"},
      {{"a.exr", "b.exr", "c.exr"}, "not 3 names"},
      {{"small.exr"}, "small.exr: a second EXR file to compare with was expected"},
      {{"small.exr", "small.json"}, "small.json: an EXR file was expected"},
      {{"small.exr", "wide.exr"}, "pictures of one size were expected"},
      {{"small.exr", "none.exr"}, "none.exr: cannot be read"},
      {{"small.exr", "broken.exr"}, "broken.exr: cannot be read"},
      {{"small.exr", "small.exr", "--spp", "4"}, "--spp: says how to render, but files are compared"},
      {{"small.exr", "small.exr", "-o", "map.exr"}, "--output: map.exr"},
      {{"small.exr", "small.exr", "--map-scale", "0"}, "--map-scale: expected a number"},
      {{"small.json", "--color", "spectral"}, "--color: unknown name 'spectral'"},
      {{"small.exr", "small.exr", "--exposure", "bright"}, "or auto"},
  };
  for (const auto& [arguments, words] : cases) {
    Arguments all = {"compare"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramResult result = run(all);
    EXPECT_EQ(result.exit_code, 2) << words;
    EXPECT_THAT(result.err, AllOf(StartsWith("metamer: error: "), HasSubstr(words)));
  }
}

TEST_F(CompareCommand, TheSceneMaySayTheModeButBandsNeedWavelengths) {
  std::string scene = bytes("small.json");
  const std::string settings = "\"settings\": {";
  ASSERT_NE(scene.find(settings), std::string::npos);
  scene.insert(scene.find(settings) + settings.size(), "\"color\": \"lamps\", ");
  std::ofstream(folder() / "lamps.json") << scene;
  ASSERT_EQ(run({"render", "lamps.json", "-q", "-o", "a.exr"}).exit_code, 0);
  ASSERT_EQ(run({"render", "small.json", "-q", "-o", "b.exr", "--color", "lamps"}).exit_code, 0);
  EXPECT_EQ(bytes("a.png"), bytes("b.png"));
  EXPECT_THAT(run({"info", "lamps.json"}).out, HasSubstr("color       lamps"));
  for (const Arguments& arguments :
       std::vector<Arguments>{{"render", "lamps.json", "--spectral", "8"},
                              {"render", "small.json", "--spectral", "8", "--color", "rgb"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("for the 8 bands of a spectral film"));
  }
}

TEST_F(CompareCommand, ReadsThePictureWithItsExposureAndMode) {
  ASSERT_EQ(run({"render", "small.json", "-q", "--exposure", "-1.5", "--color", "lamps"}).exit_code, 0);
  ExrPicture read;
  ASSERT_EQ(read_exr_picture((folder() / "small.exr").string(), read), std::nullopt);
  EXPECT_EQ(read.picture.width, 16u);
  EXPECT_EQ(read.exposure_stops, -1.5f);
  EXPECT_EQ(read.color, "lamps");
  EXPECT_FLOAT_EQ(read.chromaticities.red[0], 0.64f);
}

}  // namespace
}  // namespace metamer
