// Media that fill space: absorption, scattering, glow, and the interfaces between them, on each wavelength.
#include <numbers>

#include "tests/support/chi_square.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

constexpr double pi = std::numbers::pi;
constexpr Integrator all_levels[] = {Integrator::local, Integrator::recursive, Integrator::path};
constexpr uint32_t many_events = 400;

SpectrumId slope(SceneBuilder& b, double blue, double red) {
  const std::vector<double> lambda_nm = {360, 830}, values = {blue, red};
  return b.scene.spectra.add_table(lambda_nm, values, Extend::constant).id;
}
double slope_at(double nm, double blue, double red) { return blue + (red - blue) * (nm - 360) / 470; }

// A thin beam along -z from z = 5.
SceneBuilder beam(uint32_t samples_per_pixel, uint32_t max_depth, Integrator integrator = Integrator::path) {
  SceneBuilder b(16, 16, samples_per_pixel, max_depth);
  b.scene.settings.integrator = integrator;
  b.look_at({0, 0, 5}, {0, 0, 0}, orthographic(1e-3f), {0, 1, 0});
  return b;
}

TEST(Volumes, FollowBeerAndLambertAtEveryLevel) {
  for (const Integrator integrator : all_levels) {
    SceneBuilder b = beam(16, 0, integrator);
    b.light(LightKind::environment, unit_spectrum, 1);
    const Entity tea = b.medium(slope(b, 0.2, 2), zero_spectrum);
    b.separate(b.add(sphere(1), b.interface()), tea);
    // exp(-2 sigma) is known to 4e-7 (1 + 4); the chord to the beam's width.
    const auto expected = [](double nm) { return std::exp(-2 * slope_at(nm, 0.2, 2)); };
    expect_every_path(trace_radiances(*b.freeze()), expected, 1e-5);
  }
}

// What is scattered out of the way is lost to the levels that do not follow it.
TEST(Volumes, LoseWhatTheyScatterWhereItIsNotFollowed) {
  for (const Integrator integrator : {Integrator::local, Integrator::recursive}) {
    SceneBuilder b = beam(16, 8, integrator);
    b.light(LightKind::environment, unit_spectrum, 1);
    b.separate(b.add(sphere(1), b.interface()), b.medium(b.constant(0.25), slope(b, 0.2, 2)));
    const auto expected = [](double nm) { return std::exp(-2 * (0.25 + slope_at(nm, 0.2, 2))); };
    expect_every_path(trace_radiances(*b.freeze()), expected, 1e-5);
  }
}

// Three shells and the camera in a fourth medium: each stretch counts with its own coefficient.
TEST(Volumes, AddUpTheirStretches) {
  SceneBuilder b(16, 16, 16, 0);
  const Entity camera = b.look_at({0, 0, 5}, {0, 0, 0}, orthographic(1e-3f), {0, 1, 0});
  b.emit(b.add(rectangle(4, 4), b.diffuse(0.0), moved(0, 0, -3)), unit_spectrum, 1);
  const Entity air = b.medium(b.constant(0.01), zero_spectrum), outer = b.medium(b.constant(0.3), zero_spectrum);
  const Entity middle = b.medium(b.constant(0.7), zero_spectrum);
  b.separate(camera, {}, air);
  b.scene.meshes.push_back(cube_mesh());
  b.separate(b.add(mesh(0), b.interface(), stretched(4, 4, 4)), outer, air);
  b.separate(b.add(sphere(1), b.interface(), moved(0, 0, 0.5)), middle, outer);
  b.separate(b.add(sphere(0.5f), b.interface(), moved(0, 0, 0.5)), {}, middle);
  // 3 m of air before the box and 1 m behind, 4 - 2 m of outer, 2 - 1 m of middle.
  const double depth = 4 * 0.01 + 2 * 0.3 + 1 * 0.7;
  expect_every_path(
      trace_radiances(*b.freeze()), [=](double) { return std::exp(-depth); }, 1e-5);
}

// Instances, mirrored and stretched, know their sides.
TEST(Volumes, FillMirroredInstances) {
  SceneBuilder b = beam(16, 0);
  b.light(LightKind::environment, unit_spectrum, 1);
  b.scene.meshes.push_back(cube_mesh());
  const Entity tea = b.medium(b.constant(1), zero_spectrum);
  b.separate(b.add(mesh(0), b.interface(), moved(0, 0, 2) * stretched(1, -1, 0.5)), tea);
  b.separate(b.add(mesh(0), b.interface(), moved(0, 0, -1) * stretched(-1, 1, 0.25)), tea);
  expect_every_path(
      trace_radiances(*b.freeze()), [](double) { return std::exp(-0.75); }, 1e-5);
}

// A lamp over a floor, a slab of tea between them, beside which the camera looks in.
SceneBuilder lit_floor(bool has_tea, Integrator integrator) {
  SceneBuilder b(16, 16, 16, 1);
  b.scene.settings.integrator = integrator;
  b.look_at({0, 0.3, 3}, {0, 0, 0}, perspective(0.01f));
  b.add(rectangle(2, 2), b.diffuse(0.5), turned(-90, 1, 0, 0));
  b.light(LightKind::point, unit_spectrum, 1, moved(0, 2, 0));
  b.scene.meshes.push_back(cube_mesh());
  const Entity slab = b.add(mesh(0), b.interface(), moved(0, 1, 0) * stretched(3, 0.5, 3));
  if (has_tea) b.separate(slab, b.medium(slope(b, 0.5, 3), b.constant(0.1)));
  return b;
}

TEST(Volumes, DimLightThatComesThroughInterfaces) {
  for (const Integrator integrator : {Integrator::local, Integrator::path}) {
    const auto bare = [](double) { return 0.5 / pi / 4; };
    const auto dimmed = [&](double nm) { return bare(nm) * std::exp(-0.5 * (0.1 + slope_at(nm, 0.5, 3))); };
    expect_every_path(trace_radiances(*lit_floor(false, integrator).freeze()), bare, 1e-3);
    expect_every_path(trace_radiances(*lit_floor(true, integrator).freeze()), dimmed, 1e-3);
  }
}

TEST(Volumes, HideNoLightButWhatIsInThemDoes) {
  SceneBuilder b = lit_floor(true, Integrator::path);
  b.add(disk(0.5f), b.diffuse(0.0), moved(0, 1, 0) * turned(90, 1, 0, 0));
  for (const PathRadiance& path : trace_radiances(*b.freeze()))
    for (const double radiance : path.radiance) ASSERT_EQ(radiance, 0);
}

// pbrt does not count them either.
TEST(Volumes, InterfacesCostNoDepth) {
  SceneBuilder b = beam(64, 1);
  b.light(LightKind::directional, unit_spectrum, 1);
  b.add(rectangle(2, 2), b.diffuse(0.5));
  for (int k = 0; k < 6; ++k) b.add(sphere(1.0f + 0.2f * float(k)), b.interface());
  expect_every_path(
      trace_radiances(*b.freeze()), [](double) { return 0.5 / pi; }, 1e-4);
}

// One that shines is seen, and seen through.
TEST(Volumes, InterfacesMayShine) {
  SceneBuilder b = beam(16, 0);
  b.light(LightKind::environment, unit_spectrum, 1);
  b.emit(b.add(rectangle(2, 2), b.interface()), unit_spectrum, 3);
  expect_every_path(
      trace_radiances(*b.freeze()), [](double) { return 4.0; }, 1e-5);
}

TEST(Volumes, ThatOnlyScatterVanishInAFurnace) {
  for (const float g : {0.7f, -0.5f}) {
    SceneBuilder b(16, 16, 1024, many_events);
    b.light(LightKind::environment, unit_spectrum, 1);
    b.look_at({0, 0, 3}, {0, 0, 0}, perspective(30));
    b.separate(b.add(sphere(1), b.interface()), b.medium(zero_spectrum, slope(b, 0.5, 5), g));
    const std::unique_ptr<World> world = b.freeze();
    EXPECT_TRUE(world->shares_paths);
    expect_mean(
        trace_radiances(*world), [](double) { return 1.0; }, 0.02);
  }
}

TEST(Volumes, OfOneColourVanishInAFurnaceAndCarryNoShares) {
  SceneBuilder b(16, 16, 512, many_events);
  b.light(LightKind::environment, unit_spectrum, 1);
  b.look_at({0, 0, 3}, {0, 0, 0}, perspective(30));
  b.separate(b.add(sphere(1), b.interface()), b.medium(zero_spectrum, b.constant(4), 0.3f));
  const std::unique_ptr<World> world = b.freeze();
  EXPECT_FALSE(world->shares_paths);
  expect_mean(
      trace_radiances(*world), [](double) { return 1.0; }, 0.02);
}

// The colours of RGB mode have free paths of their own: three wavelengths take the lead in turn.
TEST(Volumes, VanishInTheFurnaceOfRgbMode) {
  SceneBuilder b(16, 16, 1024, many_events);
  b.scene.settings.color = ColorMode::rgb;
  b.light(LightKind::environment, b.named("D65"), static_cast<float>(1 / b.scene.spectra.luminance(b.named("D65"))));
  b.look_at({0, 0, 3}, {0, 0, 0}, perspective(30));
  const SpectrumId red = b.scene.spectra.add_rgb({5, 1, 0.5}, RgbKind::unbounded).id;
  b.separate(b.add(sphere(1.2f), b.interface()), b.medium(zero_spectrum, red, 0.3f));
  const std::vector<PathRadiance> paths = trace_radiances(*b.freeze());
  for (const double primary_nm : {611.0, 549.0, 464.0}) {
    double sum = 0, squares = 0, count = 0;
    for (const PathRadiance& path : paths)
      for (size_t j = 0; j < 3; ++j) {
        if (std::abs(path.lambda_nm[j] - primary_nm) > 1) continue;
        sum += path.radiance[j], squares += path.radiance[j] * path.radiance[j], count += 1;
      }
    EXPECT_EQ(count, double(paths.size()));
    const double deviation = std::sqrt(squares / count - sum / count * sum / count) / std::sqrt(count);
    EXPECT_NEAR(sum / count, 1, 5 * deviation) << primary_nm;
    EXPECT_LT(deviation, 0.004);
  }
}

// A ball lit from above at a right angle to the beam: along the diameter light arrives over sqrt(1 - x^2) and leaves
// over 1 - x, and the phase function is that of a right angle.
TEST(Volumes, ScatterOnceAsTheIntegralSays) {
  constexpr double g = 0.4, sigma_a = 0.3;
  SceneBuilder b = beam(4096, 1);
  b.light(LightKind::directional, unit_spectrum, 1, turned(-90, 1, 0, 0));
  b.separate(b.add(sphere(1), b.interface()), b.medium(b.constant(sigma_a), slope(b, 0.5, 4), float(g)));
  const double phase = (1 - g * g) / (4 * pi * std::pow(1 + g * g, 1.5));
  Samples expected;  // by the nanometre
  for (size_t i = 0; i < expected.size(); ++i) {
    const double sigma_s = slope_at(lambda_min_nm + double(i), 0.5, 4), sigma_t = sigma_a + sigma_s;
    const auto arriving = [&](double x, double) { return std::exp(-sigma_t * (1 - x + std::sqrt(1 - x * x))); };
    expected[i] = sigma_s * phase * integrate_rectangle(arriving, -1, 1, 0, 1, 16);
  }
  expect_mean(
      trace_radiances(*b.freeze()), [&](double nm) { return interpolate(expected, nm); }, 0.015);
}

TEST(Volumes, GlowByTheirAbsorption) {
  for (const Integrator integrator : all_levels) {
    SceneBuilder b = beam(16, 0, integrator);
    const Entity flame = b.medium(slope(b, 1e-4, 2), zero_spectrum);
    Medium glowing = b.scene.registry.get<Medium>(flame);
    glowing.emission = unit_spectrum;
    glowing.emission_scale = 3;
    glowing.scale = 2;
    b.scene.registry.set(flame, glowing);
    b.separate(b.add(sphere(1), b.interface()), flame);
    const auto expected = [](double nm) { return -3 * std::expm1(-4 * slope_at(nm, 1e-4, 2)); };
    expect_every_path(trace_radiances(*b.freeze()), expected, 2e-5);
  }
}

// Glowing haze without end: Le sigma_a / sigma_t times what scattering returns, which is Le on the whole.
TEST(Volumes, GlowToTheirOwnRadianceWithoutEnd) {
  SceneBuilder b(16, 16, 1024, many_events);
  const Entity camera = b.look_at({0, 0, 5}, {0, 0, 0}, perspective(30));
  const Entity haze = b.medium(b.constant(0.5), slope(b, 0.1, 1), 0.2f);
  Medium glowing = b.scene.registry.get<Medium>(haze);
  glowing.emission = unit_spectrum;
  b.scene.registry.set(haze, glowing);
  b.separate(camera, {}, haze);
  expect_mean(
      trace_radiances(*b.freeze()), [](double) { return 1.0; }, 0.01);
}

// Straight through a ball of glass filled with tea, in a furnace: F + (1 - F)^2 T / (1 - F T).
TEST(Volumes, FillDielectrics) {
  const double f = 0.04;
  const auto shown = [&](double nm) {
    const double t = std::exp(-2 * slope_at(nm, 0.1, 1));
    return f + (1 - f) * (1 - f) * t / (1 - f * t);
  };
  for (const Integrator integrator : {Integrator::recursive, Integrator::path}) {
    SceneBuilder b = beam(1024, 40, integrator);
    b.light(LightKind::environment, unit_spectrum, 1);
    b.separate(b.add(sphere(1), b.dielectric(b.constant(1.5))), b.medium(slope(b, 0.1, 1), zero_spectrum));
    const std::vector<PathRadiance> paths = trace_radiances(*b.freeze());
    if (integrator == Integrator::recursive)
      expect_every_path(paths, shown, 1e-4);
    else
      expect_mean(paths, shown, 0.02);
  }
}

// A white ball of milk in smooth and in rough glass of one index, and milk around a hollow one, vanish in a furnace.
TEST(Volumes, ThatScatterInGlassVanishInAFurnace) {
  for (const float alpha : {0.0f, 0.001f}) {
    SceneBuilder b(16, 16, 256, many_events);
    const Entity camera = b.look_at({0, 0, 3}, {0, 0, 0}, perspective(30));
    b.light(LightKind::environment, unit_spectrum, 1);
    const Entity milk = b.medium(zero_spectrum, slope(b, 1, 4), 0.5f);
    b.separate(camera, {}, {});
    b.separate(b.add(sphere(1.2f), b.rough_glass(b.constant(1.3), alpha, alpha)), milk);
    b.separate(b.add(sphere(0.5f), b.dielectric(b.constant(0.8))), {}, milk);
    expect_mean(
        trace_radiances(*b.freeze()), [](double) { return 1.0; }, 0.03);
  }
}

// Where wavelengths part they also differ in how likely they made the path: the hero goes on for all of them.
TEST(Volumes, ThatScatterInDispersingGlassVanishInAFurnace) {
  SceneBuilder b(16, 16, 512, many_events);
  b.look_at({0, 0, 3}, {0, 0, 0}, perspective(30));
  b.light(LightKind::environment, unit_spectrum, 1);
  const Entity haze = b.medium(zero_spectrum, slope(b, 0.2, 2), 0.5f);
  b.separate(b.add(sphere(1.2f), b.interface()), haze);
  b.separate(b.add(sphere(0.6f), b.dielectric(b.named("SF66"))), haze, haze);
  expect_mean(
      trace_radiances(*b.freeze()), [](double) { return 1.0; }, 0.04);
}

// One beyond the bound ends, is counted and brings nothing.
TEST(Volumes, RaysThroughTooManyInterfacesAreCounted) {
  for (const uint32_t count : {most_interfaces, most_interfaces + 1}) {
    SceneBuilder b(4, 4, 1, 0);
    b.look_at({0, 0, 5}, {0, 0, 0}, perspective(0.1f));
    b.light(LightKind::environment, unit_spectrum, 1);
    for (uint32_t k = 0; k < count; ++k) b.add(disk(1), b.interface(), moved(0, 0, -double(k) / count));
    RenderStats stats;
    const Film film = render_film(*b.freeze(), {1, 16}, &stats);
    EXPECT_EQ(stats.counters.lost_rays, count > most_interfaces ? 16u : 0u);
    EXPECT_EQ(mean_xyz(film, 5)[1] > 0, count <= most_interfaces);
  }
}

TEST(Volumes, BadMediaAreNamedAllInOneGo) {
  SceneBuilder b = beam(1, 1);
  const auto bad = [&](std::string_view name, const auto& spoil) {
    const Entity entity = b.medium(unit_spectrum, unit_spectrum);
    Medium medium = b.scene.registry.get<Medium>(entity);
    spoil(medium);
    b.scene.registry.set(entity, medium);
    b.scene.registry.set(entity, Name{b.scene.names.add(name)});
  };
  bad("one way", [](Medium& m) { m.g = 1; });
  bad("shining", [&](Medium& m) { m.sigma_a = b.constant(-1); });
  bad("dark", [](Medium& m) { m.scale = -1; });
  bad("endless", [](Medium& m) { m.emission_scale = INFINITY; });
  const Entity ball = b.add(sphere(1), b.interface());
  b.scene.registry.set(ball, Name{b.scene.names.add("ball")});
  b.separate(ball, ball);
  Diagnostics diagnostics;
  EXPECT_EQ(metamer::freeze(b.scene, diagnostics), nullptr);
  EXPECT_EQ(diagnostics.error_count(), 5u);
  const std::string text = format_diagnostics(diagnostics);
  for (const char* name : {"'one way'", "'shining'", "'dark'", "'endless'", "'ball'"})
    EXPECT_NE(text.find(name), std::string::npos) << name << " in\n" << text;
}

}  // namespace
}  // namespace metamer
