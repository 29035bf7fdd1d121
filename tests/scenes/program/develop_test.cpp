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
                                                      {"--display", "rec2020", "--tonemap", "FILMIC"},
                                                      {"--display", "lamps"},
                                                      {"--tonemap", "aces"},
                                                      {"--exposure", "auto"},
                                                      {"--tonemap", "reinhard-extended", "--tonemap-white", "2"}}) {
    Arguments render = {"render", "small.json", "-q", "-o", "other.exr", "--exposure", "0.75"};
    render.insert(render.end(), look.begin(), look.end());
    ASSERT_EQ(run(render).exit_code, 0);
    EXPECT_EQ(bytes("other.png"), png(look)) << look[1];
    EXPECT_NE(bytes("other.png"), bytes("small.png")) << look[1];
    if (look[0] != "--exposure")  // which the EXR remembers for its PNG
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

TEST_F(DevelopCommand, NeedsNoFilmOnlyThePicture) {
  ASSERT_EQ(run({"render", "small.json", "-q", "--preview-only", "-o", "preview.exr", "--exposure", "0.75"}).exit_code,
            0);
  EXPECT_EQ(run({"develop", "preview.exr", "-q", "-o", "again.png"}).exit_code, 0);
  EXPECT_EQ(bytes("again.png"), bytes("small.png"));
}

// The amounts of the lamps are those whose X Y Z the recorded colour has.
TEST_F(DevelopCommand, LampsReportNegativeAmountsAndKeepThemInAnExr) {
  const ProgramResult result = run({"develop", "small.exr", "-o", "lamps.exr", "--display", "lamps"});
  EXPECT_THAT(result.err, testing::AnyOf(HasSubstr("need a negative amount of a lamp: red down to"),
                                         HasSubstr("no pixel needs a negative amount")));
  const std::vector<float> srgb = light({}), lamps = light({"--display", "lamps"});
  for (size_t i = 0; i < srgb.size(); i += 3) {
    const double Y = 0.2126390 * srgb[i] + 0.7151687 * srgb[i + 1] + 0.0721923 * srgb[i + 2];
    // ybar at 645.16, 526.32 and 444.44 nm, CIE 1931.
    const double of_lamps = 0.137128 * lamps[i] + 0.812714 * lamps[i + 1] + 0.0289887 * lamps[i + 2];
    EXPECT_NEAR(of_lamps, Y, 1e-3 * Y) << i;
  }
}

// Light of 500 nm, 1 W m^-2 sr^-1, in bands of 5 nm: the observer's own amounts, -0.295, 0.4906 and 0.10749 (Stiles &
// Burch 1955), times 683. A band is wider than the line, hence 2 %.
TEST_F(DevelopCommand, PassesTheAmountsOfStilesAndBurchToTheLampsUnchanged) {
  folder_.write("green.json", R"({"metamer": 1,
  "settings": {"size": [16, 12], "samples": 64, "max_depth": 1, "filter": {"type": "box"}},
  "entities": [{"camera": {"type": "perspective", "fov": 40}},
    {"light": {"type": "environment", "radiance": {"table": [[495, 0], [500, 0.2], [505, 0]]}}}]})");
  ASSERT_EQ(run({"render", "green.json", "-q", "-o", "small.exr", "--spectral", "72", "--spp", "256"}).exit_code, 0);
  const std::vector<float> amounts = light({"--observer", "stiles-burch1955", "--display", "lamps"});
  double mean[3] = {};
  for (size_t i = 0; i < amounts.size(); ++i) mean[i % 3] += amounts[i] * 3.0 / static_cast<double>(amounts.size());
  EXPECT_NEAR(mean[0] / 683, -0.295, 0.006);
  EXPECT_NEAR(mean[1] / 683, 0.4906, 0.01);
  EXPECT_NEAR(mean[2] / 683, 0.10749, 0.004);
}

constexpr std::string_view view_config = R"(ocio_profile_version: 2
roles:
  default: raw
  scene_linear: lin
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  desk:
    - !<View> {name: film, colorspace: root}
    - !<View> {name: linear, colorspace: lin}
active_displays: [desk]
active_views: []
colorspaces:
  - !<ColorSpace>
    name: raw
    isdata: true
  - !<ColorSpace>
    name: lin
  - !<ColorSpace>
    name: root
    from_scene_reference: !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}
)";

TEST_F(DevelopCommand, TakesAnOpenColorIOConfiguration) {
  folder_.write("view.ocio", view_config);
  const std::vector<float> plain = light({}), root = light({"--ocio", "view.ocio"}),
                           linear = light({"--ocio", "view.ocio", "--ocio-display", "desk", "--ocio-view", "linear"});
  for (size_t i = 0; i < plain.size(); ++i) {
    EXPECT_NEAR(linear[i], plain[i], 1e-6);
    EXPECT_NEAR(root[i], std::sqrt(std::max(plain[i], 0.0f)), 2e-3);
  }
  const std::string film = png({"--ocio", "view.ocio"}), other = png({"--ocio", "view.ocio", "--ocio-view", "linear"});
  EXPECT_NE(film, other);
  // Only the configuration knows what the codes mean.
  EXPECT_THAT(film, testing::Not(HasSubstr("iCCP")));
  EXPECT_THAT(film, testing::Not(HasSubstr("sRGB")));
  ASSERT_EQ(run({"render", "small.json", "-q", "-o", "o.exr", "--exposure", "0.75", "--ocio", "view.ocio"}).exit_code,
            0);
  EXPECT_EQ(bytes("o.png"), film);
}

TEST_F(DevelopCommand, RefusesWhatItCannotDoAndLeavesNothingBehind) {
  ASSERT_EQ(run({"develop", "small.exr", "-q", "-o", "developed.exr"}).exit_code, 0);
  folder_.write("cut.exr", bytes("small.exr").substr(0, bytes("small.exr").size() * 3 / 4));
  folder_.write("view.ocio", view_config);
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
      {{"developed.exr", "-o", "a.png"}, 2, "developed.exr: has been developed already"},
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
      {{"small.exr", "-o", "a.png", "--tonemap-white", "3"}, 2, "belongs to --tonemap reinhard-extended"},
      {{"small.exr", "-o", "a.png", "--tonemap", "reinhard-extended", "--tonemap-white", "0"}, 2, "--tonemap-white: "},
      {{"small.exr", "-o", "a.png", "--ocio", "none.ocio"}, 2, "none.ocio: "},
      {{"small.exr", "-o", "a.png", "--ocio", ""}, 2, "--ocio: "},
      {{"small.exr", "-o", "a.png", "--ocio-view", "film"}, 2, "no configuration was given by --ocio"},
      {{"small.exr", "-o", "a.png", "--ocio", "view.ocio", "--tonemap", "agx"}, 2, "the view decides that"},
      {{"small.exr", "-o", "a.png", "--ocio", "view.ocio", "--ocio-view", "fine"}, 2, "there are film, linear"},
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
