// Cylinders and parts of spheres and disks.
#include <gtest/gtest.h>

#include <random>

#include "systems/light_rows.h"
#include "tests/reference_scene.h"
#include "tests/systems/support/agreement.h"
#include "tests/systems/support/radiances.h"
#include "tests/systems/support/trace.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;

Geometry part(Geometry geometry, float z_min, float z_max, float phi_max_deg) {
  geometry.z_min = z_min;
  geometry.z_max = z_max;
  geometry.phi_max_deg = phi_max_deg;
  return geometry;
}
Geometry cylinder(float radius, float z_min, float z_max, float phi_max_deg = 360) {
  Geometry geometry;
  geometry.kind = ShapeKind::cylinder;
  geometry.radius = radius;
  return part(geometry, z_min, z_max, phi_max_deg);
}
constexpr float endless = std::numeric_limits<float>::infinity();

std::unique_ptr<World> world_of(const Geometry& geometry, const glm::dmat4& place = glm::dmat4(1)) {
  SceneBuilder b(8, 8, 1, 1);
  b.add(geometry, b.conductor(b.named("Au.n"), b.named("Au.k"), 0.2f, 0.4f), place);
  b.look_at({0, 0, 50}, {0, 0, 0}, perspective(40));
  return b.freeze();
}

TEST(Quadrics, ACylinderIsMetFromOutsideInsideAndNotAlongItsAxis) {
  const std::unique_ptr<World> world = world_of(cylinder(2, -1, 3));
  const TestHit outside = trace(*world, {5, 0, 1}, {-1, 0, 0});
  ASSERT_TRUE(outside.met);
  EXPECT_NEAR(outside.distance, 3, 1e-6);
  EXPECT_NEAR(glm::length(outside.normal - glm::dvec3(1, 0, 0)), 0, 1e-6);
  EXPECT_NEAR(std::abs(outside.tangent.y), 1, 1e-6);
  const TestHit inside = trace(*world, {0, 0, 0}, {0, 3, 5});
  EXPECT_FALSE(inside.met) << "out of the open end: 2 away from the axis it is 10/3 high";
  const TestHit wall = trace(*world, {0, 0, 0}, {0, 4, 3});
  ASSERT_TRUE(wall.met);
  EXPECT_NEAR(wall.distance, 2.5, 1e-6);
  EXPECT_NEAR(wall.normal.y, 1, 1e-6) << "outwards, whoever looks";
  EXPECT_FALSE(trace(*world, {0, 0, -5}, {0, 0, 1}).met);
  EXPECT_FALSE(trace(*world, {2.001, 0, -5}, {0, 0, 1}).met);
  // Above the near rim, below the far one.
  const TestHit far = trace(*world, {5, 0, 4}, {-7, 0, -2});
  ASSERT_TRUE(far.met);
  EXPECT_NEAR(far.position.x, -2, 1e-5);
}

TEST(Quadrics, EveryAngleCutsWhereItSays) {
  for (const float phi_max : {10.f, 89.f, 90.f, 91.f, 180.f, 200.f, 270.f, 359.f, 360.f})
    for (const Geometry& shape : {cylinder(1, -1, 1, phi_max), part(sphere(1), -endless, endless, phi_max),
                                  part(disk(1), -endless, endless, phi_max)}) {
      const std::unique_ptr<World> world = world_of(shape);
      std::vector<TestRay> rays;
      for (double degrees = 0.5; degrees < 360; degrees += 1) {
        const double x = std::cos(degrees * pi / 180), y = std::sin(degrees * pi / 180);
        const bool is_disk = shape.kind == ShapeKind::disk;
        // From outside inwards, to shortly before the axis.
        const glm::dvec3 origin = is_disk ? glm::dvec3(0.5 * x, 0.5 * y, 2) : glm::dvec3(1.5 * x, 1.5 * y, 0);
        rays.push_back({origin, is_disk ? glm::dvec3(0, 0, -1) : glm::dvec3(-x, -y, 0)});
      }
      const std::vector<TestHit> hits = trace(*world, rays);
      for (size_t i = 0; i < hits.size(); ++i) {
        const bool first = hits[i].met && hits[i].distance < (shape.kind == ShapeKind::disk ? 3 : 1);
        EXPECT_EQ(first, double(i) + 0.5 < double{phi_max}) << i << " of " << phi_max << ", " << uint32_t(shape.kind);
      }
    }
}

TEST(Quadrics, PartsAgreeWithTheOracleUnderEveryTransformation) {
  const Geometry shapes[] = {cylinder(0.8f, -1, 0.7f, 250), part(sphere(1), -0.4f, 0.8f, 130),
                             part(sphere(1), -endless, 0.1f, 360), part(disk(1, 0.3f), 0, 0, 300)};
  const glm::dmat4 places[] = {glm::dmat4(1), turned(40, 1, 2, 3) * stretched(1, 2, 0.5), stretched(-1, 1, 1),
                               moved(3, -2, 1) * turned(100, 0, 1, 1) * stretched(0.5, -0.7, 0.6)};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (Geometry shape : shapes)
    for (const glm::dmat4& place : places)
      for (const uint32_t flip : {0u, 1u}) {
        shape.flip_normal = flip;
        const std::unique_ptr<World> world = world_of(shape, place);
        const ReferenceScene oracle(*world);
        std::vector<TestRay> rays(2000);
        for (TestRay& ray : rays) {
          const glm::dvec3 from(uniform(random), uniform(random), uniform(random));
          const glm::dvec3 to(uniform(random), uniform(random), uniform(random));
          ray.origin = glm::dvec3(glm::vec3(glm::dvec3(place * glm::dvec4(3.0 * from, 1))));
          ray.direction = glm::dvec3(glm::vec3(glm::normalize(glm::dvec3(place * glm::dvec4(to, 1)) - ray.origin)));
        }
        const std::vector<TestHit> hits = trace(*world, rays);
        size_t met = 0, different = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
          const ReferenceHit wanted = oracle.intersect(rays[i].origin, rays[i].direction, visible_to_bounces);
          const bool is_wanted = wanted.object != no_index;
          // Within rounding of an edge they may differ.
          if (hits[i].met != is_wanted || (is_wanted && std::abs(hits[i].distance - wanted.t) > 1e-3)) {
            ++different;
            continue;
          }
          if (!is_wanted) continue;
          ++met;
          EXPECT_LT(glm::length(hits[i].position - wanted.position), 2e-5);
          EXPECT_LT(glm::length(hits[i].normal - wanted.outside), 2e-4);
          EXPECT_LT(glm::length(hits[i].tangent - glm::normalize(wanted.tangent)), 2e-4);
        }
        EXPECT_GT(met, 150u);
        EXPECT_LE(different, 2u);
      }
}

// pbrt-v4, section 6.2 to 6.4: u is the part of phi_max, v of the height, of the polar angle, or from the rim inwards.
TEST(Quadrics, PartsHaveTheCoordinatesOfPbrt) {
  const auto coordinates = [](const Geometry& geometry, const glm::dvec3& point, const glm::dvec3& away) {
    SceneBuilder b(8, 8, 1, 1);
    b.add(geometry, b.diffuse(0.5));
    Curves far_away;  // asks for coordinates
    for (const float x : {0.0f, 1.0f, 2.0f, 3.0f}) far_away.points.push_back({x, 900, 0, 0.1f});
    far_away.segments.push_back(0);
    b.scene.curves.push_back(far_away);
    b.add({.kind = ShapeKind::flat_curves, .curves = 0}, b.diffuse(0.5));
    b.look_at({0, 0, 50}, {0, 0, 0}, perspective(40));
    const TestHit hit = trace(*b.freeze(), point + away, -away);
    EXPECT_TRUE(hit.met);
    return glm::dvec2(hit.u, hit.v);
  };
  const auto expect = [](const glm::dvec2& found, double u, double v) {
    EXPECT_NEAR(found.x, u, 1e-5);
    EXPECT_NEAR(found.y, v, 1e-5);
  };
  const double s = std::sqrt(0.5), r = std::sqrt(1 - 0.0625);
  expect(coordinates(cylinder(1, -1, 3, 180), {s, s, 0}, {s, s, 0}), 0.25, 0.25);
  expect(coordinates(cylinder(1, -1, 3), {s, -s, 2}, {s, -s, 0}), 0.875, 0.75);
  const Geometry zone = part(sphere(1), -0.5f, 0.5f, 90);
  expect(coordinates(zone, {s, s, 0}, {s, s, 0}), 0.5, 0.5);
  const double lowest = std::acos(-0.5), highest = std::acos(0.5);
  expect(coordinates(zone, {r * s, r * s, 0.25}, {s, s, 0}), 0.5, (std::acos(0.25) - lowest) / (highest - lowest));
  expect(coordinates(part(disk(1, 0.2f), 0, 0, 270), {-0.6 * s, 0.6 * s, 0}, {0, 0, 1}), 0.5, 0.5);
}

TEST(Quadrics, LightRowsKnowTheirArea) {
  const Light light;
  const auto area = [&](const Geometry& shape, const glm::dmat4& place) {
    const auto make = shape.kind == ShapeKind::sphere     ? sphere_light
                      : shape.kind == ShapeKind::cylinder ? cylinder_light
                                                          : disk_light;
    return double{make(place, shape, light).area};
  };
  const glm::dmat4 three = moved(1, 2, 3) * turned(30, 1, 1, 0) * stretched(3, 3, 3);
  EXPECT_NEAR(area(cylinder(2, -1, 0.5f, 90), three), 9 * 2 * pi * 2 * 1.5 / 4, 1e-4);
  // Archimedes: a zone has the area of the cylinder around it.
  EXPECT_NEAR(area(part(sphere(2), -1, 1.5f, 180), three), 9 * pi * 2 * 2.5, 2e-3);
  EXPECT_NEAR(area(part(sphere(2), -endless, 0, 360), three), 9 * 2 * pi * 4, 2e-3);
  EXPECT_NEAR(area(part(disk(2, 1), 0, 0, 60), three), 9 * pi * 3 / 6, 1e-4);
  // The perimeter of an ellipse of half axes 1 and 2, and half of a prolate spheroid's area, 1 : 1 : 2.
  EXPECT_NEAR(area(cylinder(1, 0, 1), stretched(1, 2, 3)), 3 * 9.688448220547676, 1e-4);
  const double e = std::sqrt(0.75);
  EXPECT_NEAR(area(part(sphere(1), 0, endless, 360), stretched(1, 1, 2)), pi * (1 + 2 / e * std::asin(e)), 2e-3);
}

// Albedo 1/2, emission 1/2: all of a closed can shines with radiance 1.
TEST(Quadrics, AClosedCanIsAFurnace) {
  SceneBuilder b(16, 16, 256, 60);
  Geometry wall = cylinder(1, -1, 1), top = disk(1), bottom = disk(1);
  wall.flip_normal = top.flip_normal = 1;
  top.height = 1;
  bottom.height = -1;
  for (const Geometry& shape : {wall, top, bottom})
    b.emit(b.add(shape, b.diffuse(0.5), turned(50, 1, 2, 0) * stretched(1, 1.5, 0.7)), unit_spectrum, 0.5f);
  b.look_at({0.2, 0, 0.1}, {0.6, 0.5, 0.3}, perspective(90));
  expect_mean(
      trace_radiances(*b.freeze()), [](double) { return 1.0; }, 0.02);
}

TEST(Quadrics, PartsAsLampsAgreeWithTheOracle) {
  SceneBuilder b(16, 16, 2048, 4);
  b.add(rectangle(6, 6), b.diffuse(0.5), moved(0, -1, 0) * turned(-90, 1, 0, 0));
  b.add(cylinder(0.3f, -0.5f, 0.6f, 300), b.conductor(b.named("Au.n"), b.named("Au.k"), 0.3f, 0.3f),
        moved(0, -0.5, 0) * turned(-70, 1, 0.2, 0));
  b.emit(b.add(cylinder(0.2f, -0.4f, 0.4f, 200), b.diffuse(0.3),
               moved(-0.8, 0.3, 0) * turned(60, 1, 1, 0) * stretched(1, -1.5, 1)),
         b.named("D65"), 0.01f, true);
  b.emit(b.add(part(sphere(0.4f), -0.3f, 0.2f, 250), b.diffuse(0.3), moved(0.7, 0.2, 0.1) * turned(40, 1, 1, 0)),
         b.named("A"), 0.01f);
  b.emit(b.add(part(disk(0.4f, 0.1f), 0, 0, 100), b.diffuse(0.3), moved(0, 0.9, 0) * turned(80, 1, 0, 0)),
         b.named("D50"), 0.01f);
  b.look_at({0, 0, 3.7}, {0, 0, 0}, perspective(40));
  expect_agreement(*b.freeze(), 2048, 0.02);
}

}  // namespace
}  // namespace metamer
