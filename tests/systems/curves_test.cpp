// Flat, round and oriented curves: where they are, what their normals are, and that rays leave them.
#include <gtest/gtest.h>

#include <random>

#include "tests/systems/support/radiances.h"
#include "tests/systems/support/trace.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;

struct BezierPoints {
  glm::dvec3 p[4];
  double width0 = 0.2, width1 = 0.2;
  glm::dvec3 at(double u) const {
    const double v = 1 - u;
    return v * v * v * p[0] + 3 * v * v * u * p[1] + 3 * v * u * u * p[2] + u * u * u * p[3];
  }
};
const BezierPoints straight{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}};

Curves curves_of(const BezierPoints& bezier, const glm::vec3& n0 = glm::vec3(0), const glm::vec3& n1 = glm::vec3(0)) {
  Curves curves;
  for (int k = 0; k < 4; ++k) {
    const double width = bezier.width0 + (bezier.width1 - bezier.width0) * k / 3;
    curves.points.push_back(glm::vec4(glm::vec3(bezier.p[k]), float(width / 2)));
    if (n0 != glm::vec3(0)) curves.normals.push_back(n0 + (n1 - n0) * (float(k) / 3));
  }
  curves.segments.push_back(0);
  return curves;
}

// `users`: how often the curves are shown; more than once makes instances of them.
std::unique_ptr<World> world_of(const Curves& curves, ShapeKind kind, const glm::dmat4& place = glm::dmat4(1),
                                int users = 1, bool flip = false) {
  SceneBuilder b(8, 8, 1, 1);
  b.scene.curves.push_back(curves);
  Geometry geometry;
  geometry.kind = kind;
  geometry.curves = 0;
  geometry.flip_normal = flip;
  const Material gold = b.conductor(b.named("Au.n"), b.named("Au.k"), 0.2f, 0.4f);  // asks for tangents
  b.add(geometry, gold, place);
  for (int i = 1; i < users; ++i) b.add(geometry, gold, moved(1000 * i, 0, 0) * place);
  b.look_at({0, 0, 50}, {0, 0, 0}, perspective(40));
  return b.freeze();
}

void expect_vector(const glm::dvec3& found, const glm::dvec3& wanted, double tolerance = 1e-4) {
  EXPECT_LT(glm::length(found - wanted), tolerance)
      << found.x << " " << found.y << " " << found.z << ", not " << wanted.x << " " << wanted.y << " " << wanted.z;
}

TEST(Curves, AStraightFlatCurveIsARectangleTurnedToTheRay) {
  const std::unique_ptr<World> world = world_of(curves_of(straight), ShapeKind::flat_curves);
  for (const double x : {0.01, 0.7, 1.5, 2.99})
    for (const double y : {-0.099, -0.05, 0.0, 0.05, 0.099})
      for (const double turn : {0.0, 40.0, 130.0, 270.0}) {
        // Seen from any side around it, at `y` from its middle.
        const double c = std::cos(turn * pi / 180), s = std::sin(turn * pi / 180);
        const glm::dvec3 towards(0, s, c), left(0, c, -s);
        const TestHit hit = trace(*world, glm::dvec3(x, 0, 0) + 5.0 * towards + y * left, -towards);
        ASSERT_TRUE(hit.met) << x << " " << y << " " << turn;
        EXPECT_NEAR(hit.distance, 5, 1e-5);
        expect_vector(hit.normal, towards);
        expect_vector(hit.tangent, {1, 0, 0});
      }
  for (const glm::dvec3& beside : {glm::dvec3(1, 0.101, 0), {1, -0.101, 0}, {-0.01, 0, 0}, {3.01, 0, 0}})
    EXPECT_FALSE(trace(*world, beside + glm::dvec3(0, 0, 5), {0, 0, -1}).met);
  // Aslant the normal stays perpendicular to the curve and on the side of the ray.
  // v counts to the left of the tangent for who looks along the ray: there, with z up and the curve to the right, down.
  const TestHit left = trace(*world, {1, 0.05, 5}, {0, 0, -1});
  EXPECT_NEAR(left.u, 1.0 / 3, 1e-4);
  EXPECT_NEAR(left.v, 0.25, 1e-4);
  const TestHit aslant = trace(*world, {0.5, 0, 1}, {1, 0, -1});
  expect_vector(aslant.normal, {0, 0, 1});
  EXPECT_NEAR(aslant.distance, std::sqrt(2), 1e-5);
}

TEST(Curves, TheWidthRunsEvenlyFromEndToEnd) {
  BezierPoints tapered = straight;
  tapered.width0 = 0.4;
  tapered.width1 = 0;
  const std::unique_ptr<World> world = world_of(curves_of(tapered), ShapeKind::flat_curves);
  for (const double u : {0.1, 0.5, 0.9}) {
    const double half = 0.2 * (1 - u);
    EXPECT_TRUE(trace(*world, {3 * u, 0.97 * half, 5}, {0, 0, -1}).met) << u;
    EXPECT_FALSE(trace(*world, {3 * u, 1.03 * half, 5}, {0, 0, -1}).met) << u;
  }
}

// pbrt: the angle to the side seen goes evenly from -90 to 90 degrees across the width.
TEST(Curves, RoundCurvesHaveTheNormalsOfATube) {
  const std::unique_ptr<World> world = world_of(curves_of(straight), ShapeKind::round_curves);
  for (const double v : {0.02, 0.25, 0.5, 0.75, 0.98}) {
    const double y = 0.2 * (v - 0.5), angle = (v - 0.5) * pi;
    expect_vector(trace(*world, {1, y, 5}, {0, 0, -1}).normal, {0, std::sin(angle), std::cos(angle)}, 1e-3);
    expect_vector(trace(*world, {1, y, -5}, {0, 0, 1}).normal, {0, std::sin(angle), -std::cos(angle)}, 1e-3);
    expect_vector(
        trace(*world_of(curves_of(straight), ShapeKind::round_curves, glm::dmat4(1), 1, true), {1, y, 5}, {0, 0, -1})
            .normal,
        {0, -std::sin(angle), -std::cos(angle)}, 1e-3);
  }
}

TEST(Curves, RibbonsStandAsTheirNormalsSay) {
  const std::unique_ptr<World> world = world_of(curves_of(straight, {0, 0, 1}, {0, 0, 1}), ShapeKind::ribbons);
  const TestHit above = trace(*world, {1, 0.05, 5}, {0, 0, -1}), below = trace(*world, {1, 0.05, -5}, {0, 0, 1});
  ASSERT_TRUE(above.met && below.met);
  EXPECT_NEAR(above.distance, 5, 1e-4);
  expect_vector(above.normal, {0, 0, 1});
  expect_vector(below.normal, {0, 0, 1});
  EXPECT_FALSE(trace(*world, {1, 5, 0.01}, {0, -1, 0}).met) << "edge on";
  EXPECT_FALSE(trace(*world, {1, 0.11, 5}, {0, 0, -1}).met);
  // At 60 degrees it looks half as wide.
  EXPECT_TRUE(trace(*world, {1, 5 * std::sqrt(3) + 0.095, 5}, {0, -std::sqrt(3), -1}).met);
  EXPECT_FALSE(trace(*world, {1, 5 * std::sqrt(3) + 0.105, 5}, {0, -std::sqrt(3), -1}).met);
  // A quarter of a turn from end to end: half of it in the middle.
  const std::unique_ptr<World> twisted = world_of(curves_of(straight, {0, 0, 1}, {0, 1, 0}), ShapeKind::ribbons);
  expect_vector(trace(*twisted, {1.5, 5, 5}, {0, -1, -1}).normal, {0, std::sqrt(0.5), std::sqrt(0.5)}, 2e-3);
}

TEST(Curves, ABentCurveIsWhereItsPointsAre) {
  const BezierPoints bent{{{-1, -1, 0}, {2, -1, 0.5}, {-2, 1, -0.5}, {1, 1, 0}}, 0.1, 0.05};
  const std::unique_ptr<World> world = world_of(curves_of(bent), ShapeKind::flat_curves);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.3, 1.3);
  std::vector<TestRay> rays(1500);
  for (TestRay& ray : rays) ray = {{uniform(random), uniform(random), 5}, {0, 0, -1}};
  const std::vector<TestHit> hits = trace(*world, rays);
  size_t met = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    double nearest = 1e9, u = 0;
    for (int k = 0; k <= 1000; ++k) {
      const glm::dvec3 p = bent.at(k / 1000.0);
      const double d = std::hypot(p.x - rays[i].origin.x, p.y - rays[i].origin.y);
      if (d < nearest) nearest = d, u = k / 1000.0;
    }
    // As far as 1/20 of the greatest width the curve may be missed.
    const double half = (0.1 - 0.05 * u) / 2;
    if (u == 0 || u == 1 || std::abs(nearest - half) < 0.006) continue;
    EXPECT_EQ(hits[i].met, nearest < half) << rays[i].origin.x << " " << rays[i].origin.y << " at " << u;
    if (!hits[i].met) continue;
    ++met;
    EXPECT_NEAR(hits[i].position.z, bent.at(u).z, 0.03);
    EXPECT_GT(hits[i].normal.z, 0);
    EXPECT_NEAR(glm::dot(hits[i].normal, hits[i].tangent), 0, 1e-3);
    EXPECT_NEAR(hits[i].u, u, 0.01);
    EXPECT_NEAR(std::abs(hits[i].v - 0.5), nearest / (2 * half), 0.1);
  }
  EXPECT_GT(met, 30u);
  EXPECT_GT(world->objects.triangle_count[0], 1u) << "bends too much for one segment";
}

// Turned and scaled evenly, curves are moved into the world; as instances they are traced in their own space.
TEST(Curves, InstancesAreWhatMovedOnesAre) {
  const BezierPoints bent{{{-1, -1, 0}, {2, -1, 0.5}, {-2, 1, -0.5}, {1, 1, 0}}, 0.1, 0.05};
  const glm::dmat4 place = moved(0.3, 0.2, 0) * turned(30, 0, 0.2, 1) * stretched(0.8, 0.8, 0.8);
  for (const ShapeKind kind : {ShapeKind::flat_curves, ShapeKind::ribbons, ShapeKind::round_curves}) {
    const Curves curves = curves_of(bent, {0, 0, 1}, {0, 1, 1});
    const std::unique_ptr<World> alone = world_of(curves, kind, place), shared = world_of(curves, kind, place, 2);
    EXPECT_EQ(alone->objects.placement[0], 0u);
    EXPECT_NE(shared->objects.placement[0], 0u);
    std::vector<TestRay> rays;
    for (int i = 0; i < 10'000; ++i)
      rays.push_back({{-1 + 0.02 * (i % 100), -1 + 0.02 * (i / 100), 5}, glm::normalize(glm::dvec3(0, 0.1, -1))});
    const std::vector<TestHit> of_alone = trace(*alone, rays), of_shared = trace(*shared, rays);
    size_t met = 0, different = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const TestHit &a = of_alone[i], &b = of_shared[i];
      different += a.met != b.met;
      if (!a.met || !b.met) continue;
      ++met;
      different += glm::length(a.normal - b.normal) > 0.02 || std::abs(a.distance - b.distance) > 1e-3;
    }
    EXPECT_GT(met, 100u);
    EXPECT_LT(different, 10u) << uint32_t(kind);
  }
}

TEST(Curves, UnevenScalesAndMirrorsScaleTheWidthToo) {
  const glm::dmat4 place = stretched(-1, 3, 0.5);
  const std::unique_ptr<World> world = world_of(curves_of(straight), ShapeKind::round_curves, place);
  for (const double side : {1.0, -1.0}) {
    const TestHit hit = trace(*world, {-1, side * 0.15, 5}, {0, 0, -1});
    ASSERT_TRUE(hit.met);
    // Locally a quarter of the width from the middle, at 45 degrees; normals go by the inverse.
    expect_vector(hit.normal, glm::normalize(glm::dvec3(0, side / 3, 1 / 0.5)), 1e-3);
    EXPECT_FALSE(trace(*world, {-1, side * 0.31, 5}, {0, 0, -1}).met);
  }
}

// A fibre that is straight cannot light itself: in a furnace of radiance 1 it has its albedo, which lost rays that meet
// it again would lower.
TEST(Curves, RaysThatLeaveAFibreDoNotMeetItAgain) {
  for (const ShapeKind kind : {ShapeKind::flat_curves, ShapeKind::ribbons, ShapeKind::round_curves})
    for (const glm::dmat4& place :
         {glm::dmat4(1), stretched(1e-3, 1e-3, 1e-3), moved(1000, 0, 0), stretched(1, -2, 1)}) {
      SceneBuilder b(16, 16, 64, 4);
      b.light(LightKind::environment, unit_spectrum, 1);
      b.scene.curves.push_back(curves_of(straight, {0, 0, 1}, {0, 0, 1}));
      Geometry geometry;
      geometry.kind = kind;
      geometry.curves = 0;
      b.add(geometry, b.diffuse(0.5), place);
      const auto at = [&](const glm::dvec3& p) { return glm::dvec3(place * glm::dvec4(p, 1)); };
      const double height = glm::length(at({0, 0.1, 0}) - at({0, 0, 0}));
      b.look_at(at({1.5, 0, 2}), at({1.5, 0, 0}), orthographic(static_cast<float>(height)));
      expect_mean(
          trace_radiances(*b.freeze()), [](double) { return 0.5; }, 0.06);
    }
}

TEST(Curves, EmitNoLight) {
  SceneBuilder b(8, 8, 1, 1);
  b.scene.curves.push_back(curves_of(straight));
  Geometry geometry;
  geometry.kind = ShapeKind::flat_curves;
  geometry.curves = 0;
  b.emit(b.add(geometry, b.diffuse(0.5)), unit_spectrum, 1);
  b.look_at({0, 0, 5}, {0, 0, 0}, perspective(40));
  EXPECT_THROW(b.freeze(), std::runtime_error);
}

}  // namespace
}  // namespace metamer
