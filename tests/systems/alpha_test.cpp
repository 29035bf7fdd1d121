// Alpha: the chance that a ray meets a surface at all.
#include "tests/systems/support/textured_scene.h"

namespace metamer {
namespace {

Geometry masked(Geometry geometry, TextureId alpha) {
  geometry.alpha_texture = alpha;
  return geometry;
}

// A black sheet of the geometry before a white sky, seen along -z: what of the sky is left.
double seen_through(TexturedScene& s, const Geometry& geometry, double x, double y, double width = 0.5) {
  s.b.scene.settings.integrator = Integrator::path;
  s.b.scene.settings.samples_per_pixel = 64;
  s.b.add(geometry, s.b.diffuse(0.0));
  s.b.light(LightKind::environment, s.b.constant(1), 1);
  s.b.look_at({x, y, 3}, {x, y, 0}, orthographic(static_cast<float>(width)));
  return mean(trace_radiances(*s.b.freeze()));
}

// 1024 rays, each with a number of its own: 5 standard deviations are at most 0.08.
TEST(Alpha, LetsThatShareOfRaysPass) {
  TexturedScene sheet, ball;
  EXPECT_NEAR(seen_through(sheet, masked(rectangle(2, 2), sheet.number(0.3f)), 0, 0), 0.7, 0.08);
  // In at one side, out at the other: two chances.
  EXPECT_NEAR(seen_through(ball, masked(sphere(1), ball.number(0.3f)), 0, 0), 0.49, 0.08);
}

TEST(Alpha, OfZeroIsNotThereAndOfOneIsNoMask) {
  TexturedScene none, all;
  EXPECT_EQ(seen_through(none, masked(rectangle(2, 2), none.number(0)), 0, 0), 1);
  EXPECT_EQ(seen_through(all, masked(rectangle(2, 2), all.number(1)), 0, 0), 0);
}

TEST(Alpha, OfATextureCutsShapesOut) {
  for (const bool round : {false, true}) {
    for (const double x : {-0.5, 0.5}) {
      TexturedScene s;
      Texture halves = s.greys(2, 1, {0, 1});  // left and right; around a sphere y > 0 and y < 0
      halves.is_number = 1;
      const TextureId alpha = s.add(halves);
      const double seen = round ? seen_through(s, masked(sphere(1), alpha), 0, -x, 0.1)
                                : seen_through(s, masked(rectangle(2, 2), alpha), x, 0, 0.1);
      EXPECT_EQ(seen, x < 0 ? 1 : 0) << round;
    }
  }
}

TEST(Alpha, OfInstancesIsTheirOwn) {
  TexturedScene s;
  s.b.scene.meshes.push_back(cube_mesh());
  s.b.add(mesh(0), s.b.diffuse(0.0));
  s.b.add(masked(mesh(0), s.number(0.5f)), s.b.diffuse(0.0), moved(3, 0, 0));
  s.b.scene.settings.integrator = Integrator::path;
  s.b.scene.settings.samples_per_pixel = 64;
  s.b.light(LightKind::environment, s.b.constant(1), 1);
  Scene other = s.b.scene;
  s.b.look_at({0, 0, 3}, {0, 0, 0}, orthographic(0.5f));
  EXPECT_EQ(mean(trace_radiances(*s.b.freeze())), 0);
  s.b.scene = other;
  s.b.look_at({3, 0, 3}, {3, 0, 0}, orthographic(0.5f));
  EXPECT_NEAR(mean(trace_radiances(*s.b.freeze())), 0.25, 0.08);
}

// A floor under parallel light, a sheet of alpha 0.3 above it.
TEST(Alpha, LetsShadowRaysPassToo) {
  TexturedScene s;
  s.b.scene.settings.samples_per_pixel = 64;
  s.b.scene.settings.integrator = Integrator::path;
  s.b.add(rectangle(4, 4), s.b.diffuse(1.0));
  s.b.add(masked(rectangle(2, 2), s.number(0.3f)), s.b.diffuse(0.0), moved(0, 0, 1));
  s.b.light(LightKind::directional, s.b.constant(pi), 1);
  s.b.look_at({0, 3, 0.5}, {0, 0, 0}, orthographic(0.5f), {0, 0, 1});
  EXPECT_NEAR(mean(trace_radiances(*s.b.freeze())), 0.7, 0.08);
}

// pbrt's invisible lamps: a lamp of alpha 0 shines, but nothing sees it.
TEST(Alpha, OfZeroOnALampHidesItAndLeavesItsLight) {
  const auto floor = [](float alpha, bool look_up) {
    TexturedScene s;
    s.b.scene.settings.integrator = Integrator::path;
    s.b.scene.settings.samples_per_pixel = 256;
    s.b.add(rectangle(4, 4), s.b.diffuse(0.5));
    Geometry lamp = rectangle(1, 1);
    lamp.flip_normal = 1;  // shines down
    s.b.emit(s.b.add(masked(lamp, s.number(alpha)), s.b.diffuse(0.0), moved(0, 0, 1)), s.b.constant(1), 1);
    if (look_up)
      s.b.look_at({0, 0, 0.5}, {0, 0, 1}, orthographic(0.1f));
    else
      s.b.look_at({0, 2, 0.5}, {0, 0, 0}, orthographic(0.1f), {0, 0, 1});
    return mean(trace_radiances(*s.b.freeze()));
  };
  EXPECT_NEAR(floor(0, false), floor(1, false), 0.01 * floor(1, false));
  EXPECT_EQ(floor(0, true), 0);
  EXPECT_EQ(floor(1, true), 1);
  // Half of it is there: half of its light, half of the times it is seen.
  EXPECT_NEAR(floor(0.5f, false), 0.5 * floor(1, false), 0.05 * floor(1, false));
  EXPECT_NEAR(floor(0.5f, true), 0.5, 0.04);
}

TEST(Alpha, DoesNotDependOnThreadsOrTiles) {
  TexturedScene s;
  s.b.scene.settings.integrator = Integrator::path;
  s.b.scene.settings.width = s.b.scene.settings.height = 32;
  s.b.scene.settings.max_depth = 4;
  s.b.add(masked(sphere(1), s.number(0.4f)), s.b.diffuse(0.7));
  s.b.add(masked(rectangle(3, 3), s.number(0.6f)), s.b.diffuse(0.5), moved(0, 0, -1));
  s.b.light(LightKind::environment, s.b.constant(1), 1);
  s.b.look_at({0, 0.5, 3}, {0, 0, 0}, perspective(50));
  const auto world = s.b.freeze();
  const Film one = render_film(*world, {1, 32}), many = render_film(*world, {3, 8});
  EXPECT_TRUE(one == many);
}

}  // namespace
}  // namespace metamer
