// Lights of the native format: what their photometric numbers amount to in radiometric units, and in pictures.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/spectrum/rgb_fit.h"
#include "scenes/read_scene.h"
#include "scenes/sky/sky.h"
#include "tests/scenes/support/files.h"
#include "tests/systems/support/scene_builder.h"

namespace metamer {
namespace {

constexpr double pi = std::numbers::pi;

Scene read(const std::string& entities, const std::string& settings = "{}") {
  const TemporaryFolder folder;
  Scene scene;
  Diagnostics diagnostics;
  const std::string path =
      folder.write("scene.json", "{\"metamer\": 1, \"settings\": " + settings + ",\n\"entities\": [" + entities + "]}");
  EXPECT_TRUE(read_scene(path, scene, diagnostics)) << format_diagnostics(diagnostics);
  return scene;
}

std::unique_ptr<World> frozen(const Scene& scene) {
  Diagnostics diagnostics;
  std::unique_ptr<World> world = freeze(scene, diagnostics);
  EXPECT_NE(world, nullptr) << format_diagnostics(diagnostics);
  return world;
}

constexpr const char* camera = R"({"camera": {"type": "perspective"}, "transform": {"translate": [0, 0, 9]}})";

// The value at 555 nm of what the one light emits: radiance, intensity or irradiance.
double at_555(const std::string& light, const std::string& rest = "") {
  const auto world = frozen(read(std::string(camera) + ", {\"light\": " + light + rest + "}"));
  return world->spectra.value(world->lights[0].spectrum, 555) * double{world->lights[0].scale};
}

// A spectrum of 1 within 555 +- 1 nm (a hat of width 2: its luminance is that of 1 nm each side), where ybar is 1: 683
// times its integral of 1 nm. One lumen is 1/683 W of it.
constexpr const char* line = R"("spectrum": {"table": [[554, 0], [555, 1], [556, 0]]})";

TEST(NativeLights, PhotometricNumbersAreWattsOver683AtTheEyesPeak) {
  const std::string s = std::string(line) + "}";
  EXPECT_NEAR(at_555(R"({"type": "point", "candela": 683, )" + s), 1, 1e-5);
  EXPECT_NEAR(at_555(R"({"type": "point", "lumens": 683, )" + s), 1 / (4 * pi), 1e-6);
  EXPECT_NEAR(at_555(R"({"type": "directional", "lux": 683, )" + s), 1, 1e-5);
  EXPECT_NEAR(at_555(R"({"type": "environment", "luminance": 683, )" + s), 1, 1e-5);
  EXPECT_NEAR(at_555(R"({"type": "environment", "nits": 683, )" + s), 1, 1e-5);
  EXPECT_NEAR(at_555(R"({"type": "spot", "candela": 683, )" + s), 1, 1e-5);
  // 2 - cos 22.5 - cos 30 = 2 - 0.9238795 - 0.8660254 = 0.2100951.
  EXPECT_NEAR(at_555(R"({"type": "spot", "lumens": 683, )" + s), 1 / (pi * 0.2100951), 1e-5);
  // 2 - 1 - 0.5.
  EXPECT_NEAR(at_555(R"({"type": "spot", "cone_angle": 60, "falloff_start": 0, "lumens": 683, )" + s), 1 / (pi * 0.5),
              1e-5);
  const std::string disk = R"(, "geometry": {"type": "disk", "radius": 2})";
  EXPECT_NEAR(at_555(R"({"type": "area", "luminance": 683, )" + s, disk), 1, 1e-5);
  EXPECT_NEAR(at_555(R"({"type": "area", "nits": 683, "cosine_power": 3, )" + s, disk), 1, 1e-5);
  EXPECT_NEAR(at_555(R"({"type": "area", "lumens": 683, )" + s, disk), 1 / (pi * 4 * pi), 1e-6);
  EXPECT_NEAR(at_555(R"({"type": "area", "lumens": 683, "two_sided": true, )" + s, disk), 1 / (pi * 4 * pi * 2), 1e-6);
  EXPECT_NEAR(at_555(R"({"type": "area", "lumens": 683, "cosine_power": 2, )" + s, disk), 1 / (pi * 4 * pi / 2), 1e-6);
  // From a disc of 90 degrees the irradiance is pi sin^2 45 of the radiance, which is what the row holds.
  EXPECT_NEAR(at_555(R"({"type": "directional", "angular_diameter": 90, "lux": 683, )" + s), 2 / pi, 1e-5);
}

// 683 times the integral of ybar over the equal-energy spectrum is 683 * 106.856917 = 72983.27.
TEST(NativeLights, FlatSpectraFollowTheIntegralOfTheObserver) {
  const std::string flat = R"("spectrum": 1})";
  EXPECT_NEAR(at_555(R"({"type": "point", "candela": 72983.27, )" + flat), 1, 1e-5);
  EXPECT_NEAR(at_555(R"({"type": "directional", "lux": 72983.27, )" + flat), 1, 1e-5);
  EXPECT_NEAR(at_555(R"({"type": "point", "intensity": 2, "scale": 3})"), 6, 1e-6);
}

// A floor of albedo 0.5 under each light: E = I / d^2, E lux and pi L; the picture's luminance is 0.5 E / pi.
TEST(NativeLights, ThePictureHasTheirIlluminance) {
  const std::string scene =
      R"({"camera": {"type": "orthographic", "screen_height": 0.001},
          "transform": {"look_at": {"from": [0, 1, 2], "to": [0, 0, 0]}}},
         {"geometry": {"type": "rectangle"}, "transform": {"rotate": {"axis": [1, 0, 0], "degrees": -90}}}, )";
  const std::string settings = R"({"size": [8, 8], "samples": 64})";
  const auto luminance = [&](const std::string& light) {
    const Film film = render_film(*frozen(read(scene + light, settings)));
    double sum = 0;
    for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel) sum += mean_xyz(film, pixel)[1];
    return sum / double(film.pixel_count());
  };
  const std::string down = R"("transform": {"look_at": {"from": [0, 2, 0], "to": [0, 0, 0], "up": [0, 0, 1]}}})";
  EXPECT_NEAR(luminance(R"({"light": {"type": "point", "candela": 400}, )" + down) * pi / 0.5, 100, 1);
  EXPECT_NEAR(luminance(R"({"light": {"type": "spot", "candela": 400}, )" + down) * pi / 0.5, 100, 1);
  EXPECT_NEAR(luminance(R"({"light": {"type": "spot", "lumens": 264.0133}, )" + down) * pi / 0.5, 100, 1);
  EXPECT_NEAR(luminance(R"({"light": {"type": "directional", "lux": 100}, )" + down) * pi / 0.5, 100, 1);
  EXPECT_NEAR(luminance(R"({"light": {"type": "directional", "lux": 100, "angular_diameter": 3}, )" + down) * pi / 0.5,
              100, 1);
  EXPECT_NEAR(luminance(R"({"light": {"type": "environment", "nits": 50}})") / 0.5, 50, 1);
}

// Two rows of four: the upper row 2, the lower 0.
std::string half_white() {
  std::string text = "PF\n4 2\n-1.0\n";
  for (int i = 0; i < 8; ++i) {
    const float value = i < 4 ? 0.0f : 2.0f;  // rows from the bottom up
    for (int c = 0; c < 3; ++c) text.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  return text;
}

TEST(NativeLights, WithImagesAreKindsOfTheirOwn) {
  const TemporaryFolder folder;
  folder.write("half.pfm", half_white());
  const auto read_light = [&](const std::string& light) {
    Scene scene;
    Diagnostics diagnostics;
    const std::string path =
        folder.write("scene.json", std::string("{\"metamer\": 1, \"entities\": [") + camera +
                                       ", {\"light\": {\"image\": \"half.pfm\", " + light + "}}]}");
    EXPECT_TRUE(read_scene(path, scene, diagnostics)) << format_diagnostics(diagnostics);
    return scene;
  };
  const auto only = [](const Scene& scene) { return scene.registry.table<Light>().get(0); };
  const auto candela = [&](const Scene& scene) {
    return scene.spectra.luminance(only(scene).spectrum) * double{only(scene).scale};
  };
  const Scene lamp = read_light(R"("type": "goniometric", "candela": 5, "scale": 2)");
  EXPECT_EQ(only(lamp).kind, LightKind::goniometric);
  EXPECT_NEAR(candela(lamp), 10, 1e-4);
  EXPECT_EQ(lamp.images[0].mapping, ImageMapping::latitude_longitude);
  // Above the horizon 2 cd per candela: 4 pi lm.
  EXPECT_NEAR(candela(read_light(R"("type": "goniometric", "lumens": 100)")), 100 / (4 * pi), 1e-3);
  EXPECT_NEAR(candela(read_light(R"("type": "goniometric")")), 1, 1e-5);
  const Scene slide = read_light(R"("type": "projection", "fov": 40, "candela": 3)");
  EXPECT_EQ(only(slide).kind, LightKind::projection);
  EXPECT_EQ(only(slide).fov_deg, 40);
  EXPECT_NEAR(candela(slide), 3, 1e-4);
  EXPECT_EQ(only(read_light(R"("type": "projection")")).fov_deg, 90);
  const Scene screen = read_light(R"("type": "area", "nits": 3}, "geometry": {"type": "sphere")");
  EXPECT_EQ(only(screen).image, 0u);
  EXPECT_NEAR(candela(screen), 3, 1e-4);
  const Scene sky =
      read_light(R"("type": "environment", "portal": [[1, 0, 0], [1, 2, 0], [1, 2, 3], [1, 0, 3]], "luminance": 7)");
  EXPECT_EQ(only(sky).has_portal, 1u);
  EXPECT_EQ(only(sky).portal_corner, glm::vec3(1, 0, 0));
  EXPECT_EQ(only(sky).portal_x, glm::vec3(0, 0, 3));
  EXPECT_EQ(only(sky).portal_y, glm::vec3(0, 2, 0));
}

TEST(NativeLights, ThereMayBeSeveralEnvironments) {
  const auto world = frozen(read(std::string(camera) + R"(, {"light": {"type": "environment", "luminance": 3}},
        {"light": {"type": "sky", "resolution": 16}}, {"light": {"type": "environment", "luminance": 4}})"));
  EXPECT_EQ(world->environments.size(), 3u);
}

TEST(NativeSky, BecomesAnEnvironmentAndASun) {
  for (const bool z_up : {false, true}) {
    const Scene scene = read(std::string(camera) + R"(, {"transform": {"rotate": {"axis": [0, 0, 1], "degrees": 0}},
      "light": {"type": "sky", "turbidity": 4, "sun_elevation": 30, "sun_azimuth": 90, "resolution": 32,
                "scale": 2, "up": ")" +
                             (z_up ? "z" : "y") + "\"}}");
    const auto world = frozen(scene);
    ASSERT_EQ(world->lights.size(), 2u);
    ASSERT_EQ(world->distant_disks.size(), 1u);
    const LightRow& sun = world->lights[world->distant_disks[0]];
    // Azimuth 90: east, +x; elevation 30.
    EXPECT_NEAR(sun.p[0], std::cos(pi / 6), 1e-6);
    EXPECT_NEAR(sun.p[z_up ? 2 : 1], 0.5, 1e-6);
    EXPECT_NEAR(sun.p[z_up ? 1 : 2], 0, 1e-6);
    EXPECT_NEAR(double{sun.scale} * world->spectra.value(sun.spectrum, 550) / (2 * sun_radiance(4, 30)[190]), 1, 1e-5);
    ASSERT_EQ(world->environments.size(), 1u);
    const Environment& environment = world->environments[0];
    EXPECT_EQ(world->light_images.rows[environment.image].height, 32u);
    // The image's +z is the zenith.
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(environment.to_world[3 * i + 2], i == (z_up ? 2 : 1) ? 1 : 0, 1e-6);
  }
  const Scene without = read(R"({"light": {"type": "sky", "sun": false, "resolution": 16}})");
  EXPECT_EQ(without.registry.table<Light>().size(), 1u);
}

// A white floor shows the illuminance of the model over pi: the environment's sampling, the fit of spectra to its
// texels, the interpolation between them and the sun's disc together.
TEST(NativeSky, LightsAFloorWithTheModelsIlluminance) {
  SkySettings settings;
  settings.turbidity = 3;
  settings.sun_elevation_deg = 35;
  settings.sun_azimuth_deg = 200;
  const SkyImage model = make_sky(settings);
  for (const bool has_sun : {true, false}) {
    const Scene scene = read(
        R"({"camera": {"type": "orthographic", "screen_height": 0.001},
            "transform": {"look_at": {"from": [0, 1, 2], "to": [0, 0, 0]}}},
           {"geometry": {"type": "rectangle"}, "material": {"type": "diffuse", "reflectance": 1},
            "transform": {"rotate": {"axis": [1, 0, 0], "degrees": -90}}},
           {"light": {"type": "sky", "sun_elevation": 35, "sun_azimuth": 200, "sun": )" +
            std::string(has_sun ? "true" : "false") + "}}",
        R"({"size": [8, 8], "samples": 256})");
    const Film film = render_film(*frozen(scene));
    Color3 sum{};
    for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel)
      for (size_t c = 0; c < 3; ++c) sum[c] += mean_xyz(film, pixel)[c] / double(film.pixel_count());
    for (size_t c = 0; c < 3; ++c) {
      const double wanted = (model.sky_illuminance[c] + (has_sun ? model.sun_illuminance[c] : 0)) / pi;
      EXPECT_NEAR(sum[c] / wanted, 1, 0.01) << c;
    }
  }
}

// Preetham's sky has the spectra of CIE daylight of its chromaticities; the image's are those of its colours under D65.
TEST(NativeSky, ItsSpectraAreCloseToCieDaylight) {
  const SkyModel model(3, 40);
  Scene scene = read(std::string(camera) + R"(, {"light": {"type": "sky", "sun_elevation": 40, "sun": false}})");
  const auto world = frozen(scene);
  const LightImage& sky = world->light_images.rows[0];
  const DataTable& components = require_embedded_data("illuminant/D_series");
  const Samples s0 = resample(components, 1, Extend::zero), s1 = resample(components, 2, Extend::zero),
                s2 = resample(components, 3, Extend::zero);
  const glm::dvec3 sun = sun_direction({3, 40, 180, false, 0, 256});
  for (const auto& [row, column] : {std::pair{5u, 100u}, {60u, 380u}, {60u, 130u}, {100u, 10u}, {120u, 250u}}) {
    const double theta = pi * (row + 0.5) / sky.height, phi = 2 * pi * (column + 0.5) / sky.width;
    const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    const Color3 yxy = model.at(d.z, std::acos(glm::dot(d, sun)));
    const double x = yxy[1], y = yxy[2], m = 0.0241 + 0.2562 * x - 0.7341 * y;
    const double m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m, m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
    Samples wanted;
    for (size_t i = 0; i < lambda_count; ++i) wanted[i] = s0[i] + m1 * s1[i] + m2 * s2[i];
    const double to_luminance = yxy[0] / (luminous_efficacy * integrate_xyz(wanted)[1]);
    const float* texel = world->light_images.texels.data() + 4 * (size_t{row} * sky.width + column);
    const LightRow& light = world->lights[world->environments[0].light];
    double worst = 0, largest = 0;
    for (double lambda = 400; lambda <= 700; lambda += 1) {
      const double value = double{light.scale} * world->spectra.value(light.spectrum, lambda) * double{texel[3]} *
                           sigmoid_polynomial({texel[0], texel[1], texel[2]}, lambda);
      const double daylight = wanted[static_cast<size_t>(lambda) - lambda_min_nm] * to_luminance;
      worst = std::max(worst, std::abs(value - daylight));
      largest = std::max(largest, daylight);
    }
    EXPECT_LT(worst / largest, 0.05) << row << ", " << column;
  }
}

}  // namespace
}  // namespace metamer
