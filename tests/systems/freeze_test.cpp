// From entities to the frozen world: what becomes of transforms, shapes, lights and mistakes.
#include "systems/freeze.h"

#include <gmock/gmock.h>

#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

using testing::HasSubstr;

std::string mistakes_of(SceneBuilder& b) {
  Diagnostics diagnostics;
  const std::unique_ptr<World> world = freeze(b.scene, diagnostics);
  EXPECT_EQ(world == nullptr, diagnostics.has_errors());
  return format_diagnostics(diagnostics);
}

SceneBuilder view(uint32_t max_depth = 1) {
  SceneBuilder b(4, 4, 4, max_depth);
  b.look_at({0, 0, 5}, {0, 0, 0}, orthographic(0.1f));
  return b;
}

// What all paths of the view carry, if they agree.
double radiance_of(SceneBuilder& b) {
  const std::vector<PathRadiance> paths = trace_radiances(*b.freeze());
  const double first = paths.front().radiance[0];
  for (const PathRadiance& path : paths)
    for (const double radiance : path.radiance) EXPECT_NEAR(radiance, first, 1e-5 * first);
  return first;
}

TEST(Freeze, NamesTheMistakesOfAScene) {
  {
    SceneBuilder b(4, 4, 1, 1);
    EXPECT_THAT(mistakes_of(b), HasSubstr("no camera"));
  }
  {
    SceneBuilder b = view();
    b.add(sphere(1), b.diffuse(0.5), stretched(1, 0, 1));
    EXPECT_THAT(mistakes_of(b), HasSubstr("singular"));
  }
  {
    SceneBuilder b = view();
    b.add(sphere(1), b.diffuse(0.5), moved(NAN, 0, 0));
    EXPECT_THAT(mistakes_of(b), HasSubstr("not finite"));
  }
  {
    SceneBuilder b = view();
    const Entity one = b.add(sphere(1), b.diffuse(0.5)), two = b.place();
    b.scene.registry.set(one, Parent{two});
    b.scene.registry.set(two, Parent{one});
    EXPECT_THAT(mistakes_of(b), HasSubstr("cycle"));
  }
  {
    SceneBuilder b = view();
    b.add(mesh(3), b.diffuse(0.5));
    EXPECT_THAT(mistakes_of(b), HasSubstr("mesh that does not exist"));
  }
  {
    SceneBuilder b = view();
    b.light(LightKind::area, unit_spectrum, 1);
    EXPECT_THAT(mistakes_of(b), HasSubstr("no geometry"));
  }
}

TEST(Freeze, CountsTrianglesWithoutArea) {
  SceneBuilder b = view();
  Mesh flat = cube_mesh();
  for (const uint32_t i : {0u, 0u, 1u, 2u, 2u, 2u}) flat.indices.push_back(i);
  b.scene.meshes.push_back(flat);
  b.emit(b.add(mesh(0), b.diffuse(0.5)), unit_spectrum, 1);
  EXPECT_THAT(mistakes_of(b), HasSubstr("2 triangles have no area"));
  EXPECT_NEAR(radiance_of(b), 1, 0.6) << "and renders the rest";
}

TEST(Freeze, AnEmptySceneIsItsSkyOrBlack) {
  SceneBuilder black = view(), sky = view();
  EXPECT_EQ(radiance_of(black), 0);
  sky.light(LightKind::environment, sky.constant(3), 0.5f);
  EXPECT_EQ(radiance_of(sky), 1.5);
  SceneBuilder dark = view();
  dark.light(LightKind::environment, dark.constant(3), 0);
  dark.emit(dark.add(sphere(1), dark.diffuse(0.5)), zero_spectrum, 1);
  EXPECT_EQ(radiance_of(dark), 0) << "lights that do not shine";
}

TEST(Freeze, TransformsComposeFromParentToChild) {
  SceneBuilder b = view(0);
  const Entity parent = b.place(moved(3, 0, 0)), turn = b.place(turned(90, 0, 0, 1) * stretched(2, 2, 2));
  b.scene.registry.set(turn, Parent{parent});
  // In the child's space at (0, 1.5): turned to (-3, 0), moved to the origin.
  const Entity child = b.add(rectangle(1, 1), b.diffuse(0.0), moved(0, 1.5, 0));
  b.scene.registry.set(child, Parent{turn});
  b.emit(child, unit_spectrum, 1);
  EXPECT_EQ(radiance_of(b), 1);
}

// A lamp emits to the side of its normal, +z in its own space, whichever way its transform is wound.
TEST(Freeze, LampsEmitToTheSideOfTheirNormal) {
  const glm::dmat4 same[] = {glm::dmat4(1), stretched(-1, 1, 1), stretched(1, -3, 1), stretched(-2, -1, 1)};
  const glm::dmat4 away[] = {stretched(1, 1, -1), turned(180, 1, 0, 0), stretched(-1, 1, -1)};
  Mesh quad;
  for (const glm::vec3 p : {glm::vec3(-1, -1, 0), {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}) quad.positions.push_back(p);
  for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) quad.indices.push_back(i);
  for (const Geometry& shape : {rectangle(2, 2), disk(1), mesh(0), sphere(1)})
    for (const bool flipped : {false, true}) {
      const auto seen = [&](const glm::dmat4& place, bool two_sided) {
        SceneBuilder b = view(0);
        b.scene.meshes.push_back(quad);
        Geometry geometry = shape;
        geometry.flip_normal = flipped;
        b.emit(b.add(geometry, b.diffuse(0.0), place), unit_spectrum, 1, two_sided);
        return radiance_of(b);
      };
      SCOPED_TRACE(testing::Message() << "shape " << uint32_t(shape.kind) << (flipped ? ", flipped" : ""));
      for (const glm::dmat4& place : same) EXPECT_EQ(seen(place, false), flipped ? 0 : 1);
      const bool round = shape.kind == ShapeKind::sphere;  // turned over, a sphere is what it was
      for (const glm::dmat4& place : away) EXPECT_EQ(seen(place, false), flipped != round ? 1 : 0);
      for (const glm::dmat4& place : away) EXPECT_EQ(seen(place, true), 1);
    }
}

TEST(Freeze, VertexNormalsNameTheOutside) {
  for (const float sign : {1.0f, -1.0f})
    for (const double mirror : {1.0, -1.0}) {
      SceneBuilder b = view(0);
      Mesh quad;
      for (const glm::vec3 p : {glm::vec3(-1, -1, 0), {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}) quad.positions.push_back(p);
      for (int i = 0; i < 4; ++i) quad.normals.push_back({0, 0, sign});
      for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) quad.indices.push_back(i);
      b.scene.meshes.push_back(quad);
      b.emit(b.add(mesh(0), b.diffuse(0.0), stretched(mirror, 1, 1)), unit_spectrum, 1);
      EXPECT_EQ(radiance_of(b), sign > 0 ? 1 : 0);
    }
}

TEST(Freeze, EveryShapeHidesFromTheRaysItsMaskLeavesOut) {
  for (const Geometry& shape : {sphere(1), disk(1), rectangle(2, 2), mesh(0)})
    for (const bool instanced : {false, true}) {
      SceneBuilder b = view(0);
      b.scene.meshes.push_back(cube_mesh());
      const Entity entity = b.add(shape, b.diffuse(0.0));
      if (instanced) b.add(mesh(0), b.diffuse(0.0), moved(9, 0, 0));
      b.light(LightKind::environment, unit_spectrum, 1);
      EXPECT_EQ(radiance_of(b), 0);
      b.scene.registry.set(entity, Visibility{visible_to_bounces | visible_to_shadows});
      EXPECT_EQ(radiance_of(b), 1);
    }
}

// A mesh that several entities show is kept once; that must not be seen.
TEST(Freeze, InstancesLookLikeCopies) {
  std::vector<Film> films;
  for (const bool shared : {true, false}) {
    SceneBuilder b(16, 16, 64, 5);
    b.scene.meshes.push_back(cube_mesh());
    b.scene.meshes.push_back(cube_mesh());
    const Material glass = b.dielectric(b.constant(1.5));
    b.add(mesh(0), glass, moved(-0.7, 0, 0) * turned(30, 1, 2, 0) * stretched(1, -1.2, 0.8));
    b.add(mesh(shared ? 0 : 1), b.diffuse(0.6), moved(0.7, 0, 0) * turned(50, 1, 0, 1));
    b.add(rectangle(4, 4), b.diffuse(0.6), moved(0, 0, -1.5));
    b.light(LightKind::directional, unit_spectrum, 1, turned(-30, 1, 1, 0));
    b.light(LightKind::environment, unit_spectrum, 1);
    b.look_at({0, 0, 5}, {0, 0, 0}, perspective(30));
    films.push_back(render_film(*b.freeze()));
  }
  size_t same = 0;
  for (size_t pixel = 0; pixel < films[0].pixel_count(); ++pixel) {
    const double a = mean_xyz(films[0], pixel)[1], c = mean_xyz(films[1], pixel)[1];
    same += std::abs(a / c - 1) < 1e-3;
  }
  EXPECT_GT(same, 240u) << "of 256";
}

// Size and mirrors of a light's transform do not change what comes from a direction.
TEST(Freeze, LightFromInfinityIgnoresTheSizeOfItsTransform) {
  Image image;
  image.width = 8;
  image.height = 4;
  for (uint32_t i = 0; i < 8 * 4 * 3; ++i) image.rgb.push_back(float(i % 11) * 0.2f);
  for (const ImageMapping mapping : {ImageMapping::latitude_longitude, ImageMapping::equal_area}) {
    image.mapping = mapping;
    if (mapping == ImageMapping::equal_area) image.width = image.height = 4, image.rgb.resize(4 * 4 * 3);
    std::vector<Film> films;
    for (const double size : {1.0, 7.0, 0.01}) {
      SceneBuilder b(16, 16, 16, 2);
      b.add(sphere(1), b.conductor(b.named("Ag.n"), b.named("Ag.k"), 0.3f, 0.3f));
      b.environment(image, 1, turned(35, 1, 2, 3) * stretched(size, size, -size));
      b.light(LightKind::directional, unit_spectrum, 1, turned(-60, 1, 1, 0) * stretched(size, size, size));
      b.look_at({0, 0, 5}, {0, 0, 0}, perspective(40));
      films.push_back(render_film(*b.freeze()));
    }
    for (size_t i = 1; i < films.size(); ++i) {
      size_t same = 0;
      for (size_t pixel = 0; pixel < films[0].pixel_count(); ++pixel)
        same += std::abs(mean_xyz(films[i], pixel)[1] / mean_xyz(films[0], pixel)[1] - 1) < 1e-3;
      EXPECT_GT(same, 240u) << "of 256";
    }
  }
}

TEST(Freeze, LightsAreChosenHalfByTheirPowerAndHalfAlike) {
  SceneBuilder b = view();
  b.emit(b.add(sphere(1), b.diffuse(0.0)), unit_spectrum, 1);  // pi 4 pi
  b.emit(b.add(sphere(1), b.diffuse(0.0), moved(4, 0, 0) * stretched(1, 1, 1.0)), unit_spectrum, 2);
  b.emit(b.add(disk(2, 1), b.diffuse(0.0), moved(0, 4, 0)), unit_spectrum, 1, true);  // pi 3 pi 2
  b.light(LightKind::point, unit_spectrum, 1);                                        // 4 pi
  const std::unique_ptr<World> world = b.freeze();
  const double power[] = {4, 8, 6, 4 / 3.14159265358979};
  double total = 0;
  for (const double p : power) total += p;
  ASSERT_EQ(world->lights.size(), 4u);
  for (size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(world->lights[i].choice_probability, (power[i] / total + 0.25) / 2, 1e-5) << i;
}

TEST(Freeze, TheTrianglesOfALightShareItsHalfByPower) {
  SceneBuilder b = view();
  b.scene.meshes.push_back(cube_mesh());
  const size_t triangles = b.scene.meshes[0].indices.size() / 3;
  b.emit(b.add(mesh(0), b.diffuse(0.0)), unit_spectrum, 1);
  b.light(LightKind::directional, unit_spectrum, 1e12f);
  const std::unique_ptr<World> world = b.freeze();
  ASSERT_EQ(world->lights.size(), triangles + 1);
  for (size_t i = 0; i < triangles; ++i)
    EXPECT_NEAR(world->lights[i].choice_probability, 0.25 / double(triangles), 1e-6) << i;
  EXPECT_NEAR(world->lights[triangles].choice_probability, 0.75, 1e-6);
}

// The sky's power is that which falls on the scene, however the scene is made.
TEST(Freeze, TheSizeOfTheSceneCountsQuadricsAndInstances) {
  for (const bool quadric : {true, false}) {
    SceneBuilder b = view();
    b.scene.meshes.push_back(cube_mesh());
    const double half = 10;
    if (quadric) {
      b.add(sphere(1), b.diffuse(0.5), stretched(half, half, half));
    } else {
      b.add(mesh(0), b.diffuse(0.5), stretched(2 * half, 2 * half, 2 * half));
      b.add(mesh(0), b.diffuse(0.5));
    }
    b.light(LightKind::directional, unit_spectrum, 1);
    b.light(LightKind::point, unit_spectrum, 1);
    const double sun = 3.14159265358979 * 3 * half * half, lamp = 4 * 3.14159265358979;
    EXPECT_NEAR(b.freeze()->lights[0].choice_probability, (sun / (sun + lamp) + 0.5) / 2, 1e-5);
  }
}

// Its directions stay unit vectors, whose density is per solid angle; a mirror stays one.
TEST(Environment, ScaleMeansNothingAtInfinity) {
  Image image;
  image.width = 2;
  image.height = 1;
  image.rgb.assign(6, 1.0f);
  for (const double mirror : {1.0, -1.0}) {
    const auto placed = [&](const glm::dvec3& scale) {
      SceneBuilder b(8, 8, 1, 1);
      b.environment(image, 1, turned(70, 0.3, 0.5, 1) * stretched(mirror * scale.x, scale.y, scale.z));
      b.look_at({0, 0, 4}, {0, 0, 0}, perspective(45));
      return b.freeze();
    };
    const std::unique_ptr<World> plain = placed({1, 1, 1}), scaled = placed({3, 0.2, 7});
    for (int i = 0; i < 9; ++i) {
      EXPECT_NEAR(scaled->environments[0].to_world[i], plain->environments[0].to_world[i], 1e-6);
      EXPECT_NEAR(scaled->environments[0].to_local[i], plain->environments[0].to_local[i], 1e-6);
    }
  }
}

}  // namespace
}  // namespace metamer
