// The three levels of light transport against the scalar oracle, with and without shadows. What "agree" means is stated
// in support/agreement.h.
#include "tests/systems/support/agreement.h"

namespace metamer {
namespace {

constexpr uint32_t side = 16;

// A room with a mirror ball, a dispersing ball and rough things under all kinds of lights.
SceneBuilder room(Integrator integrator, uint32_t samples, bool shadows) {
  SceneBuilder b(side, side, samples, 6);
  b.scene.settings.integrator = integrator;
  b.scene.settings.shadows = shadows;
  const auto rgb = [&](double red, double green, double blue) {
    return b.diffuse(b.scene.spectra.add_rgb({red, green, blue}, RgbKind::albedo).id);
  };
  b.add(rectangle(4, 4), rgb(0.5, 0.5, 0.5), moved(0, -1, 0) * turned(-90, 1, 0, 0));
  b.add(rectangle(4, 4), rgb(0.3, 0.6, 0.3), moved(0, 0, -1.2));
  b.add(rectangle(4, 4), rgb(0.6, 0.2, 0.1), moved(-1.3, 0, 0) * turned(90, 0, 1, 0));
  b.add(sphere(0.5f), b.conductor(b.named("Ag.n"), b.named("Ag.k")), moved(-0.6, -0.5, -0.3));
  b.add(sphere(0.45f), b.dielectric(b.named("SF11")), moved(0.5, -0.5, 0.4));
  b.add(sphere(0.3f), b.conductor(b.named("Au.n"), b.named("Au.k"), 0.4f, 0.4f), moved(0.7, 0.3, -0.6));
  b.add(sphere(0.25f), b.rough(b.constant(0.1), b.constant(0.3), 20, false), moved(-0.3, 0.5, 0));
  b.add(sphere(0.25f), b.coated(b.constant(0.4), b.constant(1.5)), moved(0.1, 0.7, -0.5));
  b.emit(b.add(rectangle(0.8f, 0.8f), b.diffuse(0.2), moved(0.2, 1.4, 0) * turned(90, 1, 0, 0)), b.named("D65"), 0.01f);
  b.light(LightKind::point, b.named("A"), 0.01f, moved(-0.5, 0.9, 1));
  b.light(LightKind::directional, b.named("D50"), 0.005f, turned(-60, 1, 0.5, 0));
  b.light(LightKind::environment, b.named("D65"), 0.002f);
  Light spot;
  spot.kind = LightKind::spot;
  spot.spectrum = b.named("FL2");
  spot.scale = 0.01f;
  spot.falloff_deg = 10;
  b.scene.registry.set(b.place(moved(1, 1, 1) * turned(-50, 1, -0.5, 0)), spot);
  Light sun;
  sun.kind = LightKind::directional;
  sun.spectrum = b.named("D50");
  sun.scale = 0.005f;
  sun.angular_diameter_deg = 20;
  b.scene.registry.set(b.place(turned(-40, 1, 1, 0)), sun);
  b.look_at({0.2, 0.3, 3.5}, {0, -0.1, 0}, perspective(42));
  return b;
}

TEST(LevelOracle, AgreesOnLocalLight) { expect_agreement(*room(Integrator::local, 512, true).freeze(), 512, 0.02); }
TEST(LevelOracle, AgreesOnLocalLightWithoutShadows) {
  expect_agreement(*room(Integrator::local, 1024, false).freeze(), 1024, 0.02);
}
TEST(LevelOracle, AgreesOnRecursiveLight) {
  expect_agreement(*room(Integrator::recursive, 512, true).freeze(), 256, 0.02);
}
TEST(LevelOracle, AgreesOnRecursiveLightWithoutShadows) {
  expect_agreement(*room(Integrator::recursive, 512, false).freeze(), 512, 0.02);
}
TEST(LevelOracle, AgreesOnPathsWithoutShadows) {
  expect_agreement(*room(Integrator::path, 2048, false).freeze(), 1024, 0.03);
}

}  // namespace
}  // namespace metamer
