#include <glm/geometric.hpp>

#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

constexpr const char* sphere = "Shape \"sphere\"\n";

glm::vec3 image(const Transform& m, glm::vec3 p) {
  const glm::vec4 h(p, 1);
  return {glm::dot(m.row0, h), glm::dot(m.row1, h), glm::dot(m.row2, h)};
}
Transform shape_transform(const ReadScene& read, uint32_t n = 0) {
  return read.scene.registry.get<Transform>(read.entity<Geometry>(n));
}
void expect_near(glm::vec3 a, glm::vec3 b) {
  EXPECT_LT(glm::length(a - b), 1e-6f * (1 + glm::length(b))) << a.x << " " << a.y << " " << a.z;
}

// Where the directives put the local point (1, 2, 3).
glm::vec3 moved(const std::string& directives) {
  const ReadScene read = read_world(directives + "\n" + sphere);
  EXPECT_TRUE(read.ok) << directives << "\n" << format_diagnostics(read.diagnostics);
  return image(shape_transform(read), {1, 2, 3});
}

TEST(PbrtTransforms, TranslateScaleRotateAndIdentityApplyFromTheRight) {
  expect_near(moved("Translate 10 20 30"), {11, 22, 33});
  expect_near(moved("Scale 2 -3 4"), {2, -6, 12});
  expect_near(moved("Translate 10 0 0 Scale 2 2 2"), {12, 4, 6});
  expect_near(moved("Scale 2 2 2 Translate 10 0 0"), {22, 4, 6});
  expect_near(moved("Rotate 90 0 0 5"), {-2, 1, 3});  // right-handed about z, whatever the axis' length
  expect_near(moved("Rotate 90 1 0 0"), {1, -3, 2});
  expect_near(moved("Rotate 120 1 1 1"), {3, 1, 2});
  expect_near(moved("Translate 10 20 30 Identity"), {1, 2, 3});
}

TEST(PbrtTransforms, TransformReplacesAndConcatTransformAppendsAMatrixGivenColumnByColumn) {
  const std::string m = "[ 0 1 0 0  -1 0 0 0  0 0 1 0  10 20 30 1 ]";  // a quarter turn about z, then a translation
  expect_near(moved("Scale 5 5 5 Transform " + m), {8, 21, 33});
  expect_near(moved("Scale 5 5 5 ConcatTransform " + m), {40, 105, 165});
  expect_near(moved("Transform [ 2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 2 ]"), {1, 2, 3});
}

TEST(PbrtTransforms, LookAtStandsTheCameraAtTheEyeWithZAhead) {
  // From (0, 0, 5) towards the origin. Camera space is left-handed: its +x is up x forward, the world's -x.
  const ReadScene read = read_text("LookAt 0 0 5  0 0 0  0 1 0 Camera \"perspective\" WorldBegin");
  ASSERT_TRUE(read.ok);
  const auto camera = read.scene.registry.get<Transform>(read.entity<Camera>());
  expect_near(image(camera, {0, 0, 0}), {0, 0, 5});  // the eye
  expect_near(image(camera, {0, 0, 1}), {0, 0, 4});  // one metre ahead
  expect_near(image(camera, {0, 1, 0}), {0, 1, 5});  // up
  expect_near(image(camera, {1, 0, 0}), {-1, 0, 5});
}

TEST(PbrtTransforms, AttributeBlocksRestoreAndNest) {
  const ReadScene read = read_world("Translate 1 0 0 AttributeBegin Translate 0 1 0 AttributeBegin Translate 0 0 1 " +
                                    std::string(sphere) + "AttributeEnd " + sphere + "AttributeEnd " + sphere);
  ASSERT_TRUE(read.ok);
  expect_near(image(shape_transform(read, 0), {}), {1, 1, 1});
  expect_near(image(shape_transform(read, 1), {}), {1, 1, 0});
  expect_near(image(shape_transform(read, 2), {}), {1, 0, 0});
}

TEST(PbrtTransforms, WorldBeginStartsFromTheIdentity) {
  const ReadScene read = read_text(std::string("Translate 5 5 5 Camera \"perspective\" WorldBegin\n") + sphere);
  expect_near(image(shape_transform(read), {}), {0, 0, 0});
}

TEST(PbrtTransforms, NamedCoordinateSystemsComeBack) {
  const ReadScene read =
      read_text(std::string("Translate 0 0 -7 Camera \"perspective\" WorldBegin Translate 1 2 3 "
                            "CoordinateSystem \"there\" Identity CoordSysTransform \"there\"\n") +
                sphere + "CoordSysTransform \"camera\"\n" + sphere + "CoordSysTransform \"world\"\n" + sphere);
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  expect_near(image(shape_transform(read, 0), {}), {1, 2, 3});
  expect_near(image(shape_transform(read, 1), {}), {0, 0, 7});
  expect_near(image(shape_transform(read, 2), {}), {0, 0, 0});
}

TEST(PbrtTransforms, MirrorsAreKeptAndReverseOrientationToggles) {
  const ReadScene read = read_world(std::string("Scale -1 1 1\n") + sphere + "ReverseOrientation\n" + sphere +
                                    "ReverseOrientation\n" + sphere);
  EXPECT_EQ(shape_transform(read, 0).row0.x, -1.0f);
  EXPECT_EQ(read.get<Geometry>(0).flip_normal, 0u);
  EXPECT_EQ(read.get<Geometry>(1).flip_normal, 1u);
  EXPECT_EQ(read.get<Geometry>(2).flip_normal, 0u);
}

Transform end_of(const Motion& motion) { return {motion.row0, motion.row1, motion.row2}; }

TEST(PbrtTransforms, ActiveTransformMovesOneEndOfTheMotion) {
  const ReadScene read = read_text(
      std::string("TransformTimes 0.5 2 Camera \"perspective\" WorldBegin\nTranslate 1 0 0 ActiveTransform EndTime "
                  "Translate 0 2 0 ActiveTransform StartTime Translate 0 0 3 ActiveTransform All Translate 4 0 0\n") +
      sphere);
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_THAT(read.messages, testing::IsEmpty());
  expect_near(image(shape_transform(read), {}), {5, 0, 3});
  ASSERT_EQ(read.count<Motion>(), 1u);
  expect_near(image(end_of(read.get<Motion>()), {}), {5, 2, 0});
  EXPECT_EQ(read.get<Motion>().start_time, 0.5f);
  EXPECT_EQ(read.get<Motion>().end_time, 2.0f);
}

TEST(PbrtTransforms, EveryTransformGoesToWhatIsActive) {
  const ReadScene read = read_world(std::string("ActiveTransform EndTime\n") +
                                    "Scale 2 2 2 Rotate 90 0 0 1 ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 1]\n" +
                                    sphere + "Identity LookAt 0 0 5 0 0 0 0 1 0\n" + sphere +
                                    "Transform [1 0 0 0 0 1 0 0 0 0 1 0 7 0 0 1]\n" + sphere + "Identity\n" + sphere);
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  for (uint32_t n = 0; n < 4; ++n) expect_near(image(shape_transform(read, n), {1, 2, 3}), {1, 2, 3});
  ASSERT_EQ(read.count<Motion>(), 3u) << "the last stands still";
  expect_near(image(end_of(read.get<Motion>(0)), {}), {0, 2, 0});
  expect_near(image(end_of(read.get<Motion>(1)), {}), {0, 0, 5});
  expect_near(image(end_of(read.get<Motion>(2)), {}), {7, 0, 0});
}

TEST(PbrtTransforms, WhatIsActiveEndsWithItsBlockAndCoordinateSystemsHaveBothEnds) {
  const ReadScene read = read_world(std::string("AttributeBegin ActiveTransform EndTime Translate 1 0 0 "
                                                "CoordinateSystem \"moving\" AttributeEnd Translate 0 1 0\n") +
                                    sphere + "ActiveTransform StartTime CoordSysTransform \"moving\"\n" + sphere);
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  ASSERT_EQ(read.count<Motion>(), 1u);
  expect_near(image(shape_transform(read, 0), {}), {0, 1, 0});
  expect_near(image(shape_transform(read, 1), {}), {0, 0, 0});
  expect_near(image(end_of(read.get<Motion>()), {}), {1, 0, 0});
}

TEST(PbrtTransforms, CamerasMoveByTheInverses) {
  const ReadScene read = read_text(
      "Translate 0 0 -7 ActiveTransform EndTime Translate -2 0 0 ActiveTransform All Camera \"perspective\" \"float "
      "shutteropen\" 0.25 \"float shutterclose\" 0.75\nWorldBegin\nCoordSysTransform \"camera\"\n" +
      std::string(sphere));
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  const Entity camera = read.entity<Camera>();
  expect_near(image(read.scene.registry.get<Transform>(camera), {}), {0, 0, 7});
  expect_near(image(end_of(read.scene.registry.get<Motion>(camera)), {}), {2, 0, 7});
  EXPECT_EQ(read.scene.settings.shutter_open, 0.25);
  EXPECT_EQ(read.scene.settings.shutter_close, 0.75);
  EXPECT_FLOAT_EQ(read.scene.settings.sensor_scale, 0.5f);
  expect_near(image(end_of(read.scene.registry.get<Motion>(read.entity<Geometry>())), {}), {2, 0, 7});
}

TEST(PbrtTransforms, LightsThatMoveStandAndAreWarnedAbout) {
  const ReadScene read = read_world(std::string("ActiveTransform EndTime Translate 1 0 0\nLightSource \"point\"\n") +
                                    "AreaLightSource \"diffuse\"\n" + sphere);
  EXPECT_TRUE(read.ok);
  EXPECT_EQ(read.count<Motion>(), 0u);
  EXPECT_THAT(read.messages, testing::ElementsAre("scene:3: warning: lights that move are not supported; they stand as "
                                                  "at the start of their motion, as in pbrt"));
}

// The instance and the shape within each have a motion of their own.
TEST(PbrtTransforms, ShapesMoveInInstancesThatMove) {
  const ReadScene read =
      read_world(std::string("ObjectBegin \"wheel\"\nAttributeBegin ActiveTransform EndTime Rotate 90 0 "
                             "0 1\n") +
                 sphere + "AttributeEnd Translate 0 3 0\n" + sphere +
                 "ObjectEnd\nObjectInstance \"wheel\"\nTranslate 0 0 1 ActiveTransform EndTime Translate "
                 "5 0 0 ObjectInstance \"wheel\"");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  const Registry& registry = read.scene.registry;
  ASSERT_EQ(read.count<Geometry>(), 4u);
  const auto parent_of = [&](uint32_t n) { return registry.get<Parent>(read.entity<Geometry>(n)).entity; };
  // Of the instance that stands, the shape that moves has a parent of its own, the other one none.
  EXPECT_FALSE(registry.has<Motion>(parent_of(0)));
  EXPECT_TRUE(registry.has<Motion>(read.entity<Geometry>(0)));
  EXPECT_TRUE(parent_of(1).is_null());
  expect_near(image(shape_transform(read, 1), {}), {0, 3, 0});
  ASSERT_TRUE(registry.has<Motion>(parent_of(2)));
  EXPECT_EQ(parent_of(2), parent_of(3)) << "one entity for the instance";
  EXPECT_FALSE(registry.has<Motion>(read.entity<Geometry>(3)));
  expect_near(image(registry.get<Transform>(parent_of(2)), {}), {0, 0, 1});
  expect_near(image(end_of(registry.get<Motion>(parent_of(2))), {}), {5, 0, 1});
  expect_near(image(end_of(registry.get<Motion>(read.entity<Geometry>(2))), {1, 0, 0}), {0, 1, 0});
}

TEST(PbrtTransforms, InstancesShareTheMeshUnderTheProductOfBothTransforms) {
  const ReadScene read = read_world(R"(ObjectBegin "chair" Translate 0 1 0
Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0]
Shape "sphere" "float radius" 2
ObjectEnd
Scale 2 2 2 ObjectInstance "chair"
Translate 5 0 0 ObjectInstance "chair")");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_EQ(read.scene.meshes.size(), 1u);
  ASSERT_EQ(read.count<Geometry>(), 4u);
  expect_near(image(shape_transform(read, 0), {}), {0, 2, 0});
  expect_near(image(shape_transform(read, 2), {}), {10, 2, 0});
  EXPECT_EQ(read.get<Geometry>(0).mesh, read.get<Geometry>(2).mesh);
  EXPECT_EQ(read.scene.describe(read.entity<Geometry>(2)), "'chair'");
  EXPECT_EQ(read.scene.location(read.entity<Geometry>(2)).line, 3u) << "where the shape is written";
}

TEST(PbrtTransforms, TheOriginOfAnEntityIsItsDirective) {
  const ReadScene read = read_world(std::string("\n\n") + sphere);
  EXPECT_EQ(read.scene.location(read.entity<Geometry>()).line, 4u);
  EXPECT_EQ(read.scene.location(read.entity<Camera>()).line, 1u);
}

}  // namespace
}  // namespace metamer
