// Materials mixed of two others: each hit is of one of them, the second as often as `amount` says.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/systems/support/agreement.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

using ::testing::HasSubstr;

Entity material(SceneBuilder& b, const Material& m) {
  const Entity entity = b.scene.registry.create();
  b.scene.registry.set(entity, m);
  return entity;
}
Material mix(Entity first, Entity second, float amount) {
  Material m;
  m.kind = MaterialKind::mix;
  m.mix = {first, second, amount};
  return m;
}

// The first surface alone, in light of 1.
std::vector<PathRadiance> shown(SceneBuilder& b, const Material& m) {
  b.scene.settings.shadows = true;
  b.light(LightKind::environment, unit_spectrum, 1);
  b.look_at({0, 0, 1}, {0, 0, 0}, orthographic(1e-3f));
  b.add(rectangle(1, 1), m);
  return trace_radiances(*b.freeze());
}

TEST(MixedMaterial, ShowsTheSecondAsOftenAsItsAmount) {
  for (const float amount : {0.0f, 0.25f, 0.9f, 1.0f}) {
    SceneBuilder b(16, 16, 1024, 1);
    const Entity dark = material(b, b.diffuse(0.2)), light = material(b, b.diffuse(0.8));
    SCOPED_TRACE(amount);
    expect_mean(
        shown(b, mix(dark, light, amount)), [&](double) { return 0.2 + double{amount} * 0.6; }, 0.02);
  }
}

// Every hit is of one material, never of something in between: mirrors of 1 and of about 0.02.
TEST(MixedMaterial, EveryHitIsOfOneOfThem) {
  SceneBuilder b(16, 16, 64, 1);
  const Entity bright = material(b, b.conductor(unit_spectrum, b.constant(1e8)));
  const Entity dim = material(b, b.conductor(b.constant(1.333), b.constant(0)));
  size_t bright_hits = 0, all = 0;
  for (const PathRadiance& path : shown(b, mix(bright, dim, 0.3f))) {
    const double radiance = path.radiance[0];
    EXPECT_TRUE(std::abs(radiance - 1) < 1e-4 || std::abs(radiance - 0.0204) < 1e-4) << radiance;
    if (radiance > 0.5) ++bright_hits;
    ++all;
  }
  EXPECT_NEAR(double(bright_hits) / double(all), 0.7, 0.01);
}

// (0.1 and 0.9 half and half) with 0.4, the latter by a quarter: 0.75 x 0.5 + 0.25 x 0.4. The choices are independent.
TEST(MixedMaterial, MixesOfMixesMultiplyTheirShares) {
  SceneBuilder b(16, 16, 1024, 1);
  const Entity inner = material(b, {});
  const Entity a = material(b, b.diffuse(0.1)), c = material(b, b.diffuse(0.9));
  b.scene.registry.set(inner, mix(a, c, 0.5f));
  expect_mean(
      shown(b, mix(inner, material(b, b.diffuse(0.4)), 0.25f)), [](double) { return 0.475; }, 0.02);
}

std::string messages_of(SceneBuilder& b, Entity broken) {
  b.look_at({0, 0, 3}, {0, 0, 0}, perspective(30));
  b.scene.registry.set(broken, Name{b.scene.names.add("broken")});
  Diagnostics diagnostics;
  EXPECT_EQ(freeze(b.scene, diagnostics), nullptr);
  return format_diagnostics(diagnostics);
}

TEST(MixedMaterial, OneOfItselfIsAnError) {
  SceneBuilder b(4, 4, 1, 1);
  const Entity other = material(b, b.diffuse(0.5)), broken = b.scene.registry.create(),
               between = b.scene.registry.create();
  b.scene.registry.set(broken, mix(other, between, 0.5f));
  b.scene.registry.set(between, mix(broken, other, 0.5f));
  EXPECT_THAT(messages_of(b, broken), HasSubstr("error: 'broken': it is mixed of itself"));
}

TEST(MixedMaterial, OneOfNothingAndWithoutANumberIsAnError) {
  SceneBuilder b(4, 4, 1, 1);
  const Entity other = material(b, b.diffuse(0.5)), broken = material(b, mix(other, b.scene.registry.create(), NAN));
  const std::string messages = messages_of(b, broken);
  EXPECT_THAT(messages, HasSubstr("error: 'broken': it is mixed of something that is not a material"));
  EXPECT_THAT(messages, HasSubstr("error: 'broken': 'amount' is not a number"));
}

TEST(MixedMaterial, TheOracleAgreesOnMixesOfAllSortsAndOnSheets) {
  SceneBuilder b(16, 16, 4096, 4);
  const Entity glass = material(b, b.dielectric(b.constant(1.5)));
  const Entity red = material(b, b.diffuse(b.scene.spectra.add_rgb({0.7, 0.1, 0.1}, RgbKind::albedo).id));
  const Entity metal = material(b, b.conductor(b.named("Au.n"), b.named("Au.k"), 0.2f, 0.2f));
  Material sheet;
  sheet.kind = MaterialKind::diffuse_transmission;
  sheet.reflectance = b.scene.spectra.add_rgb({0.2, 0.5, 0.1}, RgbKind::albedo).id;
  sheet.transmittance = b.scene.spectra.add_rgb({0.4, 0.4, 0.1}, RgbKind::albedo).id;
  b.add(rectangle(6, 6), b.diffuse(0.5), moved(0, -1, 0) * turned(-90, 1, 0, 0));
  b.add(sphere(0.5f), mix(glass, red, 0.5f), moved(-0.6, -0.4, 0));
  b.add(sphere(0.5f), mix(red, metal, 0.3f), moved(0.6, -0.4, 0));
  b.add(rectangle(1.5f, 1.5f), sheet, moved(0, 0.5, -0.4));
  const Entity lamp = b.add(rectangle(1.5f, 1.5f), b.diffuse(0.0), moved(0, 1.5, -1) * turned(60, 1, 0, 0));
  b.emit(lamp, b.named("D65"), 0.01f, true);
  b.light(LightKind::environment, b.named("D65"), 0.003f);
  b.look_at({0, 0, 3.7}, {0, 0, 0}, perspective(40));
  expect_agreement(*b.freeze(), 4096, 0.03);
}

// What has no closed form, by scalar walks: a metal under a smooth coat, a rough one, and paint under a milky layer.
TEST(LayeredMaterial, TheOracleAgrees) {
  SceneBuilder b(16, 16, 2048, 4);
  b.add(rectangle(6, 6), b.diffuse(0.5), moved(0, -1, 0) * turned(-90, 1, 0, 0));
  Material coat = b.coated(b.constant(0.7), b.constant(1.5));
  coat.kind = MaterialKind::layered;
  coat.layer.albedo = b.scene.spectra.add_rgb({0.3, 0.6, 0.9}, RgbKind::albedo).id;
  coat.layer.thickness = 0.5f;
  coat.layer.asymmetry = 0.3f;
  b.add(rectangle(4, 4), coat, moved(0, 0, -1.2));
  Material metal = b.coated(zero_spectrum, b.constant(1.5));
  metal.kind = MaterialKind::layered;
  metal.layer.base = LayerBase::conductor;
  metal.layer.base_eta = b.named("Cu.n");
  metal.layer.base_kappa = b.named("Cu.k");
  metal.layer.base_alpha_x = metal.layer.base_alpha_y = 0.4f;
  b.add(sphere(0.5f), metal, moved(-0.6, -0.4, 0));
  metal.alpha_x = metal.alpha_y = 0.4f;
  b.add(sphere(0.5f), metal, moved(0.6, -0.4, 0));
  const Entity lamp = b.add(rectangle(1.5f, 1.5f), b.diffuse(0.0), moved(0, 1.5, 0.5) * turned(90, 1, 0, 0));
  b.emit(lamp, b.named("D65"), 0.01f);
  b.light(LightKind::environment, b.named("D65"), 0.003f);
  b.look_at({0, 0, 3.7}, {0, 0, 0}, perspective(40));
  expect_agreement(*b.freeze(), 1024, 0.05);
}

}  // namespace
}  // namespace metamer
