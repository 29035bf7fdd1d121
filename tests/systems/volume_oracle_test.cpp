// Media that fill space against the scalar oracle, which follows each wavelength by its own free paths.
#include "tests/systems/support/agreement.h"

namespace metamer {
namespace {

constexpr uint32_t side = 16;

SpectrumId rgb(SceneBuilder& b, double red, double green, double blue) {
  return b.scene.spectra.add_rgb({red, green, blue}, RgbKind::unbounded).id;
}
Material paint(SceneBuilder& b, double red, double green, double blue) {
  return b.diffuse(b.scene.spectra.add_rgb({red, green, blue}, RgbKind::albedo).id);
}
// Lights keep off the fog: what is scattered close to a small light is noise to the oracle.
void add_room(SceneBuilder& b) {
  b.add(rectangle(6, 6), paint(b, 0.6, 0.5, 0.4), moved(0, -1, 0) * turned(-90, 1, 0, 0));
  b.add(rectangle(6, 6), paint(b, 0.3, 0.5, 0.3), moved(0, 0, -2));
  b.emit(b.add(rectangle(1, 1), b.diffuse(0.2), moved(0.3, 2.5, 0.5) * turned(90, 1, 0, 0)), b.named("D65"), 0.02f);
  b.light(LightKind::directional, b.named("A"), 0.005f, turned(-50, 1, 0.5, 0));
}
Entity glow(SceneBuilder& b, Entity medium, SpectrumId emission, float scale) {
  Medium m = b.scene.registry.get<Medium>(medium);
  m.emission = emission;
  m.emission_scale = scale;
  b.scene.registry.set(medium, m);
  return medium;
}

// The camera in a box of fog, a ball of denser, coloured smoke, a glowing ball, and a hollow.
SceneBuilder fog(Integrator integrator, uint32_t samples) {
  SceneBuilder b(side, side, samples, 5);
  b.scene.settings.integrator = integrator;
  add_room(b);
  const Entity thin = b.medium(rgb(b, 0.02, 0.02, 0.04), rgb(b, 0.1, 0.12, 0.2), 0.3f);
  const Entity smoke = b.medium(rgb(b, 0.5, 0.2, 0.1), rgb(b, 1, 2, 3), 0.6f);
  const Entity flame = glow(b, b.medium(rgb(b, 0.5, 1, 2), rgb(b, 0.5, 0.2, 0.1), -0.3f), b.named("A"), 0.003f);
  b.separate(b.look_at({0, 0.1, 3.7}, {0, 0, 0}, perspective(40)), {}, thin);
  b.scene.meshes.push_back(cube_mesh());
  b.separate(b.add(mesh(0), b.interface(), moved(0, 0, 1.5) * stretched(5, 2.6, 5)), thin);
  b.separate(b.add(sphere(0.6f), b.interface(), moved(-0.6, -0.2, 0)), smoke, thin);
  b.separate(b.add(sphere(0.3f), b.interface(), moved(-0.6, -0.2, 0.1)), {}, smoke);
  b.separate(b.add(mesh(0), b.interface(), moved(0.8, 0, 0) * turned(30, 1, 1, 0) * stretched(1, -0.7, 0.5)), flame,
             thin);
  return b;
}

TEST(VolumeOracle, AgreesOnFogSmokeAndFire) { expect_agreement(*fog(Integrator::path, 2048).freeze(), 1536, 0.04); }
TEST(VolumeOracle, AgreesOnFogForLocalLight) { expect_agreement(*fog(Integrator::local, 512).freeze(), 512, 0.02); }
TEST(VolumeOracle, AgreesOnFogForRecursiveLight) {
  expect_agreement(*fog(Integrator::recursive, 512).freeze(), 512, 0.02);
}

TEST(VolumeOracle, AgreesOnDispersingGlassInColouredFog) {
  SceneBuilder b(side, side, 4096, 6);
  add_room(b);
  b.light(LightKind::environment, b.named("D65"), 0.001f);
  const Entity mist = b.medium(rgb(b, 0.05, 0.1, 0.02), rgb(b, 0.1, 0.4, 0.8), 0.2f);
  const Entity juice = b.medium(rgb(b, 0.2, 1, 2), rgb(b, 1.5, 0.7, 0.3), 0.7f);
  b.scene.meshes.push_back(cube_mesh());
  b.separate(b.add(mesh(0), b.interface(), stretched(3, 1.9, 2)), mist);
  b.separate(b.add(sphere(0.45f), b.dielectric(b.named("SF66")), moved(-0.5, 0, 0.2)), juice, mist);
  b.separate(b.add(sphere(0.4f), b.rough_glass(b.constant(1.4), 0.3f, 0.3f), moved(0.6, -0.2, 0.2)), juice, mist);
  b.look_at({0, 0.1, 3.7}, {0, 0, 0}, perspective(40));
  expect_agreement(*b.freeze(), 3072, 0.04);
}

}  // namespace
}  // namespace metamer
