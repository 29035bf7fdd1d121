// Light as three coefficients: products that are known in closed form, and where they part from wavelengths.
#include "engine/spectrum/color_mode.h"
#include "engine/spectrum/named_spectra.h"
#include "systems/bsdf/reference.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr ColorMode both[] = {ColorMode::rgb, ColorMode::lamps};

// A view of one point of a plane through the origin, whose normal is +y.
SceneBuilder point_view(ColorMode mode, uint32_t samples_per_pixel, uint32_t max_depth,
                        const glm::dvec3& from = {0.5, 1, 0}) {
  SceneBuilder b(4, 4, samples_per_pixel, max_depth);
  b.scene.settings.color = mode;
  b.look_at(from, {0, 0, 0}, orthographic(1e-4f), glm::dvec3(0.3, 0.2, 0.9));
  return b;
}
const glm::dmat4 floor_turn = turned(-90, 1, 0, 0);

// The mean of a pixel as the mode's coefficients.
Color3 coefficients_of(const Film& film, size_t pixel, ColorMode mode) {
  return multiply(coefficient_space(mode).from_xyz, mean_xyz(film, pixel));
}
Color3 product(const Color3& a, const Color3& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }
Color3 times(const Color3& a, double factor) { return {a[0] * factor, a[1] * factor, a[2] * factor}; }

// Every pixel, to a part of the largest coefficient.
void expect_picture(const World& world, const Color3& expected, double tolerance) {
  const Film film = render_film(world, {1, 32});
  EXPECT_EQ(film.invalid_samples(), 0u);
  const double size = std::max({std::abs(expected[0]), std::abs(expected[1]), std::abs(expected[2])});
  for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
    const Color3 got = coefficients_of(film, pixel, world.settings.color);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(got[c], expected[c], tolerance * size) << "channel " << c;
  }
}

// The mean over all pixels, within five of its standard errors and `visible` at most.
void expect_mean_picture(const World& world, const Color3& expected, double visible) {
  const Film film = render_film(world, {1, 32});
  const auto n = static_cast<double>(film.pixel_count());
  Color3 sum{}, squares{};
  for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
    const Color3 got = coefficients_of(film, pixel, world.settings.color);
    for (size_t c = 0; c < 3; ++c) sum[c] += got[c], squares[c] += got[c] * got[c];
  }
  for (size_t c = 0; c < 3; ++c) {
    const double mean = sum[c] / n, error = std::sqrt(std::max(squares[c] / n - mean * mean, 0.0) / (n - 1));
    EXPECT_NEAR(mean, expected[c], 5 * error + 1e-6 * expected[c]) << "channel " << c;
    EXPECT_LT(7 * error, visible * expected[c]) << "channel " << c << ": too few samples";
  }
}

TEST(RgbMode, ALitPlaneIsAProductOfCoefficients) {
  for (const ColorMode mode : both)
    for (const char* patch : {"colorchecker.red", "colorchecker.cyan", "colorchecker.orange"}) {
      SCOPED_TRACE(patch);
      SceneBuilder b = point_view(mode, 4, 1);
      b.add(rectangle(1, 1), b.diffuse(b.named(patch)), floor_turn);
      b.light(LightKind::point, b.named("A"), 0.01f, moved(0, 2, 0));
      const Color3 albedo = albedo_coefficients(mode, *named_spectrum(patch));
      const Color3 light = light_coefficients(mode, *named_spectrum("A"));
      expect_picture(*b.freeze(), times(product(albedo, light), 0.01 / pi / 4), 1e-5);
    }
}

TEST(RgbMode, TwoLightsAddUpByChannel) {
  for (const ColorMode mode : both) {
    SceneBuilder b = point_view(mode, 4096, 1);
    b.add(rectangle(1, 1), b.diffuse(b.named("colorchecker.green")), floor_turn);
    b.light(LightKind::directional, b.named("A"), 1, turned(-90, 1, 0, 0));
    b.light(LightKind::directional, b.named("FL11"), 1, turned(-30, 1, 0, 0));  // 60 degrees from the normal
    const Color3 albedo = albedo_coefficients(mode, *named_spectrum("colorchecker.green"));
    Color3 light = light_coefficients(mode, *named_spectrum("A"));
    const Color3 other = light_coefficients(mode, *named_spectrum("FL11"));
    for (size_t c = 0; c < 3; ++c) light[c] += other[c] / 2;
    expect_mean_picture(*b.freeze(), times(product(albedo, light), 1 / pi), 0.05);
  }
}

// In gamut or out of it, by the wavelengths' XYZ.
TEST(RgbMode, ALightSeenDirectlyHasItsOwnColour) {
  const std::vector<double> line_nm = {498, 500, 502}, line = {0, 1, 0};
  for (const ColorMode mode : both)
    for (const char* name : {"D65", "A", "FL11", "LED-RGB1", "HP1", "line"}) {
      SCOPED_TRACE(name);
      SceneBuilder b = point_view(mode, 4, 0);
      const SpectrumId id =
          std::string_view(name) == "line" ? b.scene.spectra.add_table(line_nm, line, Extend::zero).id : b.named(name);
      b.emit(b.add(rectangle(1, 1), b.diffuse(0.0), floor_turn), id, 0.25f);
      const Color3 xyz = b.scene.spectra.xyz(id);
      const Film film = render_film(*b.freeze(), {1, 32});
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(mean_xyz(film, 5)[c] / (0.25 * xyz[c]), 1, 1e-4);
    }
}

TEST(RgbMode, IndicesAreThoseAtThreeWavelengths) {
  for (const ColorMode mode : both) {
    SceneBuilder b = point_view(mode, 4, 1, {0, 1, 0});
    b.add(rectangle(1, 1), b.conductor(b.named("Cu.n"), b.named("Cu.k")), floor_turn);
    b.light(LightKind::environment, b.named("A"), 0.01f);
    const Color3 n = index_coefficients(mode, *named_spectrum("Cu.n"));
    const Color3 kappa = index_coefficients(mode, *named_spectrum("Cu.k"));
    const Color3 light = light_coefficients(mode, *named_spectrum("A"));
    Color3 expected;
    for (size_t c = 0; c < 3; ++c) expected[c] = 0.01 * light[c] * reference::fresnel_conductor(n[c], kappa[c], 1);
    expect_picture(*b.freeze(), expected, 1e-5);
  }
}

// The same spectrum as a light, a reflectance and an index.
TEST(RgbMode, ASpectrumOfSeveralRolesHasTheCoefficientsOfEach) {
  const std::vector<double> nm = {360, 830}, values = {0.2, 0.9};
  SceneBuilder b = point_view(ColorMode::rgb, 4, 2, {0, 1, 0});
  const SpectrumId ramp = b.scene.spectra.add_table(nm, values, Extend::constant).id;
  b.add(rectangle(1, 1), b.conductor(ramp, ramp), floor_turn);
  b.add(rectangle(9, 9), b.diffuse(ramp), moved(0, 3, 0) * turned(90, 1, 0, 0));
  b.light(LightKind::directional, ramp, 1, turned(50, 1, 0, 0));  // from below, past the mirror
  const Samples spectrum = b.scene.spectra.samples(ramp);
  const Color3 light = light_coefficients(ColorMode::rgb, spectrum);
  const Color3 albedo = albedo_coefficients(ColorMode::rgb, spectrum);
  const Color3 index = index_coefficients(ColorMode::rgb, spectrum);
  Color3 expected = times(product(albedo, light), std::sin(glm::radians(50.0)) / pi);
  for (size_t c = 0; c < 3; ++c) expected[c] *= reference::fresnel_conductor(index[c], index[c], 1);
  expect_picture(*b.freeze(), expected, 1e-5);
}

Image one_texel(const std::array<float, 3>& rgb, ColorSpace space) {
  Image image;
  image.width = image.height = 1;
  image.rgb = {rgb.begin(), rgb.end()};
  image.color_space = space;
  return image;
}

TEST(RgbMode, AnEnvironmentImageIsTakenAsItIs) {
  for (const ColorMode mode : both)
    for (const ColorSpace space : {ColorSpace::srgb, ColorSpace::rec2020}) {
      SceneBuilder b = point_view(mode, 4, 0);
      const Entity sky = b.environment(one_texel({0.9f, 0.1f, 0.02f}, space), 3);
      Light light = b.scene.registry.get<Light>(sky);
      light.spectrum = b.scene.spectra.add_white(ColorSpace::srgb);
      b.scene.registry.set(sky, light);
      const double white = b.scene.spectra.luminance(light.spectrum);
      const Color3 xyz = multiply(rgb_to_xyz(space), Color3{0.9, 0.1, 0.02});
      const Film film = render_film(*b.freeze(), {1, 32});
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(mean_xyz(film, 5)[c] / (3 * white * xyz[c]), 1, 1e-5);
    }
}

TEST(RgbMode, ImagesOfLampsAndProjectionsAreFactors) {
  for (const ColorMode mode : both)
    for (const LightKind kind : {LightKind::goniometric, LightKind::projection}) {
      SceneBuilder b = point_view(mode, 4, 1);
      b.add(rectangle(1, 1), b.diffuse(b.named("colorchecker.cyan")), floor_turn);
      b.scene.images.push_back(one_texel({0.9f, 0.1f, 0.02f}, ColorSpace::srgb));
      Light light;
      light.kind = kind;
      light.spectrum = b.named("A");
      light.scale = 0.01f;
      light.image = 0;
      b.scene.registry.set(b.place(moved(0, 2, 0) * turned(90, 1, 0, 0)), light);
      const Color3 albedo = albedo_coefficients(mode, *named_spectrum("colorchecker.cyan"));
      const Color3 lamp = light_coefficients(mode, *named_spectrum("A"));
      const Color3 image = multiply(image_to_coefficients(mode, ColorSpace::srgb), Color3{0.9, 0.1, 0.02});
      expect_picture(*b.freeze(), times(product(product(albedo, lamp), image), 0.01 / pi / 4), 1e-5);
    }
}

// A white body in light from everywhere has the light's own colour; every path of it in the light's proportions.
TEST(RgbMode, AWhiteBodyVanishesInAFurnaceOfAnyColour) {
  for (const ColorMode mode : both)
    for (const char* name : {"A", "FL11"}) {
      SceneBuilder b(16, 16, 256, 400);
      b.scene.settings.color = mode;
      b.light(LightKind::environment, b.named(name), 0.01f);
      b.look_at({0, 0, 3}, {0, 0, 0}, perspective(30));
      b.add(sphere(0.7f), b.diffuse(1.0), moved(0.6, 0, 0));
      b.add(sphere(0.7f), b.conductor(b.constant(1), b.constant(1e8)), moved(-0.6, 0, 0));
      const Color3 light = times(light_coefficients(mode, *named_spectrum(name)), 0.01);
      const Film film = render_film(*b.freeze(), {1, 32});
      double sum = 0;
      for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
        const Color3 got = coefficients_of(film, pixel, mode);
        for (size_t c = 1; c < 3; ++c) EXPECT_NEAR(got[c] / light[c], got[0] / light[0], 1e-5);
        sum += got[0] / light[0];
      }
      EXPECT_NEAR(sum / static_cast<double>(film.pixel_count()), 1, 0.003);
    }
}

// Dispersing glass in every channel: as a furnace, where the hero's loneliness must be made up for; and as one
// boundary, where the three transmittances differ.
TEST(RgbMode, DispersingGlassIsUnbiasedInEveryChannel) {
  for (const ColorMode mode : both) {
    SceneBuilder b(16, 16, 1024, 200);
    b.scene.settings.color = mode;
    b.light(LightKind::environment, b.named("A"), 0.01f);
    b.look_at({0, 0, 3}, {0, 0, 0}, perspective(30));
    b.add(sphere(1), b.dielectric(b.named("SF66")));
    const Color3 light = times(light_coefficients(mode, *named_spectrum("A")), 0.01);
    expect_mean_picture(*b.freeze(), light, 0.03);

    const std::vector<double> nm = {360, 830}, values = {1.9, 1.2};
    SceneBuilder under = point_view(mode, 4096, 4, {0, -1, 0});
    const SpectrumId eta = under.scene.spectra.add_table(nm, values, Extend::constant).id;
    under.add(rectangle(100, 100), under.dielectric(eta), floor_turn);
    under.add(rectangle(100, 100), under.diffuse(0.0), moved(0, -2, 0) * floor_turn);
    under.light(LightKind::environment, under.named("A"), 0.01f);
    const Color3 n = index_coefficients(mode, under.scene.spectra.samples(eta));
    Color3 expected;
    for (size_t c = 0; c < 3; ++c)
      expected[c] = light[c] * n[c] * n[c] * (1 - (n[c] - 1) * (n[c] - 1) / ((n[c] + 1) * (n[c] + 1)));
    expect_mean_picture(*under.freeze(), expected, 0.05);
  }
}

// The first two levels are free of noise: the sum over lights, and dispersed refraction with every channel followed.
TEST(RgbMode, LocalAndRecursiveMatchTheirClosedFormsOnEveryChannel) {
  for (const ColorMode mode : both)
    for (const Integrator integrator : {Integrator::local, Integrator::recursive}) {
      SceneBuilder b = point_view(mode, 4, 4);
      b.scene.settings.integrator = integrator;
      b.add(rectangle(1, 1), b.diffuse(b.named("colorchecker.orange")), floor_turn);
      b.light(LightKind::directional, b.named("FL11"), 0.01f, turned(-30, 1, 0, 0));  // 60 degrees from the normal
      b.light(LightKind::point, b.named("A"), 0.01f, moved(0, 2, 0));
      const Color3 albedo = albedo_coefficients(mode, *named_spectrum("colorchecker.orange"));
      Color3 light = light_coefficients(mode, *named_spectrum("A"));
      const Color3 other = light_coefficients(mode, *named_spectrum("FL11"));
      for (size_t c = 0; c < 3; ++c) light[c] = 0.01 * (light[c] / 4 + other[c] / 2);
      expect_picture(*b.freeze(), times(product(albedo, light), 1 / pi), 1e-4);
    }
  for (const ColorMode mode : both) {
    const std::vector<double> nm = {360, 830}, values = {1.9, 1.2};
    SceneBuilder b = point_view(mode, 4, 4, {0, -1, 0});
    b.scene.settings.integrator = Integrator::recursive;
    const SpectrumId eta = b.scene.spectra.add_table(nm, values, Extend::constant).id;
    b.add(rectangle(100, 100), b.dielectric(eta), floor_turn);
    b.add(rectangle(100, 100), b.diffuse(0.0), moved(0, -2, 0) * floor_turn);
    b.light(LightKind::environment, b.named("A"), 0.01f);
    const Color3 n = index_coefficients(mode, b.scene.spectra.samples(eta));
    const Color3 light = light_coefficients(mode, *named_spectrum("A"));
    Color3 expected;
    for (size_t c = 0; c < 3; ++c)
      expected[c] = 0.01 * light[c] * n[c] * n[c] * (1 - (n[c] - 1) * (n[c] - 1) / ((n[c] + 1) * (n[c] + 1)));
    expect_picture(*b.freeze(), expected, 1e-4);
  }
}

// kd + ks is 1 on all wavelengths but those of a band that red sees as negative: red would reflect more than it gets.
TEST(RgbMode, NormalisedAlbedosSumToOneAtMostInEveryChannel) {
  Samples half;
  for (size_t i = 0; i < lambda_count; ++i) half[i] = i > 120 && i < 160 ? 0.0 : 0.5;
  EXPECT_GT(2 * albedo_coefficients(ColorMode::rgb, half)[0], 1.01);
  SceneBuilder b = point_view(ColorMode::rgb, 1, 1);
  const SpectrumId id = b.scene.spectra.add_samples(half).id;
  b.add(rectangle(1, 1), b.rough(id, id, 20, true), floor_turn);
  const std::unique_ptr<World> world = b.freeze();
  const auto &kd = world->spectra.row(world->rough.kd[0]).coefficients,
             &ks = world->spectra.row(world->rough.ks[0]).coefficients;
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_LE(double{kd[c]} + double{ks[c]}, 1 + 1e-6);
    EXPECT_GT(ks[c], 0.3);
  }
}

// A closed sphere that emits inwards sums r + r^2 + ...: of greys the modes agree, of a saturated green they do not.
TEST(RgbMode, AgreesWithWavelengthsOnGreyAndPartsFromThemOnSaturatedInterreflections) {
  const auto mean = [](ColorMode mode, bool is_grey) {
    SceneBuilder b(16, 16, 256, 30);
    b.scene.settings.color = mode;
    Geometry shell = sphere(2);
    shell.flip_normal = 1;
    const SpectrumId wall = is_grey ? b.constant(0.7) : b.scene.spectra.add_rgb({0.05, 0.9, 0.05}, RgbKind::albedo).id;
    b.emit(b.add(shell, b.diffuse(wall), moved(0.3, 0, 0)), b.named("D65"), 1e-4f);
    b.look_at({0, 0, 0}, {0, 0, 1}, perspective(60));
    const Film film = render_film(*b.freeze(), {1, 32});
    Color3 sum{};
    for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel)
      for (size_t c = 0; c < 3; ++c)
        sum[c] += coefficients_of(film, pixel, ColorMode::rgb)[c] / static_cast<double>(film.pixel_count());
    return sum;
  };
  const Color3 grey = mean(ColorMode::spectral, true);
  const Color3 green = mean(ColorMode::spectral, false);
  for (const ColorMode mode : both) {
    const Color3 other_grey = mean(mode, true), other_green = mean(mode, false);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(other_grey[c] / grey[c], 1, 0.01);
    EXPECT_GT(std::abs(other_green[1] / green[1] - 1), 0.05);
  }
}

SceneBuilder everything(ColorMode mode) {
  SceneBuilder b(37, 29, 16, 8);
  b.scene.settings.color = mode;
  b.add(rectangle(6, 6), b.diffuse(b.named("colorchecker.green")), moved(0, -1, 0) * floor_turn);
  b.add(sphere(0.5f), b.dielectric(b.named("SF11")), moved(-0.9, -0.4, 0.3));
  b.add(sphere(0.4f), b.conductor(b.named("Au.n"), b.named("Au.k"), 0.2f, 0.4f), moved(0.9, -0.5, 0.2));
  b.add(sphere(0.3f), b.rough(b.named("colorchecker.red"), b.constant(0.2), 30, true), moved(0.1, -0.6, 0.6));
  for (const float alpha : {0.0f, 0.2f})
    b.add(sphere(0.2f), b.coated(b.named("colorchecker.blue"), b.named("BK7"), alpha), moved(2 * alpha, 0.4, -0.8));
  Material other = b.coated(b.named("colorchecker.blue"), b.constant(1.5));
  other.transmittance = b.constant(0.2);
  other.layer.albedo = b.constant(0.3);
  other.hair.sigma_a = b.constant(0.3);
  for (const MaterialKind kind : {MaterialKind::layered, MaterialKind::diffuse_transmission, MaterialKind::hair}) {
    other.kind = kind;
    b.add(sphere(0.15f), other, moved(0.5 * double(kind) - 3.5, 0.7, -0.6));
  }
  b.emit(b.add(sphere(0.2f), b.diffuse(0.3), moved(0, 1, 0.5)), b.named("A"), 0.1f);
  b.light(LightKind::point, b.named("E"), 0.05f, moved(0, 0.3, 2));
  b.environment(one_texel({0.2f, 0.5f, 0.9f}, ColorSpace::srgb), 0.1f);
  b.look_at({0, 0.3, 4}, {0, 0, 0}, perspective(45));
  return b;
}

TEST(RgbMode, ThreadsAndTilesDoNotChangeABit) {
  for (const ColorMode mode : both) {
    const std::unique_ptr<World> world = everything(mode).freeze();
    const Film film = render_film(*world, {1, 32});
    EXPECT_EQ(film.invalid_samples(), 0u);
    EXPECT_TRUE(film == render_film(*world, {2, 16}));
    EXPECT_TRUE(film == render_film(*world, {3, 4}));
    EXPECT_TRUE(film == render_film(*everything(mode).freeze(), {1, 64}));
    EXPECT_FALSE(film == render_film(*everything(ColorMode::spectral).freeze(), {1, 32}));
  }
}

// Whoever adds a column of spectra to the world gives it a role in build_coefficients.
TEST(RgbMode, NoSpectrumOfAWorldIsLeftWithoutCoefficients) {
  const std::unique_ptr<World> world = everything(ColorMode::rgb).freeze();
  const auto is_given = [&](SpectrumId id) { return std::isfinite(world->spectra.row(id).coefficients[0]); };
  for (const Column<uint32_t>* ids : {&world->diffuse.reflectance,
                                      &world->rough.kd,
                                      &world->rough.ks,
                                      &world->conductor.eta,
                                      &world->conductor.kappa,
                                      &world->dielectric.eta,
                                      &world->dielectric.kappa,
                                      &world->media.eta,
                                      &world->media.kappa,
                                      &world->diffuse_transmission.reflectance,
                                      &world->diffuse_transmission.transmittance,
                                      &world->layered.reflectance,
                                      &world->layered.albedo,
                                      &world->layered.base_eta,
                                      &world->layered.base_kappa,
                                      &world->hair.sigma_a,
                                      &world->smooth_coated.reflectance,
                                      &world->smooth_coated.eta,
                                      &world->rough_coated.reflectance,
                                      &world->rough_coated.eta}) {
    EXPECT_FALSE(ids->empty());
    for (const SpectrumId id : *ids) EXPECT_TRUE(is_given(id));
  }
  for (const LightRow& row : world->lights) EXPECT_TRUE(is_given(row.spectrum));
}

}  // namespace
}  // namespace metamer
