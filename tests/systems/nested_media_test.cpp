// Media inside of solids that paths follow: where solids overlap, the medium is that of the highest priority.
#include <numbers>

#include "tests/systems/support/agreement.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

Material followed(SceneBuilder& b, double eta, uint32_t priority) {
  Material material = b.dielectric(b.constant(eta));
  material.priority = priority;
  return material;
}
Geometry hollow(float radius) {
  Geometry geometry = sphere(radius);
  geometry.flip_normal = 1;
  return geometry;
}

// Trees of rays: a path that is drawn to reflect with a chance of 1e-8 would be an exception to every statement about
// all paths. A glass of radius 1 with a hollow of 0.5, and tea grown into the glass, to 0.6, on the way along z.
struct GlassOfTea {
  SceneBuilder b;
  Entity tea;
  explicit GlassOfTea(double sigma_a, double eta = 1, bool tea_first = false) : b(16, 16, 16, 12) {
    b.scene.settings.integrator = Integrator::recursive;
    tea = b.medium(b.constant(sigma_a), zero_spectrum);
    if (tea_first) add_tea(eta);
    b.add(sphere(1), followed(b, eta, 2));
    b.add(hollow(0.5f), followed(b, eta, 2));
    if (!tea_first) add_tea(eta);
  }
  void add_tea(double eta) { b.separate(b.add(sphere(0.6f), followed(b, eta, 1)), tea); }
  void look_from(double z) { b.look_at({0, 0, z}, {0, 0, z - 1}, orthographic(1e-3f), {0, 1, 0}); }
  void expect_depth(double depth) {
    expect_every_path(
        trace_radiances(*b.freeze()), [=](double) { return std::exp(-depth); }, 1e-5);
  }
};

TEST(NestedMedia, BeginAtTheInnerWallOfTheGlass) {
  for (const bool tea_first : {false, true}) {
    GlassOfTea scene(1.3, 1, tea_first);
    scene.b.light(LightKind::environment, unit_spectrum, 1);
    scene.look_from(5);
    scene.expect_depth(1.3);
    scene.b.scene.settings.integrator = Integrator::path;
    scene.b.scene.settings.samples_per_pixel = 256;
    expect_mean(
        trace_radiances(*scene.b.freeze()), [](double) { return std::exp(-1.3); }, 0.08);
  }
}

// A bare lump of ice in it is no tea; a lump with air bubbles' medium of its own has that.
TEST(NestedMedia, SolidsInItDisplaceIt) {
  for (const bool is_filled : {false, true}) {
    GlassOfTea scene(1.3);
    scene.b.light(LightKind::environment, unit_spectrum, 1);
    const Entity ice = scene.b.add(sphere(0.2f), followed(scene.b, 1, 3));
    if (is_filled) scene.b.separate(ice, scene.b.medium(scene.b.constant(0.7), zero_spectrum));
    scene.look_from(5);
    scene.expect_depth(1.3 * 0.6 + (is_filled ? 0.7 * 0.4 : 0));
  }
}

// Of a lower priority than the glass, whatever reaches into its wall is not there.
TEST(NestedMedia, OfLowerPriorityAreHiddenInTheWall) {
  GlassOfTea scene(1.3);
  scene.b.light(LightKind::environment, unit_spectrum, 1);
  scene.b.separate(scene.b.add(sphere(0.1f), followed(scene.b, 1, 1), moved(0, 0, 0.8)),
                   scene.b.medium(scene.b.constant(5), zero_spectrum));
  scene.look_from(5);
  scene.expect_depth(1.3);
}

TEST(NestedMedia, TheCameraIsInTheMediumOfItsSolid) {
  GlassOfTea scene(1.3);
  scene.b.light(LightKind::environment, unit_spectrum, 1);
  scene.look_from(0.1);
  scene.expect_depth(1.3 * 0.6);
}

// One material shared by two balls with different media.
TEST(NestedMedia, BelongToSurfacesNotToMaterials) {
  SceneBuilder b(16, 16, 16, 12);
  b.scene.settings.integrator = Integrator::recursive;
  b.light(LightKind::environment, unit_spectrum, 1);
  b.look_at({0, 0, 5}, {0, 0, 0}, orthographic(1e-3f), {0, 1, 0});
  const Entity material = b.place();
  b.scene.registry.set(material, followed(b, 1, 4));
  const auto ball = [&](double z, double sigma_a) {
    const Entity entity = b.place(moved(0, 0, z));
    b.scene.registry.set(entity, sphere(0.5f));
    b.scene.registry.set(entity, MaterialSlot{material});
    b.separate(entity, b.medium(b.constant(sigma_a), zero_spectrum));
  };
  ball(1, 0.3);
  ball(-1, 0.9);
  expect_every_path(
      trace_radiances(*b.freeze()), [](double) { return std::exp(-1.2); }, 1e-5);
}

// A lamp and a card in the tea: to the card, and from there to the lamp.
TEST(NestedMedia, DimLightSamples) {
  double radiance[2] = {};
  for (const bool is_clear : {false, true}) {
    GlassOfTea scene(is_clear ? 0.0 : 1.3);
    SceneBuilder& b = scene.b;
    b.scene.settings.integrator = Integrator::path;
    b.add(rectangle(0.1f, 0.1f), b.diffuse(0.5));
    b.light(LightKind::point, unit_spectrum, 1, moved(0, 0, 0.4));
    scene.look_from(0.3);
    b.scene.settings.max_depth = 1;
    for (const PathRadiance& path : trace_radiances(*b.freeze())) radiance[is_clear] += path.radiance[0];
  }
  EXPECT_GT(radiance[1], 0);
  EXPECT_NEAR(radiance[0] / radiance[1], std::exp(-1.3 * 0.7), 1e-4);
}

SceneBuilder refracting_tea(uint32_t samples, double sigma_a, double sigma_s) {
  SceneBuilder b(16, 16, samples, 14);
  b.look_at({0, 0, 4}, {0, 0, 0}, perspective(36));
  const Entity tea = b.medium(b.constant(sigma_a), b.constant(sigma_s), 0.3f);
  b.add(sphere(1), followed(b, 1.5, 2));
  b.add(hollow(0.8f), followed(b, 1.5, 2));
  b.separate(b.add(sphere(0.9f), followed(b, 1.33, 1)), tea);
  b.add(sphere(0.3f), followed(b, 1.31, 3), moved(0.2, 0.1, 0.2));
  return b;
}

TEST(NestedMedia, AgreeWithTheOracle) {
  SceneBuilder b = refracting_tea(2048, 0.5, 0.8);
  b.add(rectangle(6, 6), b.diffuse(0.5), moved(0, -1.2, 0) * turned(-90, 1, 0, 0));
  b.light(LightKind::environment, unit_spectrum, 1);
  expect_agreement(*b.freeze(), 1024, 0.03);
}

TEST(NestedMedia, ThatOnlyScatterVanishInAFurnace) {
  SceneBuilder b = refracting_tea(128, 0, 2);
  b.scene.settings.max_depth = 400;
  b.light(LightKind::environment, unit_spectrum, 1);
  expect_mean(
      trace_radiances(*b.freeze()), [](double) { return 1.0; }, 0.03);
}

}  // namespace
}  // namespace metamer
