// Rays that start on a surface neither pass through it (leaks) nor find it again (acne), at every scale and place.
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

// A sphere of triangles around the origin, counter-clockwise from outside.
Mesh ball_mesh(uint32_t rings, uint32_t spokes, bool smooth) {
  Mesh mesh;
  constexpr double pi = 3.14159265358979323846;
  for (uint32_t i = 0; i <= rings; ++i)
    for (uint32_t j = 0; j <= spokes; ++j) {
      const double theta = pi * i / rings, phi = 2 * pi * (j % spokes) / spokes;
      const double r = i == 0 || i == rings ? 0 : std::sin(theta);
      const glm::vec3 p(r * std::cos(phi), r * std::sin(phi), std::cos(theta));
      mesh.positions.push_back(p);
      if (smooth) mesh.normals.push_back(p);
    }
  for (uint32_t i = 0; i < rings; ++i)
    for (uint32_t j = 0; j < spokes; ++j) {
      const uint32_t a = i * (spokes + 1) + j, b = a + spokes + 1;
      if (i > 0)
        for (const uint32_t index : {a, b, a + 1}) mesh.indices.push_back(index);
      if (i + 1 < rings)
        for (const uint32_t index : {a + 1, b, b + 1}) mesh.indices.push_back(index);
    }
  return mesh;
}

enum class Body { cube, faceted_ball, sphere };
const char* name_of(Body body) {
  return body == Body::cube ? "cube" : body == Body::sphere ? "sphere" : "faceted ball";
}

// The body of half size 1, turned so that nothing is aligned with an axis unless asked for.
void add_body(SceneBuilder& b, Body body, double reflectance, const glm::dmat4& place, bool aligned) {
  const glm::dmat4 turn = aligned ? glm::dmat4(1) : turned(33, 0.3, 0.5, 0.8);
  if (body == Body::cube) {
    b.scene.meshes.push_back(cube_mesh());
    b.add(mesh(0), b.diffuse(reflectance), place * turn * stretched(2, 2, 2));
  } else if (body == Body::faceted_ball) {
    b.scene.meshes.push_back(ball_mesh(24, 48, false));
    b.add(mesh(0), b.diffuse(reflectance), place * turn);
  } else {
    b.add(sphere(1), b.diffuse(reflectance), place * turn);
  }
}

constexpr double scales[] = {1e-3, 1, 1e3, 1e6};
constexpr double places[] = {0, 30, 1000};  // distance from the origin in units of the body's size

// All light is outside a closed body: whatever arrives inside leaked. What does is counted, in pixels of 64 samples
// with any light. Near the origin Embree alone lets rays through, between triangles, as it is not asked to be
// watertight (2 of 11 million; with RTC_SCENE_FLAG_ROBUST none). A thousand sizes away float keeps 14 bits of a body,
// and a hit that near an edge may lie beyond the neighbouring wall (21 of 6 million).
TEST(Leaks, AClosedBodyIsBlackInside) {
  uint64_t rays[2] = {}, leaks[2] = {};
  for (const Body body : {Body::cube, Body::faceted_ball, Body::sphere})
    for (const double scale : scales)
      for (const double place : places)
        for (const bool aligned : {true, false}) {
          SceneBuilder b(16, 16, 64, 12);
          const glm::dvec3 centre = glm::dvec3(0.6, -0.5, 0.62) * place * scale;
          add_body(b, body, 0.95, moved(centre.x, centre.y, centre.z) * stretched(scale, scale, scale), aligned);
          b.light(LightKind::environment, unit_spectrum, 1);
          b.look_at(centre, centre + glm::dvec3(0.3, 0.2, 1), perspective(100));
          RenderStats stats;
          const Film film = render_film(*b.freeze(), {1, 16}, &stats);
          const size_t far = place > 100;
          rays[far] += stats.counters.camera_rays + stats.counters.bounce_rays + stats.counters.shadow_rays;
          uint64_t here = 0;
          for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel) here += mean_xyz(film, pixel)[1] != 0;
          leaks[far] += here;
          EXPECT_EQ(body == Body::sphere ? here : 0, 0u) << "sphere of size " << scale << " at " << place;
          EXPECT_LE(here, 12u) << name_of(body) << " of size " << scale << " at " << place;
        }
  EXPECT_GT(rays[0], 10'000'000u);
  EXPECT_GT(rays[1], 5'000'000u);
  EXPECT_LE(leaks[0], 6u) << "of " << rays[0] << " rays";
  EXPECT_LE(leaks[1], 60u) << "of " << rays[1] << " rays";
}

// From a convex body no ray meets it again: a bounce after the first is acne.
TEST(Leaks, AConvexBodyNeverMeetsItself) {
  for (const Body body : {Body::cube, Body::faceted_ball, Body::sphere})
    for (const double scale : scales)
      for (const double place : places) {
        uint64_t bounces[2];
        for (const uint32_t depth : {1u, 4u}) {
          SceneBuilder b(16, 16, 256, depth);
          const glm::dvec3 centre = glm::dvec3(0.6, -0.5, 0.62) * place * scale;
          add_body(b, body, 1.0, moved(centre.x, centre.y, centre.z) * stretched(scale, scale, scale), false);
          b.light(LightKind::environment, unit_spectrum, 1);
          b.look_at(centre + glm::dvec3(0, 1, 4) * scale, centre, perspective(35));
          RenderStats stats;
          render_film(*b.freeze(), {1, 16}, &stats);
          bounces[depth == 4] = stats.counters.bounce_rays;
        }
        EXPECT_GT(bounces[0], 10'000u);
        EXPECT_EQ(bounces[1] - bounces[0], 0u)
            << name_of(body) << " of size " << scale << " at " << place << ", of " << bounces[0];
      }
}

// Light from the viewer's side of a plane, down to grazing: no path may be shadowed by the plane itself.
TEST(Leaks, APlaneIsLitEvenlyAtEveryScaleAndPlace) {
  constexpr double pi = 3.14159265358979323846;
  for (const double scale : scales)
    for (const double place : places)
      for (const double degrees : {0.0, 45.0, 80.0, 89.0}) {
        SceneBuilder b(16, 16, 16, 1);
        const glm::dvec3 centre = glm::dvec3(0.6, -0.5, 0.62) * place * scale;
        const glm::dmat4 turn = turned(25, 0.2, 1, 0.4);
        b.add(rectangle(8, 8), b.diffuse(0.8),
              moved(centre.x, centre.y, centre.z) * turn * stretched(scale, scale, scale));
        b.light(LightKind::directional, unit_spectrum, 1, turn * turned(degrees, 1, 0, 0));
        const glm::dvec3 away = glm::dvec3(turn * glm::dvec4(0.4, 0.3, 1, 0));
        b.look_at(centre + away * 3.0 * scale, centre, perspective(40));
        const double wanted = 0.8 / pi * std::cos(degrees * pi / 180);
        SCOPED_TRACE(testing::Message() << "size " << scale << " at " << place << ", light at " << degrees);
        // A plane's normal is as uncertain as its corners are; grazing light shows it.
        const double tolerance = 1e-3 + 6e-8 * place * std::tan(degrees * pi / 180);
        expect_every_path(
            trace_radiances(*b.freeze()), [&](double) { return wanted; }, tolerance);
      }
}

// The wider a plane's triangles, the farther off new rays start: a lamp close to it must not shadow itself for that.
// A disk of radius r at height h over a diffuse plane gives it an irradiance of pi L r^2 / (r^2 + h^2).
TEST(Leaks, ALampCloseToAWidePlaneIsSeen) {
  for (const float width : {1.0f, 100.0f, 1000.0f}) {
    SCOPED_TRACE(width);
    SceneBuilder b(16, 16, 64, 1);
    b.add(rectangle(width, width), b.diffuse(0.8));
    const Entity lamp = b.add(disk(0.25f), b.diffuse(0.0), moved(0, 0, 0.5) * turned(180, 1, 0, 0));
    b.emit(lamp, unit_spectrum, 1);
    b.look_at({0.1, 0.9, 0.2}, {0, 0, 0}, perspective(0.1f));
    const auto wanted = [](double) { return 0.8 * 0.0625 / (0.0625 + 0.25); };
    expect_mean(trace_radiances(*b.freeze()), wanted, 0.02);
  }
}

}  // namespace
}  // namespace metamer
