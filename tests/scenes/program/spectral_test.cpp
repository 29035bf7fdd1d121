// metamer render --spectral and what develop makes of it, as users see it.
#include <OpenImageIO/imageio.h>

#include "tests/scenes/program/run_program.h"

namespace metamer {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class Spectral : public ProgramTest {
 protected:
  // Not by way of an ImageBuf, whose cache shows an older file of the same name and second.
  std::unique_ptr<OIIO::ImageInput> opened(const std::string& name) const {
    auto file = OIIO::ImageInput::open((folder() / name).string());
    EXPECT_TRUE(file) << name;
    return file;
  }
  std::vector<std::string> channels(const std::string& name) const {
    const auto file = opened(name);
    return file ? file->spec().channelnames : std::vector<std::string>();
  }
  // Linear R, G, B of all pixels.
  std::vector<float> light(const std::string& name) const {
    const auto file = opened(name);
    std::vector<float> values(16 * 12 * 3);
    EXPECT_TRUE(file && file->read_image(0, 0, 0, 3, OIIO::TypeFloat, values.data()));
    return values;
  }
};

TEST_F(Spectral, RecordsAsManyBandsAsAskedBesideTheSamePicture) {
  ASSERT_EQ(run({"render", "small.json", "-q", "-o", "plain.exr"}).exit_code, 0);
  EXPECT_EQ(channels("plain.exr").size(), 3u);
  const std::vector<std::pair<Arguments, size_t>> cases = {
      {{"--spectral", "small.json"}, 36},     {{"small.json", "--spectral", "7"}, 7},
      {{"small.json", "--spectral=9"}, 9},    {{"small.json", "--spectral", "-q"}, 36},
      {{"small.json", "--spectral", "0"}, 0}, {{"small.json", "--spectral"}, 36}};
  for (const auto& [flags, bands] : cases) {
    Arguments arguments = {"render", "-o", "s.exr"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const ProgramResult result = run(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(channels("s.exr").size(), 3 + bands) << flags.back();
    EXPECT_EQ(light("s.exr"), light("plain.exr"));
    EXPECT_EQ(bytes("s.png"), bytes("plain.png"));
  }
}

TEST_F(Spectral, ThreadsAndTilesChangeNoByte) {
  std::set<std::string> files;
  for (const char* threads : {"1", "3"})
    for (const char* tile : {"4", "32"}) {
      ASSERT_EQ(run({"render", "small.json", "-q", "--spectral", "--threads", threads, "--tile", tile, "-o", "s.exr"})
                    .exit_code,
                0);
      files.insert(bytes("s.exr"));
    }
  EXPECT_EQ(files.size(), 1u);
}

TEST_F(Spectral, ASceneMayAskForItAndAFlagDecides) {
  std::string scene(small_scene);
  scene.replace(scene.find("\"samples\""), 0, "\"spectral\": true, ");
  folder_.write("bands.json", scene);
  ASSERT_EQ(run({"render", "bands.json", "-q"}).exit_code, 0);
  EXPECT_EQ(channels("bands.exr").size(), 39u);
  ASSERT_EQ(run({"render", "bands.json", "-q", "--spectral", "0"}).exit_code, 0);
  EXPECT_EQ(channels("bands.exr").size(), 3u);
  EXPECT_THAT(run({"info", "bands.json"}).out, HasSubstr("36 bands from 380 to 740 nm"));
}

TEST_F(Spectral, OtherObserversSeeOtherColours) {
  ASSERT_EQ(run({"render", "small.json", "-q", "--spectral"}).exit_code, 0);
  std::set<std::vector<float>> pictures;
  for (const char* observer : {"cie1931", "cie1964", "cie2015-2", "cie2015-10", "stiles-burch1955"}) {
    const ProgramResult result = run({"develop", "small.exr", "-q", "-o", "o.exr", "--observer", observer});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    pictures.insert(light("o.exr"));
  }
  EXPECT_EQ(pictures.size(), 5u);
  // cie1931 takes the exact sums.
  ASSERT_EQ(run({"develop", "small.exr", "-q", "-o", "o.exr", "--observer", "CIE1931"}).exit_code, 0);
  EXPECT_EQ(light("o.exr"), light("small.exr"));
}

TEST_F(Spectral, AFileWithBandsButWithoutAFilmIsDevelopedFromThem) {
  ASSERT_EQ(run({"render", "small.json", "-q", "--spectral", "--preview-only", "--spp", "64"}).exit_code, 0);
  ASSERT_EQ(run({"develop", "small.exr", "-q", "-o", "o.exr"}).exit_code, 0);
  const std::vector<float> exact = light("small.exr"), banded = light("o.exr");
  double largest = 0, error = 0;
  for (size_t i = 0; i < exact.size(); ++i) {
    largest = std::max(largest, double{exact[i]});
    error += std::abs(double{banded[i]} - exact[i]) / static_cast<double>(exact.size());
  }
  EXPECT_NE(exact, banded);
  EXPECT_LT(error, 0.02 * largest);
}

TEST_F(Spectral, RenderAndDevelopMakeTheSamePngForAnObserver) {
  const Arguments look = {"--observer", "cie1964", "--white", "a"};
  Arguments render = {"render", "small.json", "-q", "--spectral"},
            develop = {"develop", "small.exr", "-q", "-o", "d.png"};
  render.insert(render.end(), look.begin(), look.end());
  develop.insert(develop.end(), look.begin(), look.end());
  ASSERT_EQ(run(render).exit_code, 0);
  ASSERT_EQ(run(develop).exit_code, 0);
  EXPECT_EQ(bytes("d.png"), bytes("small.png"));
  ASSERT_EQ(run({"render", "small.json", "-q", "-o", "plain.exr"}).exit_code, 0);
  EXPECT_EQ(light("small.exr"), light("plain.exr")) << "the EXR stays as cie1931 sees it";
  EXPECT_NE(bytes("plain.png"), bytes("small.png"));
}

TEST_F(Spectral, SaysWhatIsMissing) {
  ASSERT_EQ(run({"render", "small.json", "-q"}).exit_code, 0);
  struct Case {
    Arguments arguments;
    std::string words;
  };
  const std::vector<Case> cases = {
      {{"develop", "small.exr", "-o", "a.png", "--observer", "cie1964"}, "metamer render --spectral records bands"},
      {{"develop", "small.exr", "-o", "a.png", "--observer", "cie1946"},
       "(did you mean 'cie1964'?); there are cie1931"},
      {{"render", "small.json", "--observer", "cie1964"}, "render with --spectral"},
      {{"render", "small.json", "--observer", "me"}, "--observer: unknown name 'me'"},
      {{"render", "small.json", "--spectral", "361"}, "--spectral: expected a whole number from 0 to 360, not '361'"},
      {{"render", "small.json", "--spectral=x"}, "--spectral: expected a whole number from 0 to 360, not 'x'"},
      {{"render", "small.json", "--spectral", "--size", "1000000x1000000"}, "with 36 bands does not fit in memory"},
  };
  for (const Case& c : cases) {
    const ProgramResult result = run(c.arguments);
    EXPECT_EQ(result.exit_code, 2) << c.words;
    EXPECT_THAT(result.err, AllOf(StartsWith("metamer: error: "), HasSubstr(c.words)));
  }
}

}  // namespace
}  // namespace metamer
