// The published scenes as files: what the registry holds then. (That they look right is tested elsewhere.)
#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

const std::filesystem::path shared_scenes = std::filesystem::path(METAMER_SOURCE_DIR) / "../shared/scenes";

ReadScene read_shared(const std::string& name) { return read_scene_at((shared_scenes / name / "scene.pbrt").string()); }

TEST(PbrtSharedScenes, TheCornellBoxHasEightMeshesAndOneLight) {
  if (!std::filesystem::exists(shared_scenes)) GTEST_SKIP() << "no " << shared_scenes;
  const ReadScene read = read_shared("cornell-box");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_EQ(read.count<Geometry>(), 8u);
  EXPECT_EQ(read.count<Light>(), 1u);
  EXPECT_EQ(read.scene.meshes.size(), 8u);
  EXPECT_EQ(read.scene.meshes[5].indices.size(), 36u);
  EXPECT_EQ(read.scene.settings.width, 1024u);
  EXPECT_EQ(read.scene.settings.max_depth, 4u);
  EXPECT_EQ(read.scene.settings.filter.kind, FilterKind::box);
  EXPECT_FLOAT_EQ(read.scene.settings.filter.radius_x, 0.5f);
  EXPECT_FLOAT_EQ(read.get<Camera>().fov_deg, 19.5f);
  // The file's matrix flips z and moves by (0, -1, 6.8): the camera stands at (0, 1, 6.8) and looks along -z.
  const auto camera = read.scene.registry.get<Transform>(read.entity<Camera>());
  EXPECT_EQ(camera.row0, glm::vec4(1, 0, 0, 0));
  EXPECT_EQ(camera.row1, glm::vec4(0, 1, 0, 1));
  EXPECT_NEAR(camera.row2.w, 6.8f, 1e-6f);
  EXPECT_EQ(camera.row2.z, -1.0f);
  // rgb L [17 12 4]: cd/m^2 with the weights of sRGB's Y.
  const Light light = read.get<Light>();
  const double luminance = read.scene.spectra.luminance(light.spectrum) * light.scale;
  EXPECT_NEAR(luminance, 17 * 0.2126 + 12 * 0.7152 + 4 * 0.0722, 0.01);
  // Only what the program decides itself is remarked on.
  for (const Diagnostic& message : read.diagnostics.all())
    EXPECT_EQ(message.severity, Severity::note) << message.message;
}

TEST(PbrtSharedScenes, VeachMisHasThreeSpheresOfLightAndRoughMetals) {
  if (!std::filesystem::exists(shared_scenes)) GTEST_SKIP() << "no " << shared_scenes;
  const ReadScene read = read_shared("veach-mis");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_EQ(read.count<Geometry>(), 9u);
  ASSERT_EQ(read.count<Light>(), 3u);
  constexpr float radii[] = {1, 0.5f, 0.05f}, luminances[] = {7.599088f, 30.396353f, 3039.6353f},
                  z[] = {-2.8f, 0, 2.7f};
  for (uint32_t i = 0; i < 3; ++i) {
    const Entity entity = read.entity<Light>(i);
    EXPECT_EQ(read.scene.registry.get<Geometry>(entity).kind, ShapeKind::sphere);
    EXPECT_EQ(read.scene.registry.get<Geometry>(entity).radius, radii[i]);
    EXPECT_EQ(read.scene.registry.get<Transform>(entity).row2.w, z[i]);
    const Light light = read.get<Light>(i);
    EXPECT_NEAR(read.scene.spectra.luminance(light.spectrum) * light.scale, luminances[i], 1e-3 * luminances[i]);
  }
  const Material smooth = read.material(0);
  EXPECT_EQ(smooth.kind, MaterialKind::conductor);
  EXPECT_FLOAT_EQ(smooth.alpha_x, 0.01f) << "remaproughness is off";
}

TEST(PbrtSharedScenes, EveryOtherSceneIsReadWithWarningsOnly) {
  if (!std::filesystem::exists(shared_scenes)) GTEST_SKIP() << "no " << shared_scenes;
  for (const auto& entry : std::filesystem::directory_iterator(shared_scenes)) {
    if (!entry.is_directory()) continue;
    const ReadScene read = read_shared(entry.path().filename().string());
    EXPECT_TRUE(read.ok) << entry.path() << "\n" << format_diagnostics(read.diagnostics);
    EXPECT_GT(read.count<Geometry>(), 0u) << entry.path();
  }
}

}  // namespace
}  // namespace metamer
