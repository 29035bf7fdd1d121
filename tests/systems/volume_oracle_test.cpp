// Media that fill space against the scalar oracle, which follows each wavelength by its own free paths.
#include "tests/systems/support/agreement.h"
#include "tests/systems/support/grid_scene.h"

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

// Smoke and a flame from grids, sheared, in coloured fog, the camera in it.
SceneBuilder smoke(Integrator integrator, uint32_t samples) {
  SceneBuilder b(side, side, samples, 5);
  b.scene.settings.integrator = integrator;
  add_room(b);
  const Entity thin = b.medium(rgb(b, 0.02, 0.02, 0.04), rgb(b, 0.1, 0.12, 0.2), 0.3f);
  b.scene.meshes.push_back(cube_mesh());
  b.separate(b.look_at({0, 0.1, 3.7}, {0, 0, 0}, perspective(40)), {}, thin);
  b.separate(b.add(mesh(0), b.interface(), moved(0, 0, 1.5) * stretched(5, 2.6, 5)), thin);
  const glm::ivec3 size(12, 10, 9);
  const auto voxels = voxels_in_box(size, glm::dvec3(-0.5), glm::dvec3(0.5));
  MediumGrid cloud = in_box(glm::vec3(-0.5f), glm::vec3(0.5f));
  cloud.density = add_grid(b, size, voxels, [](int i, int j, int k) { return (i * j + k) % 4; });
  MediumGrid flame = cloud;
  flame.sigma_s = add_grid(b, size, voxels, [](int i, int j, int) { return glm::vec3(i, 6, j) / 6.0f; });
  flame.temperature = add_grid(b, size, voxels, [](int i, int, int k) { return 1000 + 100 * (i + k); });
  flame.blackbody = BlackbodyUnit::peak;
  glm::dmat4 shear(1);
  shear[1][0] = 0.3;
  const glm::dmat4 left = moved(-0.7, -0.1, 0) * turned(20, 0, 1, 0) * shear * stretched(1.2, 1, 1);
  const glm::dmat4 right = moved(0.7, 0.1, 0) * turned(40, 1, 1, 0) * stretched(1, -0.9, 0.8);
  b.separate(b.add(mesh(0), b.interface(), left),
             grid_medium(b, rgb(b, 0.5, 0.2, 0.1), rgb(b, 1, 2, 3), cloud, 0.6f, left), thin);
  const Entity fire = grid_medium(b, rgb(b, 0.2, 0.3, 0.4), unit_spectrum, flame, -0.3f, right);
  Medium medium = b.scene.registry.get<Medium>(fire);
  medium.emission_scale = 0.03f;
  medium.g2 = 0.7f, medium.g2_share = 0.4f;
  b.scene.registry.set(fire, medium);
  b.separate(b.add(mesh(0), b.interface(), right), fire, thin);
  return b;
}

TEST(VolumeOracle, AgreesOnSmokeAndFireFromGrids) {
  expect_agreement(*smoke(Integrator::path, 1024).freeze(), 512, 0.06);
}
TEST(VolumeOracle, AgreesOnGridsForLocalLight) { expect_agreement(*smoke(Integrator::local, 512).freeze(), 256, 0.03); }
TEST(VolumeOracle, AgreesOnGridsForRecursiveLight) {
  expect_agreement(*smoke(Integrator::recursive, 512).freeze(), 256, 0.03);
}

}  // namespace
}  // namespace metamer
