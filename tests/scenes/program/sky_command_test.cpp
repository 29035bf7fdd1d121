// metamer sky as its users see it.
#include <OpenImageIO/imageio.h>

#include <numbers>

#include "scenes/read_scene.h"
#include "scenes/sky/sky.h"
#include "tests/scenes/program/run_program.h"
#include "tests/systems/support/scene_builder.h"

namespace metamer {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

using SkyCommand = ProgramTest;

TEST_F(SkyCommand, PrintsWhatTheDayGives) {
  const ProgramResult result = run({"sky", "--turbidity", "2", "--sun-elevation", "90"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  // 15.5007 kcd/m^2 and the chromaticity by hand, see sky_test.cpp; 27.4 and 101 klx by the model.
  EXPECT_THAT(result.out, HasSubstr("zenith  15501 cd/m^2, x 0.2667 y 0.2772\n"));
  EXPECT_THAT(result.out, AllOf(HasSubstr("sky     27"), HasSubstr("sun     100"), HasSubstr("both    128")));
  EXPECT_THAT(run({"sky", "--no-sun"}).out, testing::Not(HasSubstr("sun")));
  EXPECT_THAT(names_in(folder()), ElementsAre("small.json"));
}

TEST_F(SkyCommand, WritesTheImageInCandelasPerSquareMetre) {
  EXPECT_EQ(run({"sky", "--sun-elevation", "30", "--resolution", "32", "-o", "sky.exr"}).exit_code, 0);
  const auto file = OIIO::ImageInput::open((folder() / "sky.exr").string());
  ASSERT_TRUE(file);
  std::vector<float> values(64 * 32 * 3);
  ASSERT_TRUE(file->read_image(0, 0, 0, 3, OIIO::TypeFloat, values.data()));
  SkySettings settings;
  settings.sun_elevation_deg = 30;
  settings.resolution = 32;
  const Image image = make_sky(settings).image;
  for (size_t i = 0; i < values.size(); ++i) ASSERT_EQ(values[i], image.rgb[i]) << i;
}

// The luminance of a white floor under a scene's lights.
double luminance_under(const std::string& path) {
  Scene scene;
  Diagnostics diagnostics;
  EXPECT_TRUE(read_scene(path, scene, diagnostics)) << format_diagnostics(diagnostics);
  SceneBuilder b(8, 8, 256, 1);
  b.scene = std::move(scene);
  b.scene.settings.width = b.scene.settings.height = 8;
  b.scene.settings.samples_per_pixel = 256;
  b.look_at({0, 1, 2}, {0, 0, 0}, orthographic(0.001f));
  b.add(rectangle(1, 1), b.diffuse(1.0), turned(-90, 1, 0, 0));
  const Film film = render_film(*b.freeze());
  double sum = 0;
  for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel) sum += mean_xyz(film, pixel)[1];
  return sum / double(film.pixel_count());
}

TEST_F(SkyCommand, WritesASceneThatIsTheLightOfTheSameName) {
  const ProgramResult result =
      run({"sky", "--turbidity", "4", "--sun-elevation", "20", "--sun-azimuth", "250", "-o", "evening.json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("EXR   evening.exr\nJSON  evening.json\n"));
  folder_.write("native.json", R"({"metamer": 1, "entities": [{"light": {"type": "sky", "turbidity": 4,
                                   "sun_elevation": 20, "sun_azimuth": 250}}]})");
  const double written = luminance_under((folder() / "evening.json").string());
  const double native = luminance_under((folder() / "native.json").string());
  EXPECT_NEAR(written / native, 1, 1e-3);
  EXPECT_NEAR(native * std::numbers::pi, 33574, 500);
}

TEST_F(SkyCommand, RefusesWhatTheModelDoesNotKnow) {
  const ProgramResult result = run({"sky", "--turbidity", "1", "--sun-elevation", "0", "--sun-azimuth", "x",
                                    "--ground-albedo", "2", "--resolution", "9", "--turbidty", "3"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("--turbidity: expected a number from 2 to 10, not '1'"),
                                HasSubstr("--sun-elevation: expected a number above 0, not '0'"),
                                HasSubstr("--sun-azimuth: expected a number from -360 to 360, not 'x'"),
                                HasSubstr("--ground-albedo: expected a number from 0 to 1, not '2'"),
                                HasSubstr("--resolution: expected an even number, not '9'"),
                                HasSubstr("did you mean '--turbidity'")));
  EXPECT_EQ(run({"sky", "-o", "sky.png"}).exit_code, 2);
  EXPECT_EQ(run({"sky", "-o", "nowhere/sky.exr"}).exit_code, 1);
  EXPECT_THAT(names_in(folder()), ElementsAre("small.json"));
}

}  // namespace
}  // namespace metamer
