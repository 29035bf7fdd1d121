#include <fmt/format.h>

#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

ReadScene read_settings(const std::string& text) { return read_text(text + "\nWorldBegin\n"); }

RenderSettings settings(const std::string& text) {
  const ReadScene read = read_settings("Camera \"perspective\"\n" + text);
  EXPECT_TRUE(read.ok) << text << "\n" << format_diagnostics(read.diagnostics);
  return read.scene.settings;
}
Camera camera(const std::string& text) {
  const ReadScene read = read_settings("Camera " + text);
  EXPECT_TRUE(read.ok) << text << "\n" << format_diagnostics(read.diagnostics);
  return read.get<Camera>();
}

TEST(PbrtSettings, DefaultsArePbrts) {
  const RenderSettings s = settings("");
  EXPECT_EQ(s.width, 1280u);
  EXPECT_EQ(s.height, 720u);
  EXPECT_EQ(s.samples_per_pixel, 16u);
  EXPECT_EQ(s.max_depth, 5u);
  EXPECT_EQ(s.filter.kind, FilterKind::gaussian);
  EXPECT_EQ(s.filter.radius_x, 1.5f);
  EXPECT_EQ(s.filter.sigma, 0.5f);
  EXPECT_EQ(s.sensor_scale, 1.0f);
  const Camera c = camera("\"perspective\"");
  EXPECT_EQ(c.fov_deg, 90.0f);
  EXPECT_EQ(c.lens_radius, 0.0f);
  EXPECT_EQ(c.focal_distance, 1e6f);
  EXPECT_EQ(c.screen_window, glm::vec4(0));
}

TEST(PbrtSettings, CamerasHaveFovLensAndScreenWindow) {
  const Camera c = camera("\"perspective\" \"float fov\" 30 \"float lensradius\" [.25] \"float focaldistance\" 4");
  EXPECT_EQ(c.kind, CameraKind::perspective);
  EXPECT_EQ(c.fov_deg, 30.0f);
  EXPECT_EQ(c.lens_radius, 0.25f);
  EXPECT_EQ(c.focal_distance, 4.0f);
  EXPECT_EQ(camera("\"perspective\" \"float screenwindow\" [-1 2 -3 4]").screen_window, glm::vec4(-1, 2, -3, 4));
  EXPECT_EQ(camera("\"perspective\" \"float frameaspectratio\" 2").screen_window, glm::vec4(-2, 2, -1, 1));
  EXPECT_EQ(camera("\"perspective\" \"float frameaspectratio\" .5").screen_window, glm::vec4(-1, 1, -2, 2));
  const Camera o = camera("\"orthographic\" \"float screenwindow\" [-3 3 -2 2]");
  EXPECT_EQ(o.kind, CameraKind::orthographic);
  EXPECT_EQ(o.screen_height, 2.0f) << "so that a unit of the window is a metre";
  EXPECT_EQ(o.screen_window, glm::vec4(-3, 3, -2, 2));
}

TEST(PbrtSettings, SphericalCamerasHaveAMapping) {
  EXPECT_EQ(camera("\"spherical\"").kind, CameraKind::spherical);
  EXPECT_EQ(camera("\"spherical\"").mapping, ImageMapping::equal_area);
  EXPECT_EQ(camera("\"spherical\" \"string mapping\" \"equalarea\"").mapping, ImageMapping::equal_area);
  const Camera c = camera("\"spherical\" \"string mapping\" \"equirectangular\" \"float shutterclose\" 2");
  EXPECT_EQ(c.mapping, ImageMapping::latitude_longitude);
}

TEST(PbrtSettings, ExposureIsTheShuttersTimeTimesIsoOverAHundred) {
  const ReadScene read = read_settings(
      "Film \"rgb\" \"float iso\" 400\nCamera \"perspective\" \"float shutteropen\" 1 \"float shutterclose\" 1.5");
  EXPECT_FLOAT_EQ(read.scene.settings.sensor_scale, 2.0f);
}

TEST(PbrtSettings, FilmSamplerIntegratorAndSeed) {
  const RenderSettings s = settings(
      "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" [48]\n"
      "Sampler \"stratified\" \"integer xsamples\" 3 \"integer ysamples\" 5 \"bool jitter\" false\n"
      "Integrator \"volpath\" \"integer maxdepth\" 7 \"string lightsampler\" \"power\"\n"
      "Option \"seed\" 12");
  EXPECT_EQ(s.width, 64u);
  EXPECT_EQ(s.height, 48u);
  EXPECT_EQ(s.samples_per_pixel, 15u);
  EXPECT_EQ(s.max_depth, 7u);
  EXPECT_EQ(s.seed, 12u);
  EXPECT_EQ(settings("Sampler \"halton\" \"integer pixelsamples\" 9 \"integer seed\" 3").samples_per_pixel, 9u);
  EXPECT_EQ(settings("Sampler \"halton\" \"integer seed\" 3").seed, 3u);
}

TEST(PbrtSettings, AmbientOcclusionIsAnIntegratorOfOurs) {
  EXPECT_EQ(settings("").integrator, Integrator::path);
  const RenderSettings s =
      settings("Integrator \"ambientocclusion\" \"float maxdistance\" 2.5 \"bool cossample\" false");
  EXPECT_EQ(s.integrator, Integrator::ambient_occlusion);
  EXPECT_EQ(s.occlusion_distance, 2.5f);
  EXPECT_TRUE(std::isinf(settings("Integrator \"ao\"").occlusion_distance));
}

TEST(PbrtSettings, FiltersHaveTheirOwnDefaults) {
  EXPECT_EQ(settings("PixelFilter \"box\"").filter.radius_x, 0.5f);
  const Filter triangle = settings("PixelFilter \"triangle\" \"float yradius\" 3").filter;
  EXPECT_EQ(triangle.kind, FilterKind::triangle);
  EXPECT_EQ(triangle.radius_x, 2.0f);
  EXPECT_EQ(triangle.radius_y, 3.0f);
  const Filter gaussian = settings("PixelFilter \"gaussian\" \"float xradius\" 2 \"float sigma\" .7").filter;
  EXPECT_EQ(gaussian.radius_x, 2.0f);
  EXPECT_EQ(gaussian.radius_y, 1.5f);
  EXPECT_EQ(gaussian.sigma, 0.7f);
  const Filter mitchell = settings("PixelFilter \"mitchell\" \"float B\" 0.25").filter;
  EXPECT_EQ(mitchell.kind, FilterKind::mitchell);
  EXPECT_EQ(mitchell.radius_x, 2.0f);
  EXPECT_EQ(mitchell.b, 0.25f);
  EXPECT_EQ(mitchell.c, 1 / 3.0f);
  const Filter sinc = settings("PixelFilter \"sinc\" \"float tau\" 2").filter;
  EXPECT_EQ(sinc.kind, FilterKind::sinc);
  EXPECT_EQ(sinc.radius_y, 4.0f);
  EXPECT_EQ(sinc.tau, 2.0f);
}

TEST(PbrtSettings, TheFilmClampsAndBalances) {
  const RenderSettings usual = settings("ColorSpace \"rec2020\" Film \"rgb\" ColorSpace \"srgb\" Film \"rgb\"");
  EXPECT_EQ(usual.largest_component, std::numeric_limits<float>::infinity());
  EXPECT_EQ(usual.white_balance_kelvin, 0.0f);
  EXPECT_EQ(usual.primaries, ColorSpace::srgb) << "the last film counts";
  EXPECT_EQ(settings("Film \"rgb\" \"float maxcomponentvalue\" 7").largest_component, 7.0f);
  EXPECT_EQ(settings("ColorSpace \"rec2020\" Film \"rgb\"").primaries, ColorSpace::rec2020);
  EXPECT_FLOAT_EQ(settings("Film \"rgb\" \"float whitebalance\" 5000").white_balance_kelvin, 5000 * 1.4388f / 1.4380f);
  EXPECT_EQ(settings("Film \"rgb\" \"float whitebalance\" 3200").white_balance_kelvin, 2856.0f)
      << "pbrt: below daylight's 4000 K illuminant A";
  const ReadScene hot = read_settings("Camera \"perspective\"\nFilm \"rgb\"\n\"float whitebalance\" 30000");
  EXPECT_THAT(
      hot.messages,
      testing::ElementsAre("scene:3: error: Film \"rgb\": 'whitebalance' expects at most 24986 kelvin, not 30000"));
}

TEST(PbrtSettings, WhatIsUsedInsteadIsSaid) {
  const ReadScene read = read_settings(R"(Camera "realistic" "string lensfile" "wide.dat"
Film "gbuffer" "string coordinatesystem" "world" "integer xresolution" 12
PixelFilter "mitchell" "float B" 0.3
Sampler "zsobol" "string randomization" "none"
Integrator "bdpt" "integer maxdepth" 3
Accelerator "bvh" "string splitmethod" "sah"
Option "wave-Front" true


ColorSpace "rec2020"
Film "rgb" "float maxcomponentvalue" 10 "string sensor" "canon_eos_5d" "string filename" "x.exr" "float diagonal" 20)");
  EXPECT_TRUE(read.ok);
  EXPECT_THAT(
      read.messages,
      testing::ElementsAre(
          "scene:1: warning: Camera \"realistic\" is not supported; a perspective camera of 90 degrees is used: give "
          "it the lens's 'fov' instead",
          "scene:2: warning: Film \"gbuffer\" is not supported; its size and exposure are used, it records R G B",
          "scene:4: note: Sampler \"zsobol\": its sample count is used; the points are always Owen-scrambled Sobol "
          "points",
          "scene:5: note: Integrator \"bdpt\" is not supported; path tracing looks for the same light",
          "scene:6: note: Accelerator \"bvh\": Embree's is always used",
          "scene:7: note: Option \"wave-Front\" is not supported; there is one renderer",
          "scene:11: warning: Film \"rgb\": 'sensor' is not supported yet; cie1931 is used",
          "scene:11: note: Film's 'filename' is not used: outputs are named after the scene, or by -o"));
  EXPECT_EQ(read.scene.settings.max_depth, 3u);
}

TEST(PbrtSettings, OnlyTheWindowOfTheFilmIsRendered) {
  const auto window = [](const std::string& film) {
    const RenderSettings s = settings("Film \"rgb\" \"integer xresolution\" 90 \"integer yresolution\" 70 " + film);
    const TileRect r = rendered_pixels(s);
    return std::vector<uint32_t>{r.x0, r.x1, r.y0, r.y1};
  };
  using testing::ElementsAre;
  EXPECT_THAT(window(""), ElementsAre(0, 90, 0, 70));
  EXPECT_THAT(window("\"float cropwindow\" [0.1 0.7 0 1]"), ElementsAre(9, 63, 0, 70));
  EXPECT_THAT(window("\"float cropwindow\" [0.101 0.701 0.5 0.51]"), ElementsAre(10, 64, 35, 36)) << "rounded up";
  EXPECT_THAT(window("\"integer pixelbounds\" [3 77 69 70]"), ElementsAre(3, 77, 69, 70));
  for (int x = 0; x < 90; ++x)
    EXPECT_THAT(window(fmt::format("\"integer pixelbounds\" [{} {} 0 70]", x, x + 1)), ElementsAre(x, x + 1, 0, 70));
}

TEST(PbrtSettings, OptionsAreFollowedOrNoted) {
  EXPECT_TRUE(settings("").pixel_jitter);
  EXPECT_FALSE(settings("Option \"disablepixeljitter\" true").pixel_jitter);
  EXPECT_TRUE(settings("Option \"disablepixeljitter\" false").pixel_jitter);
  EXPECT_THAT(read_settings("Camera \"perspective\"\nOption \"forcediffuse\" true").messages,
              testing::ElementsAre("scene:2: note: Option \"forcediffuse\" is not supported; materials stay what they "
                                   "are"));
  EXPECT_THAT(read_settings("Camera \"perspective\"\nOption \"forcediffuse\" false").messages, testing::IsEmpty());
}

// Which remarks --strict refuses: those that the picture depends on.
TEST(PbrtSettings, StrictAllowsWhatDoesNotChangeThePicture) {
  const auto strict_errors = [](const std::string& text) {
    ReadScene read = read_settings("Camera \"perspective\"\n" + text);
    EXPECT_FALSE(read.diagnostics.all().empty()) << text;
    EXPECT_FALSE(read.diagnostics.has_errors()) << text;
    read.diagnostics.apply_strict();
    return read.diagnostics.error_count();
  };
  for (const char* harmless : {"Sampler \"halton\"", "Accelerator \"kdtree\"", "Film \"rgb\" \"string filename\" \"a\"",
                               "Option \"rendercoordsys\" \"world\"", "Option \"pixelstats\" true",
                               "Option \"msereferenceimage\" \"a.exr\"", "Option \"wavefront\" true"})
    EXPECT_EQ(strict_errors(harmless), 0u) << harmless;
  for (const char* harmful : {"Integrator \"sppm\"", "Integrator \"function\"",
                              "Integrator \"path\" \"bool regularize\" true", "Film \"gbuffer\"", "Film \"spectral\"",
                              "Film \"rgb\" \"string sensor\" \"nikon_d850\"", "Option \"forcediffuse\" true"})
    EXPECT_EQ(strict_errors(harmful), 1u) << harmful;
}

TEST(PbrtSettings, ASpectralFilmRecordsAsManyBandsAsItHasBuckets) {
  const ReadScene read = read_settings(R"(Film "spectral" "integer nbuckets" 9 "float lambdamin" 400)");
  EXPECT_EQ(read.scene.settings.band_count, 9u);
  EXPECT_THAT(read.messages, testing::Contains("scene:1: note: Film \"spectral\": 9 bands from 380 to 740 nm are "
                                               "recorded, not 9 from 400 to 830 nm"));
  EXPECT_EQ(read_settings("Film \"spectral\"").scene.settings.band_count, 16u);
  EXPECT_EQ(read_settings("Film \"spectral\"\nFilm \"rgb\"").scene.settings.band_count, 0u);
}

TEST(PbrtSettings, WithoutACameraThereIsPbrtsDefaultOne) {
  const ReadScene read = read_text("\nWorldBegin");
  EXPECT_THAT(read.messages,
              testing::ElementsAre("scene:2: warning: there is no Camera; a perspective one of 90 degrees is used"));
  EXPECT_EQ(read.get<Camera>().fov_deg, 90.0f);
}

}  // namespace
}  // namespace metamer
