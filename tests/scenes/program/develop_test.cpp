// metamer develop as its users see it.
#include <OpenImageIO/imageio.h>

#include "tests/scenes/program/run_program.h"

namespace metamer {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class DevelopCommand : public ProgramTest {
 protected:
  DevelopCommand() { EXPECT_EQ(run({"render", "small.json", "-q", "--exposure", "0.75"}).exit_code, 0); }

  // Linear values of a developed EXR.
  std::vector<float> light(const Arguments& flags) const {
    Arguments arguments = {"develop", "small.exr", "-q", "-o", "light.exr"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    EXPECT_EQ(run(arguments).exit_code, 0);
    const auto file = OIIO::ImageInput::open((folder() / "light.exr").string());
    std::vector<float> values(16 * 12 * 3);
    EXPECT_TRUE(file && file->read_image(0, 0, 0, 3, OIIO::TypeFloat, values.data()));
    return values;
  }
  std::string png(const Arguments& flags) const {
    Arguments arguments = {"develop", "small.exr", "-q", "-o", "look.png"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    EXPECT_EQ(run(arguments).exit_code, 0);
    return bytes("look.png");
  }
};

TEST_F(DevelopCommand, WithoutFlagsMakesThePngOfTheRenderAgain) {
  const ProgramResult result = run({"develop", "small.exr", "-o", "again.png"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "PNG   again.png\n");
  EXPECT_EQ(bytes("again.png"), bytes("small.png"));
  EXPECT_NE(png({"--exposure", "0"}), bytes("small.png"));
}

TEST_F(DevelopCommand, AndRenderMakeTheSamePngOfTheSameLook) {
  for (const Arguments& look : std::vector<Arguments>{{"--tonemap", "agx", "--display", "p3"},
                                                      {"--white", "a", "--adaptation", "bradford"},
                                                      {"--white", "5000K", "--tonemap", "reinhard-extended"},
                                                      {"--display", "rec2020", "--tonemap", "FILMIC"}}) {
    Arguments render = {"render", "small.json", "-q", "-o", "other.exr", "--exposure", "0.75"};
    render.insert(render.end(), look.begin(), look.end());
    ASSERT_EQ(run(render).exit_code, 0);
    EXPECT_EQ(bytes("other.png"), png(look)) << look[1];
    EXPECT_NE(bytes("other.png"), bytes("small.png")) << look[1];
    EXPECT_EQ(bytes("other.exr"), bytes("small.exr")) << "the film is not changed by how it looks";
  }
}

TEST_F(DevelopCommand, AnExrIsExposedOnlyWhereAsked) {
  const std::vector<float> plain = light({}), brighter = light({"--exposure", "2"});
  float brightest = 0;
  for (size_t i = 0; i < plain.size(); ++i) {
    EXPECT_EQ(brighter[i], 4 * plain[i]);
    brightest = std::max(brightest, plain[i]);
  }
  EXPECT_GT(brightest, 0);
  EXPECT_NE(light({"--white", "a"}), plain);
  EXPECT_NE(light({"--display", "rec2020"}), plain);
  for (const float value : light({"--tonemap", "hable", "--exposure", "8"})) EXPECT_GE(value, 0);
}

TEST_F(DevelopCommand, AutomaticExposureDoesNotDependOnHowBrightTheLightIs) {
  const ProgramResult result = run({"develop", "small.exr", "-o", "a.png", "--exposure", "auto"});
  EXPECT_THAT(result.err, AllOf(StartsWith("metamer: exposure "), HasSubstr(" stops")));
  const std::vector<float> values = light({"--exposure", "auto"});
  double sum = 0;
  int lit = 0;
  for (size_t i = 0; i < values.size(); i += 3) {
    const double Y = 0.2126390 * values[i] + 0.7151687 * values[i + 1] + 0.0721923 * values[i + 2];
    if (Y > 0) sum += std::log(Y), ++lit;
  }
  EXPECT_NEAR(std::exp(sum / lit), 0.18, 1e-4);
}

TEST_F(DevelopCommand, PngsSayWhatTheirCodesMean) {
  const std::string srgb = png({}), p3 = png({"--display", "p3"}), rec2020 = png({"--display", "rec2020"});
  EXPECT_THAT(srgb, AllOf(HasSubstr("sRGB"), testing::Not(HasSubstr("iCCP"))));
  EXPECT_THAT(p3, AllOf(HasSubstr("iCCP"), testing::Not(HasSubstr("sRGB"))));
  EXPECT_THAT(rec2020, AllOf(HasSubstr("iCCP"), testing::Not(HasSubstr("sRGB"))));
}

TEST_F(DevelopCommand, ThreadsAndInstructionSetsChangeNoByte) {
  const Arguments look = {"develop", "small.exr", "-q", "-o", "a.png", "--tonemap", "agx", "--exposure", "auto"};
  std::set<std::string> pictures;
  for (const char* isa : {"sse4", "native"})
    for (const char* threads : {"1", "3"}) {
      Arguments arguments = look;
      arguments.insert(arguments.end(), {"--threads", threads});
      ASSERT_EQ(run(arguments, {{"METAMER_ISA", isa}}).exit_code, 0);
      pictures.insert(bytes("a.png"));
    }
  EXPECT_EQ(pictures.size(), 1u);
}

TEST_F(DevelopCommand, RefusesWhatItCannotDoAndLeavesNothingBehind) {
  ASSERT_EQ(run({"render", "small.json", "-q", "--preview-only", "-o", "preview.exr"}).exit_code, 0);
  folder_.write("cut.exr", bytes("small.exr").substr(0, bytes("small.exr").size() * 3 / 4));
  const std::set<std::string> before = names_in(folder());
  struct Case {
    Arguments arguments;
    int exit_code;
    std::string words;
  };
  const std::vector<Case> cases = {
      {{}, 2, "an EXR file was expected"},
      {{"small.exr"}, 2, "--output: the name of a .png or .exr file was expected"},
      {{"none.exr", "-o", "a.png"}, 2, "none.exr: cannot be opened: No such file"},
      {{".", "-o", "a.png"}, 2, "is a folder"},
      {{"small.png", "-o", "a.png"}, 2, "small.png: is not an OpenEXR file"},
      {{"preview.exr", "-o", "a.png"}, 2, "holds no film part"},
      {{"preview.exr", "-o", "a.png"}, 2, "--preview-only"},
      {{"cut.exr", "-o", "a.png"}, 2, "cut.exr: "},
      {{"small.exr", "-o", "small.exr"}, 2, "is the film itself"},
      {{"small.exr", "-o", "a.jpg"}, 2, "'.jpg' is an unknown kind of picture"},
      {{"small.exr", "-o", "none/a.png"}, 1, "none/a.png"},
      {{"small.exr", "b.exr", "-o", "a.png"}, 2, "one film at a time"},
      {{"small.exr", "-o", "a.png", "--display", "sgrb"}, 2, "(did you mean 'srgb'?); there are srgb, p3, rec2020"},
      {{"small.exr", "-o", "a.png", "--tonemap", "reinhart"}, 2, "did you mean 'reinhard'?"},
      {{"small.exr", "-o", "a.png", "--white", "d56"}, 2, "did you mean 'd65'?"},
      {{"small.exr", "-o", "a.png", "--white", "900"}, 2, "--white: expected a number from 1000 to 25000, not '900'"},
      {{"small.exr", "-o", "a.png", "--white", ""}, 2, "--white: unknown white ''"},
      {{"small.exr", "-o", "a.png", "--white", "a", "--adaptation", "cat61"}, 2, "did you mean 'cat16'?"},
      {{"small.exr", "-o", "a.png", "--adaptation", "cat16"}, 2, "no --white was given"},
      {{"small.exr", "-o", "a.png", "--exposure", "atuo"}, 2, "from -100 to 100 or auto, not 'atuo'"},
      {{"small.exr", "-o", "a.png", "--threads", "0"}, 2, "--threads: expected a whole number"},
      {{"small.exr", "-o", "a.png", "--tonmap", "agx"}, 2, "unknown flag '--tonmap' (did you mean '--tonemap'?)"},
  };
  for (const Case& c : cases) {
    Arguments arguments = {"develop"};
    arguments.insert(arguments.end(), c.arguments.begin(), c.arguments.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, c.exit_code) << c.words;
    EXPECT_THAT(result.err, AllOf(StartsWith("metamer: error: "), HasSubstr(c.words)));
    EXPECT_EQ(result.out, "");
  }
  EXPECT_EQ(names_in(folder()), before);
}

}  // namespace
}  // namespace metamer
