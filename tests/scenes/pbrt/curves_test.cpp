#include <glm/geometric.hpp>

#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

ReadScene read_good(const std::string& world) {
  ReadScene read = read_world(world);
  EXPECT_TRUE(read.ok) << world << "\n" << format_diagnostics(read.diagnostics);
  return read;
}

glm::vec3 at(const Curves& curves, size_t segment, float u) {
  const glm::vec4* p = &curves.points[curves.segments[segment]];
  const float v = 1 - u;
  return glm::vec3(v * v * v * p[0] + 3 * v * v * u * p[1] + 3 * v * u * u * p[2] + u * u * u * p[3]);
}
void expect_point(const glm::vec3& found, const glm::vec3& wanted) {
  EXPECT_LT(glm::length(found - wanted), 1e-6f)
      << found.x << " " << found.y << " " << found.z << ", not " << wanted.x << " " << wanted.y << " " << wanted.z;
}

TEST(PbrtCurves, BezierSegmentsShareTheirEndsAndTaper) {
  const ReadScene read = read_good(R"(ReverseOrientation
Shape "curve" "point3 P" [0 0 0 1 0 0 2 1 0 3 0 0 4 0 1 5 0 0 6 0 0] "float width0" .6 "float width1" 0 "integer splitdepth" 5)");
  const auto geometry = read.get<Geometry>();
  EXPECT_EQ(geometry.kind, ShapeKind::flat_curves);
  EXPECT_EQ(geometry.flip_normal, 1u);
  const Curves& curves = read.scene.curves[geometry.curves];
  ASSERT_EQ(curves.points.size(), 7u);
  EXPECT_EQ(std::vector<uint32_t>(curves.segments.begin(), curves.segments.end()), (std::vector<uint32_t>{0, 3}));
  EXPECT_EQ(curves.points[2], glm::vec4(2, 1, 0, 0.2f));
  EXPECT_FLOAT_EQ(curves.points[3].w, 0.15f);
  EXPECT_EQ(curves.points[6].w, 0);
  EXPECT_TRUE(curves.normals.empty());
}

TEST(PbrtCurves, QuadraticOnesAreElevated) {
  const ReadScene read =
      read_good("Shape \"curve\" \"integer degree\" 2 \"point3 P\" [0 0 0 1 2 0 2 0 0 3 -2 0 4 0 0]");
  const Curves& curves = read.scene.curves[0];
  ASSERT_EQ(curves.segments.size(), 2u);
  for (const float u : {0.0f, 0.3f, 1.0f}) expect_point(at(curves, 0, u), {2 * u, 4 * u * (1 - u), 0});
  EXPECT_EQ(curves.points[0].w, 0.5f) << "of a width of 1 by default";
}

TEST(PbrtCurves, SplinesBecomeBezierSegments) {
  // The cubic basis at u = 1/2 weights 1, 23, 23, 1 over 48; the quadratic one 1, 6, 1 over 8.
  const ReadScene read =
      read_good(R"(Shape "curve" "string basis" "bspline" "point3 P" [0 0 0 0 48 0 0 0 48 48 0 0 0 0 0]
Shape "curve" "string type" "cylinder" "string basis" "bspline" "integer degree" 2 "point3 P" [8 0 0 0 8 0 0 0 8 8 8 8])");
  const Curves& cubic = read.scene.curves[0];
  ASSERT_EQ(cubic.segments.size(), 2u);
  ASSERT_EQ(cubic.points.size(), 7u);
  expect_point(at(cubic, 0, 0.5f), {1, 23, 23});
  expect_point(at(cubic, 1, 0.5f), {23, 1, 23});
  expect_point(at(cubic, 0, 1), at(cubic, 1, 0));
  const Curves& quadratic = read.scene.curves[1];
  ASSERT_EQ(quadratic.segments.size(), 2u);
  expect_point(at(quadratic, 0, 0.5f), {1, 6, 1});
  EXPECT_EQ(read.get<Geometry>(1).kind, ShapeKind::round_curves);
}

TEST(PbrtCurves, RibbonsTurnEvenlyBetweenTheirNormals) {
  const ReadScene read = read_good(
      "Shape \"curve\" \"string type\" \"ribbon\" \"normal N\" [0 0 2 0 1 0] \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0]");
  const Curves& curves = read.scene.curves[0];
  EXPECT_EQ(read.get<Geometry>().kind, ShapeKind::ribbons);
  ASSERT_EQ(curves.normals.size(), 4u);
  for (const float u : {0.0f, 0.25f, 0.5f, 1.0f}) {
    const float v = 1 - u;
    const glm::vec3* n = curves.normals.data();
    const glm::vec3 normal =
        glm::normalize(v * v * v * n[0] + 3 * v * v * u * n[1] + 3 * v * u * u * n[2] + u * u * u * n[3]);
    const float angle = u * 1.57079633f;
    EXPECT_LT(glm::length(normal - glm::vec3(0, std::sin(angle), std::cos(angle))), 3e-3f) << u;
  }
}

const std::string one = "Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0]\n";

TEST(PbrtCurves, ThoseOfOneLookBecomeOneShape) {
  const ReadScene read =
      read_good(one + one + "Shape \"sphere\"\n" + one + "Material \"diffuse\"\n" + one + one + "Translate 1 0 0\n" +
                one + "ReverseOrientation\n" + one +
                "Shape \"curve\" \"string type\" \"cylinder\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0]\n");
  ASSERT_EQ(read.scene.curves.size(), 5u);
  EXPECT_EQ(read.scene.curves[0].segments.size(), 3u);
  EXPECT_EQ(read.scene.curves[1].segments.size(), 2u);
  EXPECT_EQ(read.count<Geometry>(), 6u);
  EXPECT_EQ(read.scene.location(read.entity<Geometry>(0)).line, 2u);
}

TEST(PbrtCurves, ThoseOfAnObjectAreSharedByItsInstances) {
  const ReadScene read = read_good(one + "ObjectBegin \"lock\"\n" + one + one + "ObjectEnd\nObjectInstance \"lock\"\n" +
                                   "Translate 1 0 0 ObjectInstance \"lock\"\n");
  ASSERT_EQ(read.scene.curves.size(), 2u);
  EXPECT_EQ(read.count<Geometry>(), 3u);
  EXPECT_EQ(read.get<Geometry>(1).curves, 1u);
  EXPECT_EQ(read.get<Geometry>(2).curves, 1u);
  EXPECT_EQ(read.scene.curves[1].segments.size(), 2u);
}

TEST(PbrtCurves, WhatIsWrongIsSaidAndLightsAreLeftOut) {
  const ReadScene read = read_world(R"(Shape "curve"
Shape "curve" "point3 P" [0 0 0 1 0 0 2 0 0]
Shape "curve" "string basis" "bspline" "integer degree" 2 "point3 P" [0 0 0 1 0 0]
Shape "curve" "string type" "ribon" "integer degree" 4 "string basis" "catmull" "point3 P" [0 0 0 1 0 0 2 0 0 3 0 0]
Shape "curve" "string type" "ribbon" "point3 P" [0 0 0 1 0 0 2 0 0 3 0 0]
Shape "curve" "string type" "ribbon" "normal N" [0 0 1 0 0 0] "point3 P" [0 0 0 1 0 0 2 0 0 3 0 0]
Shape "curve" "float width" -1 "point3 P" [0 0 0 1 0 0 2 0 0 3 0 0])");
  const std::string what = "error: Shape \"curve\": ";
  EXPECT_THAT(
      read.messages,
      testing::ElementsAre(
          "scene:2: " + what + "'P', the control points, is missing",
          "scene:3: " + what + "3 control points; a bezier of degree 3 takes 4 and a multiple of 3 more",
          "scene:4: " + what + "2 control points; a bspline of degree 2 takes at least 3",
          "scene:5: " + what + "'type' is \"ribon\"; expected one of flat, ribbon, cylinder (did you mean 'ribbon'?)",
          "scene:5: " + what + "'basis' is \"catmull\"; expected one of bezier, bspline",
          "scene:5: " + what + "'degree' is 4; expected 2 or 3",
          "scene:6: " + what + "0 normals for a ribbon of 1 segments; expected 2",
          "scene:7: " + what + "a normal of length 0", "scene:8: " + what + "'width' is -1, but must be at least 0"));
  EXPECT_EQ(read.count<Geometry>(), 0u);
  const ReadScene lit = read_good("AreaLightSource \"diffuse\"\n" + one +
                                  "Shape \"curve\" \"normal N\" [0 0 1] \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0]");
  EXPECT_EQ(lit.count<Light>(), 0u);
  EXPECT_THAT(lit.messages, testing::ElementsAre(
                                "scene:3: warning: curves emit no light, as in pbrt; this AreaLightSource does nothing",
                                "scene:4: warning: Shape \"curve\": 'N' means nothing but for the type \"ribbon\""));
}

}  // namespace
}  // namespace metamer
