// Being inside of something: absorption, the index between two media, which of several fills the space.
#include <cmath>
#include <set>

#include "systems/bsdf/reference.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

double transmittance(double kappa, double lambda_nm, double metres) {
  return std::exp(-4 * 3.14159265358979323846 * kappa / (lambda_nm * 1e-9) * metres);
}
ShadeKind kind_of(const World& world, uint32_t object) {
  return static_cast<ShadeKind>(world.objects.shade_kind[object]);
}

// A narrow beam along -z, from z = 3.
SceneBuilder beam(uint32_t samples_per_pixel, uint32_t max_depth) {
  SceneBuilder b(16, 16, samples_per_pixel, max_depth);
  b.look_at({0, 0, 3}, {0, 0, 0}, orthographic(1e-3f));
  return b;
}
// A plate of matter with its front at z = `front`.
void add_plate(SceneBuilder& b, const Material& material, double front, double thickness) {
  if (b.scene.meshes.empty()) b.scene.meshes.push_back(cube_mesh());
  b.add(mesh(0), material, moved(0, 0, front - thickness / 2) * stretched(1, 1, thickness));
}
void add_screen(SceneBuilder& b, double z) {
  b.emit(b.add(rectangle(1, 1), b.diffuse(0.0), moved(0, 0, z)), unit_spectrum, 1);
}

// The number: kappa 1e-6 at 550 nm over 10 cm passes 0.102.
TEST(Media, TenCentimetresOfKappaOneInAMillionPassATenth) {
  EXPECT_NEAR(transmittance(1e-6, 550, 0.1), 0.102, 5e-4);
  SceneBuilder b = beam(8, 4);
  add_plate(b, b.smooth(b.constant(1), b.constant(1e-6)), 0, 0.1);  // no interfaces
  add_screen(b, -1);
  const auto world = b.freeze();
  EXPECT_TRUE(world->has_interiors);
  expect_every_path(
      trace_radiances(*world), [](double nm) { return transmittance(1e-6, nm, 0.1); }, 1e-4);
}

TEST(Media, AnAbsorbingPlateIsAThinOneOfItsThickness) {
  const reference::ThinOptics thin = [] {
    reference::ThinOptics optics;
    optics.eta.fill(1.5);
    return optics;
  }();
  const auto through = [&](double nm) {
    reference::ThinOptics optics = thin;
    optics.optical_depth[0] = -std::log(transmittance(1e-6, nm, 0.02));
    return reference::thin_shares(optics, 0, 1).transmitted;
  };
  SceneBuilder b = beam(256, 60);
  add_plate(b, b.smooth(b.constant(1.5), b.constant(1e-6)), 0, 0.02);
  add_screen(b, -1);
  expect_mean(trace_radiances(*b.freeze()), through, 0.02);
  SceneBuilder c = beam(256, 3);
  c.add(rectangle(1, 1), c.thin(c.constant(1.5), c.constant(1e-6), 0.02f));
  add_screen(c, -1);
  expect_mean(trace_radiances(*c.freeze()), through, 0.02);
}

// Both ends of what smooth matter can be have kernels of their own.
TEST(Media, SmoothMatterBecomesWhatItIs) {
  SceneBuilder b = beam(1, 1);
  b.add(sphere(1), b.smooth(b.constant(1.5), b.constant(0.009)));
  b.add(sphere(1), b.smooth(b.constant(1.5), b.constant(0.01)));
  const std::vector<double> nm = {400, 700}, kappa = {0, 3};
  b.add(sphere(1), b.smooth(b.constant(1.5), b.scene.spectra.add_table(nm, kappa, Extend::constant).id));
  b.add(sphere(1), b.rough_glass(b.constant(1.5), 0.1f, 0.1f));
  b.add(sphere(1), b.thin(b.constant(1.5), zero_spectrum, 0));
  const auto world = b.freeze();
  EXPECT_EQ(kind_of(*world, 0), ShadeKind::dielectric);
  EXPECT_EQ(kind_of(*world, 1), ShadeKind::smooth_conductor);
  EXPECT_EQ(kind_of(*world, 2), ShadeKind::dielectric);
  EXPECT_EQ(kind_of(*world, 3), ShadeKind::rough_dielectric);
  EXPECT_EQ(kind_of(*world, 4), ShadeKind::thin_dielectric);
  EXPECT_EQ(world->dielectric.partly_opaque[0], 0u);
  EXPECT_EQ(world->dielectric.partly_opaque[1], 1u);
}

// On each wavelength glass below the limit of kappa, metal above it.
TEST(Media, PartlyOpaqueMatterReflectsAsMetalWhereItIsOpaque) {
  const std::vector<double> nm = {549.5, 550.5}, kappa = {0, 2};
  SceneBuilder b = beam(1024, 1);
  b.light(LightKind::environment, unit_spectrum, 1);
  add_plate(b, b.smooth(b.constant(1.5), b.scene.spectra.add_table(nm, kappa, Extend::constant).id), 0, 1);
  const auto world = b.freeze();
  // One event: what is reflected leaves, what is refracted does not.
  expect_mean(
      trace_radiances(*world),
      [&](double at) {
        const double extinction = world->spectra.value(world->dielectric.kappa[0], at);
        return extinction < 0.01 ? reference::fresnel_dielectric(1.5, 1)
                                 : reference::fresnel_conductor(1.5, extinction, 1);
      },
      0.15);
}

TEST(Media, ALargeKappaTendsToThePerfectMirror) {
  double last = 0;
  for (const double kappa : {1.0, 10.0, 100.0, 1e4, 1e8}) {
    SceneBuilder b = beam(1, 2);
    b.light(LightKind::environment, unit_spectrum, 1);
    add_plate(b, b.smooth(b.constant(1.5), b.constant(kappa)), 0, 1);
    const double seen = trace_radiances(*b.freeze()).front().radiance[0];
    EXPECT_GT(seen, last);
    last = seen;
  }
  EXPECT_EQ(last, 1);
}

// A camera in water sees an emitter through the water between, and a mirror with the index of gold against water.
TEST(Media, TheCameraKnowsWhatItIsIn) {
  for (const bool is_open : {false, true}) {
    SceneBuilder b(16, 16, 4, 3);
    const Material water = b.smooth(b.constant(1.33), b.constant(1e-7));
    if (is_open) {
      b.add(rectangle(60, 60), water, moved(0, 2, 0) * turned(-90, 1, 0, 0));
    } else {
      b.add(sphere(5), water);
    }
    add_screen(b, -1);
    b.look_at({0, 0, 1}, {0, 0, 0}, orthographic(1e-3f));
    const auto world = b.freeze();
    EXPECT_EQ(world->camera_media[0], 1u);
    expect_every_path(
        trace_radiances(*world), [](double nm) { return transmittance(1e-7, nm, 2); }, 1e-5);
  }
  SceneBuilder b = beam(1, 1);
  b.add(sphere(1), b.smooth(b.constant(1.33), b.constant(1e-7)));
  EXPECT_EQ(b.freeze()->camera_media[0], 0u) << "it looks at the ball from outside";
}

TEST(Media, MetalInWaterHasTheIndexAgainstWater) {
  SceneBuilder b(16, 16, 1, 1);
  b.add(sphere(5), b.smooth(b.constant(1.33), b.constant(0)));
  b.add(rectangle(1, 1), b.conductor(b.constant(0.4), b.constant(2.5)), moved(0, 0, -1));
  b.emit(b.add(rectangle(1, 1), b.diffuse(0.0), moved(0, 0, 2) * turned(180, 1, 0, 0)), unit_spectrum, 1);
  b.look_at({0, 0, 1}, {0, 0, 0}, orthographic(1e-3f));
  const double wanted = reference::fresnel_conductor(0.4 / 1.33, 2.5 / 1.33, 1);
  EXPECT_GT(std::abs(wanted - reference::fresnel_conductor(0.4, 2.5, 1)), 0.01);
  expect_every_path(
      trace_radiances(*b.freeze()), [&](double) { return wanted; }, 1e-4);
}

// The transmittance of a stack of plates at normal incidence, all reflections between them, by adding plates.
double stack_transmittance(std::initializer_list<double> indices) {
  double r = 0, t = 1, before = 1, r_back = 0;
  for (const double n : indices) {
    const double f = reference::fresnel_dielectric(n / before, 1);
    const double inner = 1 / (1 - r_back * f);
    const double r_new = r + t * t * f * inner, back = f + (1 - f) * (1 - f) * r_back * inner;
    t = t * (1 - f) * inner;
    r = r_new, r_back = back, before = n;
  }
  return t;
}

// Water poured into glass so that it overlaps the wall: the glass, of the higher priority, ends where it ends.
TEST(Media, WhereSolidsOverlapTheHigherPriorityFillsTheSpace) {
  EXPECT_NEAR(stack_transmittance({1.5, 1.0}), 1 - 2 * 0.04 / 1.04, 1e-12);
  const double wanted = stack_transmittance({1.6, 1.33, 1.0});
  EXPECT_LT(wanted, stack_transmittance({1.33, 1.0}) - 0.02);
  for (const bool overlap_in_front : {false, true}) {
    SceneBuilder b = beam(256, 60);
    add_plate(b, b.smooth(b.constant(1.6), zero_spectrum, 7), overlap_in_front ? -0.5 : 0.0, 0.5);
    add_plate(b, b.smooth(b.constant(1.33), zero_spectrum, 3), overlap_in_front ? 0.0 : -0.2,
              overlap_in_front ? 0.7 : 1.0);
    add_screen(b, -2);
    // From behind the stack is the same read backwards, and so is its transmittance.
    expect_mean(
        trace_radiances(*b.freeze()), [&](double) { return wanted; }, 0.02);
  }
}

// Where they overlap it is the higher priority that absorbs, whichever was entered first; without interfaces.
TEST(Media, TheHigherPriorityAbsorbsWhereSolidsOverlap) {
  for (const bool overlap_in_front : {false, true}) {
    SceneBuilder b = beam(1, 8);
    b.scene.settings.integrator = Integrator::recursive;  // it ends no path by chance
    add_plate(b, b.smooth(b.constant(1), b.constant(1e-7), 7), overlap_in_front ? -0.5 : 0.0, 0.5);
    add_plate(b, b.smooth(b.constant(1), b.constant(3e-8), 3), overlap_in_front ? 0.0 : -0.2,
              overlap_in_front ? 0.7 : 1.0);
    add_screen(b, -2);
    const double lesser = overlap_in_front ? 0.5 : 0.7;
    expect_every_path(
        trace_radiances(*b.freeze()),
        [&](double nm) { return transmittance(1e-7, nm, 0.5) * transmittance(3e-8, nm, lesser); }, 1e-4);
  }
}

// The same without chance: every branch of the stack, on every path.
TEST(Media, RecursiveFollowsEveryBranchThroughAStack) {
  const double wanted = stack_transmittance({1.6, 1.33, 1.0});
  SceneBuilder b = beam(1, 16);
  b.scene.settings.integrator = Integrator::recursive;
  add_plate(b, b.smooth(b.constant(1.6), zero_spectrum, 7), 0, 0.5);
  add_plate(b, b.smooth(b.constant(1.33), zero_spectrum, 3), -0.2, 1);
  add_screen(b, -2);
  expect_every_path(
      trace_radiances(*b.freeze()), [&](double) { return wanted; }, 1e-4);
  SceneBuilder c = beam(1, 4);
  c.scene.settings.integrator = Integrator::recursive;
  c.add(rectangle(1, 1), c.thin(c.constant(1.5), c.constant(1e-6), 0.02f));
  add_screen(c, -1);
  expect_every_path(
      trace_radiances(*c.freeze()),
      [](double nm) {
        reference::ThinOptics optics;
        optics.eta.fill(1.5);
        optics.optical_depth[0] = -std::log(transmittance(1e-6, nm, 0.02));
        return reference::thin_shares(optics, 0, 1).transmitted;
      },
      1e-4);
}

// A bubble of air of high priority in glass, and in the bubble a lesser glass ball: it is not there.
TEST(Media, WhatALowerPriorityAddsInsideIsPassedThrough) {
  SceneBuilder b = beam(16, 8);
  const Material air = b.smooth(b.constant(1), zero_spectrum, 9);
  add_plate(b, air, 1, 2);
  b.add(sphere(0.5f), b.smooth(b.constant(1.7), b.constant(1e-5), 2), moved(1e-4, 0, 0));
  add_screen(b, -2);
  expect_every_path(
      trace_radiances(*b.freeze()), [](double) { return 1.0; }, 1e-6);
}

// Every path comes out as bright as it went in only if every boundary is left with the index it was entered with.
TEST(Media, OverlappingLosslessSolidsVanishInTheFurnaceOnEveryPath) {
  SceneBuilder b(16, 16, 32, 400);
  b.light(LightKind::environment, unit_spectrum, 1);
  b.look_at({0, 0, 3}, {0, 0, 0}, perspective(40));
  b.add(sphere(0.6f), b.smooth(b.constant(1.5), zero_spectrum, 3), moved(-0.3, 0, 0));
  b.add(sphere(0.6f), b.smooth(b.constant(1.33), zero_spectrum, 2), moved(0.3, 0, 0.1));
  b.add(sphere(0.5f), b.smooth(b.constant(2.4), zero_spectrum, 1), moved(0, 0.4, 0));
  b.add(sphere(0.2f), b.smooth(b.constant(1), zero_spectrum, 4), moved(0, 0.1, 0.3));
  expect_every_path(
      trace_radiances(*b.freeze()), [](double) { return 1.0; }, 2e-4);
}

TEST(Media, EqualMaterialsAreOneMediumAndHaveNoBoundaryBetweenThem) {
  SceneBuilder b = beam(256, 60);
  add_plate(b, b.smooth(b.constant(1.5), zero_spectrum), 0.5, 1);
  b.add(sphere(0.3f), b.smooth(b.constant(1.5), zero_spectrum), moved(0, 0, 0.1));
  add_screen(b, -1);
  const auto world = b.freeze();
  EXPECT_EQ(world->media.eta.size(), 2u);
  const double wanted = stack_transmittance({1.5, 1.0});
  expect_mean(
      trace_radiances(*world), [&](double) { return wanted; }, 0.02);
}

// Five shells, one inside the other: the fifth does not fit into the stack, is counted, and the picture stays finite.
TEST(Media, AFifthMediumIsForgottenAndCounted) {
  SceneBuilder b(16, 16, 8, 32);
  b.light(LightKind::environment, unit_spectrum, 1);
  b.look_at({0, 0, 3}, {0, 0, 0}, perspective(20));
  for (uint32_t k = 0; k < 5; ++k)
    b.add(sphere(1.0f - 0.15f * float(k)), b.smooth(b.constant(1.1 + 0.1 * k), b.constant(1e-8), k + 1));
  RenderStats stats;
  const Film film = render_film(*b.freeze(), {1, 16}, &stats);
  EXPECT_EQ(film.invalid_samples(), 0u);
  EXPECT_GT(stats.counters.lost_media, 0u);
  SceneBuilder c(16, 16, 8, 32);
  c.light(LightKind::environment, unit_spectrum, 1);
  c.look_at({0, 0, 3}, {0, 0, 0}, perspective(20));
  for (uint32_t k = 0; k < 4; ++k)
    c.add(sphere(1.0f - 0.15f * float(k)), c.smooth(c.constant(1.1 + 0.1 * k), c.constant(1e-8), k + 1));
  render_film(*c.freeze(), {1, 16}, &stats);
  EXPECT_EQ(stats.counters.lost_media, 0u);
}

TEST(Media, BadOpticsAreNamedAllInOneGo) {
  SceneBuilder b = beam(1, 1);
  const auto bad = [&](const Material& material, std::string_view name) {
    b.scene.registry.set(b.add(sphere(1), material), Name{b.scene.names.add(name)});
  };
  bad(b.smooth(b.constant(-1), zero_spectrum), "nothing");
  bad(b.smooth(b.constant(1.5), b.constant(-2)), "shining");
  bad(b.rough_glass(b.constant(1.5), -0.1f, 0.2f), "negative");
  Material coal = b.dielectric(b.constant(1.5));
  coal.kappa = b.constant(0.5);
  bad(coal, "coal");
  bad(b.thin(b.constant(1.5), b.constant(1e-6), 0), "without thickness");
  Material high = b.smooth(b.constant(1.5), zero_spectrum, 256);
  bad(high, "high");
  Diagnostics diagnostics;
  EXPECT_EQ(metamer::freeze(b.scene, diagnostics), nullptr);
  EXPECT_EQ(diagnostics.error_count(), 6u);
  const std::string text = format_diagnostics(diagnostics);
  for (const char* name : {"'nothing'", "'shining'", "'negative'", "'coal'", "'without thickness'", "'high'"})
    EXPECT_NE(text.find(name), std::string::npos) << name << " in\n" << text;
}

}  // namespace
}  // namespace metamer
