// What a correct file becomes.
#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scenes/native/read_native.h"
#include "scenes/read_scene.h"
#include "tests/scenes/support/files.h"

namespace metamer {
namespace {

struct NativeResult {
  bool ok = false;
  Scene scene;
  Diagnostics diagnostics;
  std::string messages() const { return format_diagnostics(diagnostics); }

  Entity find(std::string_view name) const {
    Entity found;
    scene.registry.each<Name>([&](Entity entity, uint32_t row) {
      if (scene.names[scene.registry.table<Name>().get(row).name] == name) found = entity;
    });
    return found;
  }
  template <class C>
  C get(std::string_view name) const {
    EXPECT_TRUE(scene.registry.has<C>(find(name))) << name;
    return scene.registry.get<C>(find(name));
  }
};

NativeResult read(const std::string& text) {
  NativeResult result;
  const TemporaryFile file("scene.json", text);
  result.ok = read_native(file.path(), result.scene, result.diagnostics);
  return result;
}

NativeResult read_entities(const std::string& entities) {
  return read("{\"metamer\": 1, \"entities\": [" + entities + "]}");
}

// Where the transform takes a point of local space, without parents.
glm::vec3 apply(const Transform& t, const glm::vec3& p) {
  const glm::vec4 q(p, 1);
  return {glm::dot(t.row0, q), glm::dot(t.row1, q), glm::dot(t.row2, q)};
}

void expect_near(const glm::vec3& a, const glm::vec3& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-5) << i;
}

const std::string every_key = METAMER_SOURCE_DIR "/tests/scenes/native/every_key.json";

TEST(Native, ReadsEveryKey) {
  NativeResult r;
  ASSERT_TRUE(read_scene(every_key, r.scene, r.diagnostics)) << r.messages();
  EXPECT_TRUE(r.diagnostics.all().empty()) << r.messages();
  const RenderSettings& s = r.scene.settings;
  EXPECT_EQ(s.width, 320u);
  EXPECT_EQ(s.height, 200u);
  EXPECT_EQ(s.samples_per_pixel, 16u);
  EXPECT_EQ(s.max_depth, 5u);
  EXPECT_EQ(s.seed, 7u);
  EXPECT_EQ(s.integrator, Integrator::recursive);
  EXPECT_FALSE(s.shadows);
  EXPECT_EQ(s.filter.kind, FilterKind::gaussian);
  EXPECT_EQ(s.filter.radius_x, 2);
  EXPECT_EQ(s.filter.radius_y, 1.5f);
  EXPECT_EQ(s.filter.sigma, 0.6f);
  EXPECT_EQ(s.exposure_stops, 1.5f);
  EXPECT_EQ(s.sensor_scale, 2);
  EXPECT_EQ(s.band_count, 18u);
  EXPECT_EQ(s.color, ColorMode::spectral);
  EXPECT_EQ(r.scene.meshes.size(), 2u);
  EXPECT_EQ(r.scene.registry.table<Light>().size(), 17u);
  EXPECT_EQ(r.scene.registry.table<Material>().size(), 26u);

  const auto camera = r.get<Camera>("eye");
  EXPECT_EQ(camera.fov_deg, 40);
  EXPECT_FLOAT_EQ(camera.lens_radius, 0.02f);
  EXPECT_FLOAT_EQ(camera.focal_distance, 3);
  EXPECT_EQ(camera.screen_window, glm::vec4(-1, 1, -0.5f, 0.5f));
  EXPECT_EQ(r.get<Camera>("plan").kind, CameraKind::orthographic);
  EXPECT_FLOAT_EQ(r.get<Camera>("plan").screen_height, 2.5f);

  EXPECT_EQ(r.get<Parent>("ball").entity, r.find("table"));
  EXPECT_FLOAT_EQ(r.get<Geometry>("ball").radius, 0.1f);
  EXPECT_EQ(r.get<Geometry>("table").flip_normal, 1u);
  EXPECT_EQ(r.get<MaterialSlot>("table").material, r.find("red"));
  EXPECT_EQ(r.get<Visibility>("table").mask, visible_to_camera | visible_to_bounces);
  EXPECT_EQ(r.get<Material>("brushed").fresnel, FresnelModel::schlick);
  EXPECT_EQ(r.get<Material>("brushed").alpha_x, 0.3f);
  EXPECT_EQ(r.get<Material>("brushed").alpha_y, 0.1f);
  const auto plastic = r.get<Material>("plastic");
  EXPECT_EQ(plastic.kind, MaterialKind::rough);
  EXPECT_NEAR(r.scene.spectra.value(plastic.kd, 550), 0.1, 1e-7);
  EXPECT_NEAR(r.scene.spectra.value(plastic.ks, 550), 0.5, 1e-7);
  EXPECT_EQ(plastic.shininess, 40);
  EXPECT_EQ(plastic.normalized, 0u);
  const Material lacquered = r.get<Material>("lacquered"), varnished = r.get<Material>("varnished");
  EXPECT_EQ(lacquered.kind, MaterialKind::coated);
  EXPECT_NEAR(r.scene.spectra.value(lacquered.reflectance, 550), 0.25, 1e-7);
  EXPECT_NEAR(r.scene.spectra.value(lacquered.eta, 550), 1.5, 1e-7);
  EXPECT_EQ(lacquered.alpha_x, 0.05f);
  EXPECT_EQ(lacquered.alpha_y, 0.05f);
  EXPECT_EQ(varnished.alpha_x, 0);
  EXPECT_FALSE(r.scene.spectra.is_constant(varnished.eta));
  EXPECT_EQ(r.get<Material>("made").alpha_y, 0.2f);
  EXPECT_NEAR(r.scene.spectra.value(r.get<Material>("ice").eta, 550), 1.31, 1e-6);
  EXPECT_NEAR(r.scene.spectra.value(r.get<Material>("ball").reflectance, 500), 0.35, 1e-6);
  EXPECT_EQ(r.scene.location(r.find("ball")).line, 375u);

  const auto bowl = r.get<Geometry>("bowl"), pipe = r.get<Geometry>("pipe"), lock = r.get<Geometry>("lock");
  EXPECT_EQ(bowl.kind, ShapeKind::sphere);
  EXPECT_FLOAT_EQ(bowl.z_min, -0.1f);
  EXPECT_FLOAT_EQ(bowl.z_max, 0.04f);
  EXPECT_EQ(bowl.phi_max_deg, 270);
  EXPECT_EQ(r.get<Geometry>("ball").phi_max_deg, 360);
  EXPECT_EQ(r.get<Geometry>("sector").phi_max_deg, 90);
  EXPECT_EQ(pipe.kind, ShapeKind::cylinder);
  EXPECT_FLOAT_EQ(pipe.radius, 0.02f);
  EXPECT_FLOAT_EQ(pipe.z_min, 0.01f);
  EXPECT_FLOAT_EQ(pipe.z_max, 0.05f);
  EXPECT_EQ(pipe.phi_max_deg, 180);
  EXPECT_EQ(lock.kind, ShapeKind::ribbons);
  EXPECT_EQ(lock.flip_normal, 1u);
  ASSERT_EQ(r.scene.curves.size(), 1u);
  const Curves& strands = r.scene.curves[lock.curves];
  EXPECT_EQ(strands.points[3], glm::vec4(0.03f, 0.01f, 0, 0.0015f)) << "half of the width, in metres";
  EXPECT_EQ(strands.segments[1], 3u);
  EXPECT_EQ(strands.normals[6], glm::vec3(0, 0, 1));
}

TEST(Native, ReadsMediaAndWhereTheyAre) {
  NativeResult r;
  ASSERT_TRUE(read_scene(every_key, r.scene, r.diagnostics));
  const MediumSlot cloud = r.get<MediumSlot>("cloud"), eye = r.get<MediumSlot>("foggy eye");
  EXPECT_EQ(r.get<Material>("cloud").kind, MaterialKind::interface);
  EXPECT_EQ(eye.outside, cloud.outside);
  EXPECT_TRUE(eye.inside.is_null());
  const Medium smoke = r.scene.registry.get<Medium>(cloud.inside), haze = r.scene.registry.get<Medium>(cloud.outside);
  EXPECT_NEAR(r.scene.spectra.value(haze.sigma_s, 550), 0.01, 1e-7);
  EXPECT_EQ(haze.sigma_a, zero_spectrum);
  EXPECT_EQ(haze.emission, zero_spectrum);
  EXPECT_EQ(haze.g, 0);
  EXPECT_NEAR(smoke.scale, 50, 1e-4);  // 0.5 per centimetre
  EXPECT_EQ(smoke.g, 0.6f);
  EXPECT_GT(r.scene.spectra.value(smoke.sigma_a, 450), r.scene.spectra.value(smoke.sigma_a, 650));
  EXPECT_NEAR(r.scene.spectra.value(smoke.emission, 550),
              r.scene.spectra.value(r.scene.spectra.add_blackbody(1500).id, 550), 1e-9);
  EXPECT_EQ(smoke.emission_scale, 3.0f);
  EXPECT_EQ(r.scene.describe(cloud.inside), "'smoke'");
  EXPECT_NE(r.scene.location(cloud.inside).line, 0u);
}

TEST(Native, AppliesOperationsFirstToLastAndUnits) {
  NativeResult r;
  ASSERT_TRUE(read_scene(every_key, r.scene, r.diagnostics));
  // (1, 0, 0) scaled to (2, 0, 0), turned about x, up by 50 cm, then by (10, 20, 30) cm.
  expect_near(apply(r.get<Transform>("table"), {1, 0, 0}), {2.1f, 0.7f, 0.3f});
  // (0, 1, 0) to (0, 2, 0), turned by -90 degrees about x to (0, 0, -2).
  expect_near(apply(r.get<Transform>("table"), {0, 1, 0}), {0.1f, 0.7f, -1.7f});
  EXPECT_EQ(r.scene.meshes[0].positions[1], glm::vec3(0.01f, 0, 0));
}

TEST(Native, RotationsByQuarterTurnsAreExact) {
  for (const auto& [degrees, x, y] :
       {std::tuple{90, 0.f, 1.f}, {180, -1.f, 0.f}, {270, 0.f, -1.f}, {-90, 0.f, -1.f}, {3600000, 1.f, 0.f}}) {
    const auto r = read_entities(
        "{\"name\":\"e\",\"transform\":{\"rotate\":{\"axis\":[0,0,5],\"degrees\":" + std::to_string(degrees) + "}}}");
    ASSERT_TRUE(r.ok) << r.messages();
    EXPECT_EQ(apply(r.get<Transform>("e"), {1, 0, 0}), glm::vec3(x, y, 0)) << degrees;
  }
  const auto r = read_entities("{\"name\":\"e\",\"transform\":{\"rotate\":{\"axis\":[0,1,0],\"degrees\":30}}}");
  expect_near(apply(r.get<Transform>("e"), {0, 0, 1}), {0.5f, 0, std::sqrt(3.f) / 2});
}

TEST(Native, CamerasLookAlongMinusZOfTheFile) {
  const auto r = read_entities(
      "{\"name\":\"a\",\"camera\":{\"type\":\"perspective\"}},"
      "{\"name\":\"b\",\"camera\":{\"type\":\"perspective\"},\"transform\":{\"look_at\":{\"from\":[1,2,3],\"to\":[11,2,"
      "3]}}}");
  ASSERT_TRUE(r.ok) << r.messages();
  // The component's camera looks along +z, with +x to the right of the picture.
  expect_near(apply(r.get<Transform>("a"), {0, 0, 1}), {0, 0, -1});
  expect_near(apply(r.get<Transform>("a"), {1, 0, 0}), {1, 0, 0});
  expect_near(apply(r.get<Transform>("b"), {0, 0, 10}), {11, 2, 3});
  expect_near(apply(r.get<Transform>("b"), {0, 1, 0}), {1, 3, 3});
  expect_near(apply(r.get<Transform>("b"), {1, 0, 0}), {1, 2, 4});  // facing +x with y up, right is +z
}

TEST(Native, ChildrenOfACameraAreNotMirrored) {
  const auto r = read_entities(
      "{\"name\":\"eye\",\"camera\":{\"type\":\"perspective\"},\"transform\":{\"translate\":[0,0,5]}},"
      "{\"name\":\"lamp\",\"parent\":\"eye\",\"light\":{\"type\":\"point\",\"candela\":1},\"transform\":{\"translate\":"
      "[1,2,-3]}}");
  ASSERT_TRUE(r.ok) << r.messages();
  expect_near(apply(r.get<Transform>("eye"), apply(r.get<Transform>("lamp"), {0, 0, 0})), {1, 2, 2});
}

TEST(Native, PhotometricBrightnessSetsTheLuminance) {
  NativeResult r;
  ASSERT_TRUE(read_scene(every_key, r.scene, r.diagnostics));
  std::vector<double> luminances;
  const auto& lights = r.scene.registry.table<Light>();
  for (uint32_t row = 0; row < lights.size(); ++row) {
    const Light light = lights.get(row);
    luminances.push_back(light.scale * r.scene.spectra.luminance(light.spectrum));
  }
  EXPECT_NEAR(luminances[1], 1000, 1e-2);                          // luminance, cd/m^2
  EXPECT_NEAR(luminances[3], 20, 1e-4);                            // candela
  EXPECT_NEAR(luminances[4], 800 / (4 * std::numbers::pi), 1e-3);  // lumens into the whole sphere
  EXPECT_NEAR(luminances[6], 50000, 1);                            // lux
  EXPECT_NEAR(luminances[7], 1, 1e-6);                             // white of an image
}

TEST(Native, RgbLightsDevelopToThatColour) {
  const auto r = read_entities("{\"light\":{\"type\":\"point\",\"intensity\":{\"rgb\":[2, 0.5, 0.1]}}}");
  ASSERT_TRUE(r.ok) << r.messages();
  const Light light = r.scene.registry.table<Light>().get(0);
  const Color3 rgb = multiply(xyz_to_rgb(ColorSpace::srgb), r.scene.spectra.xyz(light.spectrum));
  EXPECT_NEAR(rgb[0], 2, 2e-3);
  EXPECT_NEAR(rgb[1], 0.5, 2e-3);
  EXPECT_NEAR(rgb[2], 0.1, 2e-3);
}

TEST(Native, OneMeshFileIsReadOnceAndShared) {
  const TemporaryFolder folder;
  folder.write("t.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement "
               "face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const std::string object = "{\"geometry\":{\"type\":\"mesh\",\"mesh\":{\"file\":\"t.ply\"}}}";
  NativeResult r;
  EXPECT_TRUE(read_native(folder.write("s.json", "{\"metamer\":1,\"entities\":[" + object + "," + object + "]}"),
                          r.scene, r.diagnostics));
  EXPECT_EQ(r.scene.meshes.size(), 1u);
}

}  // namespace
}  // namespace metamer
