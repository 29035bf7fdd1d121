// Coated matter through the whole pipeline: furnaces on each wavelength, the oracle, lights met by both strategies of
// multiple importance sampling, and what is said about wrong materials.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "systems/bsdf/coat_albedo.h"
#include "tests/systems/support/agreement.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

using ::testing::HasSubstr;

// A surface that fills the view at an angle, in light of 1 from everywhere.
SceneBuilder in_even_light(double degrees, uint32_t samples_per_pixel) {
  SceneBuilder b(16, 16, samples_per_pixel, 2);
  b.light(LightKind::environment, unit_spectrum, 1);
  const double theta = glm::radians(degrees);
  b.look_at({std::sin(theta), 0, std::cos(theta)}, {0, 0, 0}, orthographic(1e-3f), {0, 1, 0});
  return b;
}

TEST(CoatedMaterial, AWhiteOneVanishesInAFurnaceOnEveryWavelength) {
  for (const float alpha : {0.0f, 0.05f, 0.3f, 0.9f})
    for (const double degrees : {0.0, 50.0, 80.0}) {
      SceneBuilder b = in_even_light(degrees, 1024);
      b.add(rectangle(1, 1), b.coated(unit_spectrum, b.named("BK7"), alpha));
      SCOPED_TRACE(testing::Message() << alpha << " at " << degrees);
      expect_mean(
          trace_radiances(*b.freeze()), [](double) { return 1.0; }, 0.02);
    }
}

// F + (1 - F) a (1 - F_inside) / (1 - a F_inside), each wavelength with its own eta and albedo.
TEST(CoatedMaterial, ASmoothOneShowsItsAlbedoOnEachWavelength) {
  const std::vector<double> lambda_nm = {360, 830}, albedos = {0.1, 0.9}, etas = {1.8, 1.4};
  for (const double degrees : {20.0, 75.0}) {
    SceneBuilder b = in_even_light(degrees, 1024);
    const SpectrumId albedo = b.scene.spectra.add_table(lambda_nm, albedos, Extend::constant).id;
    const SpectrumId eta = b.scene.spectra.add_table(lambda_nm, etas, Extend::constant).id;
    b.add(rectangle(1, 1), b.coated(albedo, eta));
    std::vector<double> means;  // each nanometre
    for (int nm = 360; nm <= 830; ++nm) means.push_back(smooth_coat_average(1.8 - 0.4 * (nm - 360) / 470, false));
    expect_mean(
        trace_radiances(*b.freeze()),
        [&](double nm) {
          const double a = 0.1 + 0.8 * (nm - 360) / 470, n = 1.8 - 0.4 * (nm - 360) / 470;
          const double f = coat_fresnel(n, std::cos(glm::radians(degrees)), false);
          const double inside = 1 - (1 - means[size_t(nm - 360)]) / (n * n);
          return f + (1 - f) * a * (1 - inside) / (1 - a * inside);
        },
        0.02);
  }
}

TEST(CoatedMaterial, WhiteBodiesThatSeeEachOtherVanish) {
  SceneBuilder b(16, 16, 256, 400);
  b.light(LightKind::environment, unit_spectrum, 1);
  b.look_at({0, 0, 3}, {0, 0, 0}, perspective(30));
  b.add(sphere(0.6f), b.coated(unit_spectrum, b.constant(1.5)), moved(-0.5, 0, 0));
  b.add(sphere(0.6f), b.coated(unit_spectrum, b.named("SF66"), 0.2f), moved(0.5, 0, 0.3));
  b.add(rectangle(4, 4), b.coated(unit_spectrum, b.constant(1.33), 0.5f), moved(0, -0.6, 0) * turned(-70, 1, 0, 0));
  expect_mean(
      trace_radiances(*b.freeze()), [](double) { return 1.0; }, 0.02);
}

void add_room(SceneBuilder& b) {
  const auto rgb = [&](double red, double green, double blue) {
    return b.scene.spectra.add_rgb({red, green, blue}, RgbKind::albedo).id;
  };
  b.add(rectangle(6, 6), b.diffuse(0.5), moved(0, -1, 0) * turned(-90, 1, 0, 0));
  b.add(sphere(0.5f), b.coated(rgb(0.7, 0.1, 0.1), b.constant(1.5)), moved(-0.6, -0.4, 0));
  b.add(sphere(0.5f), b.coated(rgb(0.1, 0.2, 0.7), b.named("SF66"), 0.2f), moved(0.6, -0.4, 0));
  Material schlick = b.coated(rgb(0.2, 0.6, 0.2), b.constant(1.6), 0.05f);
  schlick.fresnel = FresnelModel::schlick;
  b.add(rectangle(4, 4), schlick, moved(0, 0, -1.2));
  b.look_at({0, 0, 3.7}, {0, 0, 0}, perspective(40));
}

TEST(CoatedMaterial, TheOracleAgreesUnderAnAreaLight) {
  SceneBuilder b(16, 16, 4096, 4);
  add_room(b);
  const Entity lamp = b.add(rectangle(1.5f, 1.5f), b.diffuse(0.0), moved(0, 1.5, 0.5) * turned(90, 1, 0, 0));
  b.emit(lamp, b.named("D65"), 0.01f);
  expect_agreement(*b.freeze(), 4096, 0.02);
}

TEST(CoatedMaterial, TheOracleAgreesUnderASkyAndAPointLight) {
  SceneBuilder b(16, 16, 2048, 4);
  add_room(b);
  b.light(LightKind::environment, b.named("D65"), 0.003f);
  b.light(LightKind::point, b.named("A"), 0.01f, moved(-0.4, 0.9, 1.5));
  expect_agreement(*b.freeze(), 2048, 0.02);
}

// Local leaves the mirror image out, recursive follows it without chance; both light the body directly.
TEST(CoatedMaterial, TheOracleAgreesAtTheOtherLevels) {
  for (const Integrator integrator : {Integrator::local, Integrator::recursive}) {
    SceneBuilder b(16, 16, 2048, 4);
    b.scene.settings.integrator = integrator;
    add_room(b);
    const Entity lamp = b.add(rectangle(1.5f, 1.5f), b.diffuse(0.0), moved(0, 1.5, 0.5) * turned(90, 1, 0, 0));
    b.emit(lamp, b.named("D65"), 0.01f);
    b.light(LightKind::environment, b.named("D65"), 0.003f);
    b.light(LightKind::point, b.named("A"), 0.01f, moved(-0.4, 0.9, 1.5));
    expect_agreement(*b.freeze(), 4096, 0.02);
  }
}

// In light of 1 from everywhere: recursive sees all of it, local all but the mirror image's F.
TEST(CoatedMaterial, LevelsShowTheMirrorImageOrLeaveItOut) {
  for (const double degrees : {0.0, 70.0})
    for (const Integrator integrator : {Integrator::local, Integrator::recursive}) {
      SceneBuilder b = in_even_light(degrees, 512);
      b.scene.settings.integrator = integrator;
      b.add(rectangle(1, 1), b.coated(unit_spectrum, b.constant(1.5)));
      const double mirror = coat_fresnel(1.5, std::cos(glm::radians(degrees)), false);
      SCOPED_TRACE(testing::Message() << degrees << " " << static_cast<int>(integrator));
      expect_mean(
          trace_radiances(*b.freeze()), [&](double) { return integrator == Integrator::local ? 1 - mirror : 1; }, 0.02);
    }
}

// A lamp that is seen in the mirror image, in the lobe and by the body, large and small: sampling lights and sampling
// the BSDF share it without counting any of it twice. Closed form: the lamp fills the hemisphere's cap of half angle w
// around the normal; the body's part is g(1 - F) times the integral of (1 - F(theta)) 2 sin cos / (1 - F_mean).
TEST(CoatedMaterial, ALampIsCountedOnceInMirrorAndBody) {
  for (const double half_angle : {5.0, 30.0, 70.0}) {
    SceneBuilder b(16, 16, half_angle < 10 ? 8192 : 2048, 1);
    const float distance = 100, radius = float(distance * std::tan(glm::radians(half_angle)));
    const Entity lamp = b.add(disk(radius), b.diffuse(0.0), moved(0, 0, distance) * turned(180, 1, 0, 0));
    b.emit(lamp, unit_spectrum, 1);
    b.add(rectangle(1, 1), b.coated(b.constant(0.6), b.constant(1.5)));
    b.look_at({0, 0, 1}, {0, 0, 0}, orthographic(1e-3f), {0, 1, 0});
    const double mean = smooth_coat_average(1.5, false), inside = 1 - (1 - mean) / 2.25;
    double part = 0;
    constexpr int cells = 20000;
    for (int k = 0; k < cells; ++k) {
      const double theta = glm::radians(half_angle) * (k + 0.5) / cells;
      part += (1 - coat_fresnel(1.5, std::cos(theta), false)) * 2 * std::sin(theta) * std::cos(theta);
    }
    part *= glm::radians(half_angle) / cells / (1 - mean);
    const double expected = 0.04 + 0.96 * 0.6 * (1 - inside) / (1 - 0.6 * inside) * part;
    SCOPED_TRACE(half_angle);
    expect_mean(
        trace_radiances(*b.freeze()), [&](double) { return expected; }, half_angle < 10 ? 0.03 : 0.02);
  }
}

struct Built {
  std::unique_ptr<World> world;
  std::string messages;
};
Built build(SceneBuilder& b, const Material& material) {
  const Entity entity = b.add(sphere(1), material);
  b.scene.registry.set(entity, Name{b.scene.names.add("vase")});
  b.look_at({0, 0, 3}, {0, 0, 0}, perspective(30));
  Diagnostics diagnostics;
  Built built{freeze(b.scene, diagnostics), {}};
  built.messages = format_diagnostics(diagnostics);
  return built;
}

TEST(CoatedMaterial, WhatIsNoMaterialIsAnError) {
  SceneBuilder b(4, 4, 1, 1);
  const auto messages = [&](double albedo, double eta, float alpha_x, float alpha_y) {
    Material material = b.coated(b.constant(albedo), b.constant(eta), alpha_x);
    material.alpha_y = alpha_y;
    const Built built = build(b, material);
    EXPECT_EQ(built.world, nullptr);
    return built.messages;
  };
  EXPECT_THAT(messages(0.5, 0, 0, 0), HasSubstr("error: 'vase': 'eta' is not above 0 at every wavelength"));
  EXPECT_THAT(messages(1.2, 1.5, 0, 0), HasSubstr("error: 'vase': 'reflectance' is not from 0 to 1"));
  EXPECT_THAT(messages(-0.2, 1.5, 0, 0), HasSubstr("error: 'vase': 'reflectance' is not from 0 to 1"));
  EXPECT_THAT(messages(0.5, 1.5, -1, -1), HasSubstr("error: 'vase': 'roughness' is not a number of at least 0"));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(messages(0.5, 1.5, nan, nan), HasSubstr("error: 'vase': 'roughness' is not a number of at least 0"));
  EXPECT_THAT(messages(0.5, 1.5, 0.1f, 0.2f), HasSubstr("roughness is the same in every direction"));
}

// Coats that differ in colour only share their table's rows.
TEST(CoatedMaterial, ColoursOfOneCoatShareItsTable) {
  SceneBuilder b(4, 4, 1, 1);
  for (const double albedo : {0.1, 0.5, 0.9}) b.add(sphere(1), b.coated(b.constant(albedo), b.constant(1.5), 0.3f));
  b.add(sphere(1), b.coated(b.constant(0.5), b.constant(1.5), 0.0005f));
  const Built built = build(b, b.coated(b.constant(0.5), b.constant(1.6), 0.3f));
  ASSERT_NE(built.world, nullptr);
  EXPECT_EQ(built.world->rough_coated.eta.size(), 4u);
  EXPECT_EQ(built.world->rough_coated.albedos.size(), 2 * (1 + coat_nodes));
  EXPECT_EQ(built.world->smooth_coated.albedos.size(), 1u);
}

}  // namespace
}  // namespace metamer
