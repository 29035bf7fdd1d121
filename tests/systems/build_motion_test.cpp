// Motions taken apart and put together again, and their keys.
#include "systems/build_motion.h"

#include <gmock/gmock.h>

#include <glm/gtc/quaternion.hpp>

#include "tests/systems/support/scene_builder.h"

namespace metamer {
namespace {

double difference(const glm::dmat4& a, const glm::dmat4& b) {
  double largest = 0;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) largest = std::max(largest, std::abs(a[c][r] - b[c][r]));
  return largest;
}

void expect_equal(const glm::dmat4& a, const glm::dmat4& b, double tolerance = 1e-12) {
  EXPECT_LT(difference(a, b), tolerance);
}

// From `a` to `b`, halfway where `t` is a half.
glm::dmat4 between(const glm::dmat4& a, const glm::dmat4& b, double t) {
  return interpolated(motion_parts(a), motion_parts(b), t);
}

Motion motion_to(const glm::dmat4& end, float start_time = 0, float end_time = 1) {
  const glm::mat4 m = glm::transpose(glm::mat4(end));
  return {m[0], m[1], m[2], start_time, end_time};
}

const glm::dmat4 sheared = moved(1, 2, 3) * turned(77, 1, -2, 0.5) * stretched(3, 0.2, 5) * turned(20, 0, 1, 1);

TEST(MotionParts, MakeTheMatrixAgain) {
  for (const glm::dmat4& m : {glm::dmat4(1), sheared, sheared * stretched(-1, 1, 1), stretched(-2, -2, -2),
                              turned(180, 1, 0, 0), turned(180, 0, 1, 0), turned(179.9, 0, 0, 1), turned(120, 1, 1, 1),
                              stretched(1e6, 1e6, 1e6) * turned(10, 1, 0, 0), stretched(1e-6, 1e-6, 1e-6)}) {
    const MotionParts parts = motion_parts(m);
    double length2 = 0;
    for (const double q : parts.rotation) length2 += q * q;
    EXPECT_NEAR(length2, 1, 1e-14);
    expect_equal(interpolated(parts, parts, 0.3), m, 1e-12 * (1 + difference(m, glm::dmat4(0))));
    EXPECT_LT(glm::length(parts.stretch[0] - glm::transpose(parts.stretch)[0]),
              1e-12 * (1 + difference(m, glm::dmat4(0))))
        << "the rest is symmetric";
  }
}

TEST(MotionParts, GoTheirWaysOneByOne) {
  expect_equal(between(moved(1, 0, 0), moved(3, 4, 0), 0.25), moved(1.5, 1, 0));
  expect_equal(between(turned(10, 0, 0, 1), turned(70, 0, 0, 1), 0.5), turned(40, 0, 0, 1));
  expect_equal(between(turned(-30, 1, 2, 3), turned(60, 1, 2, 3), 0.8), turned(42, 1, 2, 3));
  expect_equal(between(stretched(1, 1, 1), stretched(3, 1, 5), 0.5), stretched(2, 1, 3));
  expect_equal(between(glm::dmat4(1), moved(2, 0, 0) * turned(90, 0, 1, 0) * stretched(3, 3, 3), 0.5),
               moved(1, 0, 0) * turned(45, 0, 1, 0) * stretched(2, 2, 2));
  expect_equal(between(stretched(-1, 1, 1), turned(90, 1, 0, 0) * stretched(-1, 1, 1), 0.5),
               turned(45, 1, 0, 0) * stretched(-1, 1, 1));
}

TEST(MotionParts, TurnTheShorterWay) {
  expect_equal(between(turned(-100, 0, 1, 0), turned(100, 0, 1, 0), 0.5), turned(180, 0, 1, 0));
  expect_equal(between(turned(170, 0, 0, 1), turned(-170, 0, 0, 1), 0.25), turned(175, 0, 0, 1));
}

// K. Shoemake's slerp as GLM has it.
TEST(MotionParts, AgreeWithAnotherSlerp) {
  const glm::dmat4 a = turned(33, 1, 2, 3), b = turned(140, -1, 0.3, 2);
  for (double t = 0; t <= 1; t += 0.1)
    expect_equal(between(a, b, t), glm::mat4_cast(glm::slerp(glm::quat_cast(a), glm::quat_cast(b), t)), 1e-10);
}

struct Moving {
  SceneBuilder b{8, 8, 1, 1};
  Diagnostics diagnostics;
  Entity entity = b.place();

  std::vector<glm::dmat4> keys() { return motion_keys(b.scene, entity, diagnostics); }
  void move(Entity which, const Motion& motion) { b.scene.registry.set(which, motion); }
};

TEST(MotionKeys, WhatStandsStillHasNone) {
  Moving m;
  EXPECT_TRUE(m.keys().empty());
  m.move(m.entity, motion_to(glm::dmat4(1)));
  EXPECT_TRUE(m.keys().empty());
  m.move(m.entity, motion_to(moved(1, 0, 0), 5, 6));
  EXPECT_TRUE(m.keys().empty()) << "it moves after the shutter has closed";
}

TEST(MotionKeys, TwoAreEnoughForALine) {
  Moving m;
  m.move(m.entity, motion_to(moved(0, 6, 0) * stretched(2, 1, 1)));
  ASSERT_EQ(m.keys().size(), 2u);
  m.b.scene.settings.shutter_open = 0.25;
  m.b.scene.settings.shutter_close = 0.5;
  ASSERT_EQ(m.keys().size(), 2u);
  expect_equal(m.keys()[0], moved(0, 1.5, 0) * stretched(1.25, 1, 1));
  expect_equal(m.keys()[1], moved(0, 3, 0) * stretched(1.5, 1, 1));
}

TEST(MotionKeys, AMotionThatHasEndedLeavesItsEnd) {
  Moving m;
  m.move(m.entity, motion_to(moved(0, 6, 0), -2, -1));
  ASSERT_EQ(m.keys().size(), 2u);
  for (const glm::dmat4& key : m.keys()) expect_equal(key, moved(0, 6, 0));
}

// Anywhere in time, also where parents and children both move, and where motion begins while the shutter is open.
TEST(MotionKeys, LinesBetweenThemFollowTheMotion) {
  Moving m;
  const Entity parent = m.b.place(moved(0, 2, 0));
  m.b.scene.registry.set(m.entity, Parent{parent});
  const glm::dmat4 inner_end = moved(1, 0, 0) * turned(100, 0, 0, 1), outer_end = moved(5, 2, 1) * turned(50, 1, 1, 0);
  m.move(m.entity, motion_to(inner_end));
  m.move(parent, motion_to(outer_end, -0.5f, 1.5f));
  const std::vector<glm::dmat4> keys = m.keys();
  ASSERT_GT(keys.size(), 8u);
  ASSERT_LE(keys.size(), 129u);
  for (double u = 0; u < 1; u += 0.0137) {
    const glm::dmat4 expected =
        between(moved(0, 2, 0), outer_end, (u + 0.5) / 2) * between(glm::dmat4(1), inner_end, u);
    const double scaled = u * static_cast<double>(keys.size() - 1);
    const auto first = static_cast<size_t>(scaled);
    const double t = scaled - static_cast<double>(first);
    expect_equal(keys[first] * (1 - t) + keys[first + 1] * t, expected, 6 * motion_tolerance);
  }
}

TEST(MotionKeys, AMotionThatFlattensIsAMistake) {
  Moving m;
  m.move(m.entity, motion_to(stretched(-1, 1, 1)));
  EXPECT_TRUE(m.keys().empty());
  EXPECT_THAT(format_diagnostics(m.diagnostics), testing::HasSubstr("is flattened while it moves"));
}

}  // namespace
}  // namespace metamer
