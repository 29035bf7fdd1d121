// The stream pipeline against the scalar oracle on small scenes that together use every material, light, shape,
// camera and filter. What "agree" means is stated in support/agreement.h.
#include "tests/systems/support/agreement.h"

namespace metamer {
namespace {

constexpr uint32_t side = 16;

// A box of 2 m around the origin, open towards the camera at +z, walls of different colours.
void add_walls(SceneBuilder& b) {
  const Geometry wall = rectangle(2, 2);
  const auto rgb = [&](double red, double green, double blue) {
    return b.diffuse(b.scene.spectra.add_rgb({red, green, blue}, RgbKind::albedo).id);
  };
  b.add(wall, rgb(0.7, 0.7, 0.7), moved(0, -1, 0) * turned(-90, 1, 0, 0));
  b.add(wall, rgb(0.7, 0.7, 0.7), moved(0, 1, 0) * turned(90, 1, 0, 0));
  b.add(wall, rgb(0.7, 0.7, 0.7), moved(0, 0, -1));
  b.add(wall, rgb(0.6, 0.1, 0.1), moved(-1, 0, 0) * turned(90, 0, 1, 0));
  b.add(wall, rgb(0.1, 0.5, 0.1), moved(1, 0, 0) * turned(-90, 0, 1, 0));
}
void add_lamp(SceneBuilder& b, double height = 0.98) {
  const Entity lamp = b.add(rectangle(0.8f, 0.8f), b.diffuse(0.0), moved(0, height, 0) * turned(90, 1, 0, 0));
  b.emit(lamp, b.named("D65"), 0.01f);
}
void add_floor(SceneBuilder& b, double reflectance = 0.5) {
  b.add(rectangle(6, 6), b.diffuse(reflectance), moved(0, -1, 0) * turned(-90, 1, 0, 0));
}
void look(SceneBuilder& b, Camera camera = perspective(40), const glm::dvec3& from = {0, 0, 3.7}) {
  b.look_at(from, {0, 0, 0}, camera);
}

TEST(Oracle, AgreesOnADiffuseBoxWithAnAreaLight) {
  SceneBuilder b(side, side, 2048, 6);
  add_walls(b);
  add_lamp(b);
  look(b);
  expect_agreement(*b.freeze(), 3072, 0.02);
}

TEST(Oracle, AgreesOnASphereLightOverRoughGold) {
  SceneBuilder b(side, side, 2048, 4);
  add_floor(b);
  b.add(sphere(0.7f), b.conductor(b.named("Au.n"), b.named("Au.k"), 0.3f, 0.3f), moved(0, -0.3, 0));
  b.emit(b.add(sphere(0.3f), b.diffuse(0.2), moved(1, 1.2, 0.8)), b.named("A"), 0.01f);
  look(b);
  expect_agreement(*b.freeze(), 8192, 0.02);
}

TEST(Oracle, AgreesOnAnisotropicMetalOfAMirroredInstancedMesh) {
  SceneBuilder b(side, side, 4096, 4);
  Mesh cube = cube_mesh();
  for (const glm::vec3 p : cube.positions) {
    cube.normals.push_back(glm::normalize(p));
    cube.uvs.push_back({p.x + 0.3f * p.z, p.y - 0.2f * p.z});
  }
  b.scene.meshes.push_back(cube);
  const Material metal = b.conductor(b.named("Cu.n"), b.named("Cu.k"), 0.15f, 0.5f);
  b.add(mesh(0), metal, moved(-0.6, -0.2, 0) * turned(30, 1, 1, 0));
  b.add(mesh(0), metal, moved(0.7, 0.1, 0) * turned(20, 0, 1, 1) * stretched(-1, 1.3, 0.8));
  add_floor(b);
  add_lamp(b, 2);
  look(b);
  expect_agreement(*b.freeze(), 8192, 0.03);
}

TEST(Oracle, AgreesOnBothFormsOfRoughMatter) {
  SceneBuilder b(side, side, 4096, 4);
  const auto rgb = [&](double red, double green, double blue) {
    return b.scene.spectra.add_rgb({red, green, blue}, RgbKind::albedo).id;
  };
  add_floor(b);
  b.add(sphere(0.6f), b.rough(rgb(0.2, 0.05, 0.05), b.constant(0.4), 20, false), moved(-0.6, -0.4, 0));
  b.add(sphere(0.6f), b.rough(rgb(0.1, 0.1, 0.5), b.constant(0.3), 50, true), moved(0.7, -0.4, 0));
  b.add(rectangle(4, 4), b.rough(b.constant(0), rgb(0.1, 0.3, 0.1), 2, false), moved(0, 0, -1.5));
  add_lamp(b, 2);
  b.light(LightKind::environment, b.named("D65"), 0.002f);
  b.light(LightKind::point, b.named("A"), 0.01f, moved(-0.4, 0.9, 1.5));
  look(b);
  expect_agreement(*b.freeze(), 4096, 0.02);
}

TEST(Oracle, AgreesOnASilverMirrorUnderAPointLight) {
  SceneBuilder b(side, side, 1024, 5);
  add_walls(b);
  b.add(sphere(0.6f), b.conductor(b.named("Ag.n"), b.named("Ag.k")), moved(0.2, -0.4, 0));
  b.light(LightKind::point, b.named("D50"), 0.01f, moved(-0.4, 0.6, 0.5));
  look(b);
  expect_agreement(*b.freeze(), 1024, 0.02);
}

TEST(Oracle, AgreesOnDispersingGlass) {
  SceneBuilder b(side, side, 4096, 6);
  add_walls(b);
  b.add(sphere(0.6f), b.dielectric(b.named("SF66")), moved(0.1, -0.3, 0.2));
  add_lamp(b);
  look(b);
  expect_agreement(*b.freeze(), 1536, 0.03);
}

TEST(Oracle, AgreesOnMirroredInstancesOfFlatGlass) {
  SceneBuilder b(side, side, 2048, 6);
  b.scene.meshes.push_back(cube_mesh());
  const Material glass = b.dielectric(b.constant(1.5));
  b.add(mesh(0), glass, moved(-0.6, -0.3, 0) * turned(30, 0.2, 1, 0));
  b.add(mesh(0), glass, moved(0.6, -0.3, 0.1) * turned(20, 0.1, 1, 0.3) * stretched(1, -1, 1));
  b.add(rectangle(4, 4), b.diffuse(b.named("colorchecker.orange")), moved(0, 0, -1.5));
  add_floor(b);
  b.light(LightKind::environment, b.named("D65"), 0.01f);
  look(b);
  expect_agreement(*b.freeze(), 512, 0.02);
}

// A glass of water with an ice cube that looks out of it, each solid overlapping its neighbour, over a floor.
TEST(Oracle, AgreesOnNestedAbsorbingMedia) {
  SceneBuilder b(side, side, 4096, 9);
  add_walls(b);
  b.scene.meshes.push_back(cube_mesh());
  b.add(mesh(0), b.smooth(b.constant(1.5), b.constant(2e-8), 3), moved(0, -0.7, 0) * stretched(1.2, 0.3, 1.2));
  b.add(mesh(0), b.smooth(b.constant(1.33), b.constant(8e-8), 1),
        moved(0, -0.4, 0) * turned(10, 0, 1, 0) * stretched(0.9, 0.7, 0.9));
  b.add(sphere(0.3f), b.smooth(b.constant(1.31), zero_spectrum, 2), moved(0.1, -0.1, 0.2));
  b.add(sphere(0.2f), b.diffuse(0.8), moved(-0.15, -0.35, 0.1));
  add_lamp(b);
  look(b);
  expect_agreement(*b.freeze(), 2048, 0.03);
}

TEST(Oracle, AgreesUnderAnOpenWaterSurface) {
  SceneBuilder b(side, side, 4096, 6);
  add_walls(b);
  b.add(rectangle(20, 20), b.smooth(b.named("water"), b.constant(5e-8)), moved(0, 0.3, 0) * turned(-90, 1, 0, 0));
  b.add(sphere(0.4f), b.conductor(b.named("Cu.n"), b.named("Cu.k"), 0.3f, 0.3f), moved(0.2, -0.5, 0));
  b.emit(b.add(sphere(0.2f), b.diffuse(0.2), moved(-0.5, -0.6, 0.5)), b.named("A"), 0.01f);
  b.light(LightKind::environment, b.named("D65"), 0.01f);
  look(b, perspective(40), {0, -0.2, 3.7});
  expect_agreement(*b.freeze(), 2048, 0.03);
}

TEST(Oracle, AgreesOnRoughGlassBetweenLampAndFloor) {
  SceneBuilder b(side, side, 4096, 6);
  add_walls(b);
  b.add(sphere(0.5f), b.rough_glass(b.named("SF66"), 0.4f, 0.4f), moved(-0.3, -0.4, 0.2));
  b.scene.meshes.push_back(cube_mesh());
  b.add(mesh(0), b.rough_glass(b.constant(1.5), 0.3f, 0.3f),
        moved(0.5, -0.3, 0) * turned(30, 1, 1, 0) * stretched(0.5, 0.5, 0.5));
  add_lamp(b);
  b.light(LightKind::environment, b.named("D65"), 0.003f);
  look(b);
  expect_agreement(*b.freeze(), 4096, 0.03);
}

TEST(Oracle, AgreesOnRoughGlassThatAbsorbs) {
  SceneBuilder b(side, side, 4096, 6);
  add_walls(b);
  Material frosted = b.rough_glass(b.constant(1.5), 0.3f, 0.6f);
  frosted.kappa = b.constant(1e-7);
  frosted.priority = 2;
  b.add(sphere(0.7f), frosted, moved(0, -0.2, 0));
  b.emit(b.add(sphere(0.2f), b.diffuse(0.2), moved(0, -0.1, 0)), b.named("A"), 0.004f);  // inside
  add_lamp(b);
  look(b);
  expect_agreement(*b.freeze(), 4096, 0.03);
}

TEST(Oracle, AgreesOnThinPanesAndPartlyOpaqueMatter) {
  SceneBuilder b(side, side, 4096, 6);
  add_walls(b);
  const std::vector<double> nm = {520, 560}, kappa = {0, 2};
  b.add(sphere(0.5f), b.smooth(b.constant(1.6), b.scene.spectra.add_table(nm, kappa, Extend::constant).id),
        moved(-0.4, -0.4, 0));
  b.add(rectangle(1, 1), b.thin(b.named("SF66"), b.constant(2e-5), 0.002f),
        moved(0.5, -0.3, 0.3) * turned(40, 0, 1, 0));
  b.add(sphere(0.3f), b.smooth(b.constant(1e-3), b.constant(50)), moved(0.4, -0.7, -0.2));
  add_lamp(b);
  look(b);
  expect_agreement(*b.freeze(), 1536, 0.03);
}

TEST(Oracle, AgreesOnADirectionalLightBesideAPointLight) {
  SceneBuilder b(side, side, 1024, 3);
  b.add(sphere(0.8f), b.diffuse(0.6));
  b.light(LightKind::directional, b.named("D65"), 0.01f, turned(-50, 1, 0.3, 0));
  b.light(LightKind::point, b.named("A"), 0.02f, moved(-1.5, 0.5, 1.5));
  look(b);
  expect_agreement(*b.freeze(), 2048, 0.02);
}

TEST(Oracle, AgreesOnASpotBesideLampsOfACosinePower) {
  SceneBuilder b(side, side, 2048, 4);
  add_walls(b);
  b.add(sphere(0.5f), b.conductor(b.named("Au.n"), b.named("Au.k"), 0.5f, 0.5f), moved(0.3, -0.4, 0));
  Light light;
  light.kind = LightKind::spot;
  light.spectrum = b.named("A");
  light.scale = 0.01f;
  light.cone_deg = 35;
  light.falloff_deg = 15;
  b.scene.registry.set(b.place(moved(-0.4, 0.9, 0.6) * turned(-60, 1, 0.3, 0)), light);
  Light lamp;
  lamp.spectrum = b.named("D65");
  lamp.scale = 0.01f;
  lamp.cosine_power = 4;
  b.scene.registry.set(b.add(disk(0.3f), b.diffuse(0.0), moved(0, 0.95, 0) * turned(90, 1, 0, 0)), lamp);
  b.scene.registry.set(b.add(sphere(0.2f), b.diffuse(0.0), moved(-0.6, -0.3, 0.2)), lamp);
  look(b);
  expect_agreement(*b.freeze(), 3072, 0.04);
}

TEST(Oracle, AgreesOnADiscAtInfinityBesideTheSky) {
  SceneBuilder b(side, side, 2048, 4);
  add_floor(b);
  b.add(sphere(0.6f), b.dielectric(b.constant(1.5)), moved(-0.5, -0.3, 0));
  b.add(sphere(0.5f), b.conductor(b.named("Au.n"), b.named("Au.k"), 0.3f, 0.3f), moved(0.6, -0.4, 0));
  Light sun;
  sun.kind = LightKind::directional;
  sun.spectrum = b.named("D50");
  sun.scale = 0.01f;
  sun.angular_diameter_deg = 40;
  b.scene.registry.set(b.place(turned(-60, 1, 0.4, 0)), sun);
  b.light(LightKind::environment, b.named("D65"), 0.003f);
  look(b);
  expect_agreement(*b.freeze(), 2048, 0.03);
}

TEST(Oracle, AgreesUnderAConstantSkyThroughAGaussianFilter) {
  SceneBuilder b(side, side, 256, 5);
  b.scene.settings.filter = {FilterKind::gaussian, 1.5f, 1.0f, 0.5f};
  add_floor(b);
  b.add(sphere(0.6f), b.diffuse(b.named("colorchecker.blue")), moved(-0.5, -0.4, 0));
  b.add(disk(0.7f, 0.3f), b.conductor(b.named("Al.n"), b.named("Al.k"), 0.2f, 0.2f),
        moved(0.7, 0, 0) * turned(-30, 1, 0, 0));
  b.light(LightKind::environment, b.named("D65"), 0.01f);
  look(b);
  expect_agreement(*b.freeze(), 512, 0.02);
}

// A smooth gradient with a warm and a blue side, brighter towards the top row.
Image sky(ImageMapping mapping) {
  Image image;
  image.mapping = mapping;
  image.width = mapping == ImageMapping::equal_area ? 16 : 32;
  image.height = 16;
  for (uint32_t y = 0; y < image.height; ++y)
    for (uint32_t x = 0; x < image.width; ++x) {
      const float up = 1 - float(y) / float(image.height), along = float(x) / float(image.width);
      for (const float v : {0.2f + up * along, 0.3f + up * up, 0.2f + up * (1 - along)}) image.rgb.push_back(v);
    }
  return image;
}

TEST(Oracle, AgreesUnderALatitudeLongitudeImage) {
  SceneBuilder b(side, side, 512, 4);
  add_floor(b);
  b.add(sphere(0.7f), b.conductor(b.named("Ti.n"), b.named("Ti.k"), 0.25f, 0.25f));
  b.environment(sky(ImageMapping::latitude_longitude), 1, turned(40, 1, 0.5, 0.2));
  look(b);
  expect_agreement(*b.freeze(), 512, 0.02);
}

TEST(Oracle, AgreesUnderAnEqualAreaImageBesideAnAreaLight) {
  SceneBuilder b(side, side, 512, 4);
  add_floor(b);
  b.add(sphere(0.7f), b.diffuse(0.7));
  b.environment(sky(ImageMapping::equal_area), 1, turned(-70, 0.3, 0.5, 1) * stretched(-1, 1, 1));
  add_lamp(b, 1.5);
  look(b);
  expect_agreement(*b.freeze(), 512, 0.02);
}

// A goniometric light, a projection, a sky and another that enters by a portal, over a ball of glass: all of them in
// colour, on surfaces that see them at their sharp edges.
TEST(Oracle, AgreesOnImagesOfAllLightsAndAPortal) {
  for (const Integrator integrator : {Integrator::path, Integrator::recursive}) {
    SceneBuilder b(side, side, 2048, 4);
    b.scene.settings.integrator = integrator;
    add_floor(b);
    b.add(sphere(0.6f), b.dielectric(b.constant(1.5)), moved(0.5, -0.4, 0.2));
    b.add(sphere(0.5f), b.diffuse(0.7), moved(-0.8, -0.5, 0));
    const Entity window = b.environment(sky(ImageMapping::equal_area), 2, turned(-70, 0.3, 0.5, 1));
    Light portal = b.scene.registry.get<Light>(window);
    portal.has_portal = 1;
    portal.portal_corner = {-1.5, 1, -1.2};
    portal.portal_x = {0, 0, 1.4f};
    portal.portal_y = {2, 0.4f, 0};
    b.scene.registry.set(window, portal);
    b.environment(sky(ImageMapping::latitude_longitude), 0.1f, turned(40, 1, 0.5, 0.2));
    for (const LightKind kind : {LightKind::goniometric, LightKind::projection}) {
      b.scene.images.push_back(
          sky(kind == LightKind::goniometric ? ImageMapping::equal_area : ImageMapping::latitude_longitude));
      Light light;
      light.kind = kind;
      light.spectrum = b.named("D65");
      light.scale = 0.01f;
      light.fov_deg = 40;
      light.image = static_cast<ImageId>(b.scene.images.size() - 1);
      b.scene.registry.set(b.place(moved(kind == LightKind::projection ? 1.2 : -1, 1.5, 1.3) *
                                   turned(kind == LightKind::projection ? 130 : 30, 1, 0.3, 0)),
                           light);
    }
    look(b);
    expect_agreement(*b.freeze(), 2048, 0.02);
  }
}

TEST(Oracle, AgreesOnTwoSidedDiskAndStretchedSphereLights) {
  SceneBuilder b(side, side, 2048, 4);
  add_walls(b);
  b.emit(b.add(disk(0.4f, 0.15f), b.diffuse(0.3), moved(-0.4, 0.2, 0) * turned(60, 0.2, 1, 0) * stretched(1, 1.5, 1)),
         b.named("D65"), 0.01f, true);
  b.emit(b.add(sphere(0.2f), b.diffuse(0.3), moved(0.5, -0.2, 0.1) * turned(40, 1, 1, 0) * stretched(0.5, 2, 1)),
         b.named("A"), 0.01f);
  look(b);
  expect_agreement(*b.freeze(), 1024, 0.02);
}

TEST(Oracle, AgreesInsideASphereThatEmitsInwards) {
  SceneBuilder b(side, side, 2048, 4);
  Geometry shell = sphere(3);
  shell.flip_normal = 1;
  b.emit(b.add(shell, b.diffuse(0.2)), b.named("D65"), 0.01f);
  b.add(sphere(0.7f), b.conductor(b.named("Ag.n"), b.named("Ag.k"), 0.4f, 0.2f));
  b.add(disk(1.2f), b.diffuse(0.6), moved(0, -0.7, 0) * turned(-90, 1, 0, 0));
  look(b, perspective(40), {0, 0.3, 2.7});
  expect_agreement(*b.freeze(), 2048, 0.02);
}

TEST(Oracle, AgreesThroughAThinLensAndATriangleFilter) {
  SceneBuilder b(side, side, 2048, 4);
  b.scene.settings.filter = {FilterKind::triangle, 1.0f, 2.0f, 0.5f};
  add_walls(b);
  add_lamp(b);
  b.add(sphere(0.4f), b.diffuse(0.1), moved(0.3, -0.5, 0.4));
  Camera camera = perspective(40);
  camera.lens_radius = 0.15f;
  camera.focal_distance = 3.0f;
  look(b, camera);
  expect_agreement(*b.freeze(), 4096, 0.025);
}

TEST(Oracle, AgreesOnAnOrthographicViewOfSchlickMaterials) {
  SceneBuilder b(side, side, 1024, 5);
  add_floor(b);
  Material metal = b.conductor(b.named("Au.n"), b.named("Au.k"), 0.3f, 0.3f);
  metal.fresnel = FresnelModel::schlick;
  Material glass = b.dielectric(b.named("BK7"));
  glass.fresnel = FresnelModel::schlick;
  b.add(sphere(0.5f), metal, moved(-0.5, 0, 0));
  b.add(sphere(0.5f), glass, moved(0.5, 0, 0));
  b.light(LightKind::environment, b.named("A"), 0.01f);
  look(b, orthographic(2.4f));
  expect_agreement(*b.freeze(), 1024, 0.02);
}

}  // namespace
}  // namespace metamer
