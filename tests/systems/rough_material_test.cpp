// What is said about rough materials when the world is built, and what becomes of them.
#include <gmock/gmock.h>

#include <limits>

#include "tests/systems/support/scene_builder.h"

namespace metamer {
namespace {

using ::testing::HasSubstr;

struct Built {
  std::unique_ptr<World> world;
  std::string messages;
};
Built build(SceneBuilder& b, const Material& material) {
  const Entity entity = b.add(sphere(1), material);
  b.scene.registry.set(entity, Name{b.scene.names.add("plate")});
  b.look_at({0, 0, 3}, {0, 0, 0}, perspective(30));
  Diagnostics diagnostics;
  Built built{freeze(b.scene, diagnostics), {}};
  built.messages = format_diagnostics(diagnostics);
  return built;
}
Built build(double kd, double ks, float shininess, bool normalized = false) {
  SceneBuilder b(4, 4, 1, 1);
  return build(b, b.rough(b.constant(kd), b.constant(ks), shininess, normalized));
}

// At normal view pi kd + 8 pi ks (1 - 2^(-(s+2)/2)) / (s+2): for s = 2 it is pi (kd + 1.5 ks).
TEST(RoughMaterial, AWarningNamesWhatCreatesEnergy) {
  EXPECT_THAT(build(0.2, 0.2, 2).messages, HasSubstr("warning: 'plate' creates energy: seen along the normal it "
                                                     "reflects 1.571 times"));
  EXPECT_EQ(build(0.127, 0.127, 2).messages, "");  // 0.9975
  EXPECT_NE(build(0.128, 0.127, 2).messages, "");  // 1.0006
  EXPECT_EQ(build(1 / 3.1416, 0, 0).messages, "");
  EXPECT_EQ(build(0, 5, 500).messages, "");
  EXPECT_NE(build(0, 0.16, 0).messages, "");  // 2 pi ks
  EXPECT_EQ(build(0, 0.159, 0).messages, "");
}

TEST(RoughMaterial, AWarningNamesTheWavelength) {
  SceneBuilder b(4, 4, 1, 1);
  const std::vector<double> lambda_nm = {360, 599, 600, 601, 830}, values = {0.1, 0.1, 0.5, 0.1, 0.1};
  const SpectrumId line = b.scene.spectra.add_table(lambda_nm, values, Extend::constant).id;
  const Built built = build(b, b.rough(line, b.constant(0), 1, false));
  EXPECT_THAT(built.messages, HasSubstr("1.571 times the light of its surroundings at 600 nm"));
}

TEST(RoughMaterial, NormalisedItKeepsToTheEnergyThereIs) {
  EXPECT_EQ(build(0.4, 0.6, 20, true).messages, "");
  SceneBuilder b(4, 4, 1, 1);
  const std::vector<double> lambda_nm = {360, 830}, values = {0.2, 0.9};
  const SpectrumId kd = b.scene.spectra.add_table(lambda_nm, values, Extend::constant).id;
  const Built built = build(b, b.rough(kd, b.constant(0.5), 20, true));
  EXPECT_THAT(built.messages, HasSubstr("warning: 'plate': 'kd' + 'ks' reaches 1.4 at 830 nm"));
  const World& world = *built.world;
  for (double nm = 360; nm <= 830; nm += 10) {
    const double diffuse = 0.2 + 0.7 * (nm - 360) / 470;
    EXPECT_NEAR(world.spectra.value(world.rough.ks[0], nm), std::min(0.5, 1 - diffuse), 1e-6) << nm;
  }
}

TEST(RoughMaterial, WhatIsNoMaterialIsAnError) {
  for (const float shininess : {-1.0f, 2e6f, std::numeric_limits<float>::quiet_NaN()}) {
    const Built built = build(0.1, 0.1, shininess);
    EXPECT_THAT(built.messages, HasSubstr("error: 'plate': 'shininess' is not a number from 0 to 1e6"));
    EXPECT_EQ(built.world, nullptr);
  }
  EXPECT_THAT(build(-0.1, 0.1, 1).messages, HasSubstr("error: 'plate': 'kd' or 'ks' is negative at some wavelength"));
  EXPECT_THAT(build(0.1, -0.1, 1).messages, HasSubstr("error: 'plate': 'kd' or 'ks' is negative at some wavelength"));
}

TEST(RoughMaterial, ABlackOneEndsPaths) {
  const Built built = build(0, 0, 5);
  EXPECT_EQ(built.world->objects.shade_kind[0], static_cast<uint32_t>(ShadeKind::absorber));
  EXPECT_EQ(built.world->rough.kd.size(), 0u);
}

}  // namespace
}  // namespace metamer
