// Scenes at and beyond the ends of single precision: refused with a word, or rendered; never a crash.
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

// Debian's Embree stops the program over a ray with an infinite coordinate.
TEST(Extremes, CameraRaysThatCannotBeTracedAreRefusedAndCounted) {
  Camera lens = perspective(45);
  lens.lens_radius = 1e30f;
  for (const Camera& camera : {orthographic(1e30f), lens}) {
    SceneBuilder b(8, 8, 4, 4);
    b.add(sphere(1), b.diffuse(0.5));
    b.light(LightKind::environment, unit_spectrum, 1);
    b.look_at({0, 0, 4}, {0, 0, 0}, camera);
    RenderStats stats;
    const Film film = render_film(*b.freeze(), {1, 16}, &stats);
    EXPECT_EQ(stats.counters.invalid_samples, 8u * 8 * 4);
    EXPECT_EQ(mean_xyz(film, 0)[1], 0);
  }
}

TEST(Extremes, ShapesOutOfReachAreRefused) {
  const auto mistakes = [](const Geometry& shape, const glm::dmat4& matrix) {
    SceneBuilder b(8, 8, 1, 1);
    b.scene.meshes.push_back(cube_mesh());
    b.add(shape, b.diffuse(0.5), matrix);
    b.look_at({0, 0, 4}, {0, 0, 0}, perspective(45));
    Diagnostics diagnostics;
    freeze(b.scene, diagnostics);
    return diagnostics.error_count();
  };
  EXPECT_EQ(mistakes(sphere(3e38f), glm::dmat4(1)), 1u);
  EXPECT_EQ(mistakes(disk(1), moved(0, 1e19, 0)), 1u);
  EXPECT_EQ(mistakes(rectangle(1e15f, 1), stretched(1e5, 1, 1)), 1u);
  EXPECT_EQ(mistakes(mesh(0), stretched(1e19, 1e19, 1e19)), 1u);
  EXPECT_EQ(mistakes(mesh(0), stretched(1e-37, 1e-37, 1e-37)), 1u);
  EXPECT_EQ(mistakes(mesh(0), stretched(1e17, 1e17, 1e17)), 0u);
  EXPECT_EQ(mistakes(sphere(1), stretched(1e-15, 1e-15, 1e-15)), 0u);
}

// A white plane in sunlight, from a nanometre to a thousand million kilometres wide.
TEST(Extremes, APlaneIsLitTheSameAtAnySize) {
  constexpr double pi = 3.14159265358979323846;
  for (const double scale : {1e-9, 1e-6, 1e6, 1e9, 1e12}) {
    SCOPED_TRACE(scale);
    SceneBuilder b(8, 8, 4, 1);
    b.add(rectangle(8, 8), b.diffuse(1.0), turned(25, 0.2, 1, 0.4) * stretched(scale, scale, scale));
    b.light(LightKind::directional, unit_spectrum, 1, turned(25, 0.2, 1, 0.4));
    const glm::dvec3 away(turned(25, 0.2, 1, 0.4) * glm::dvec4(0.4, 0.3, 1, 0));
    b.look_at(away * 3.0 * scale, {0, 0, 0}, perspective(40));
    const auto wanted = [](double) { return 1 / pi; };
    expect_every_path(trace_radiances(*b.freeze()), wanted, 1e-3);
  }
}

}  // namespace
}  // namespace metamer
