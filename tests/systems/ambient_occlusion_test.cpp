// Ambient occlusion against what can be calculated.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/systems/support/scene_builder.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;

// A floor seen from above, 2 m wide, with a wall at x = 1 m that stands on it, high and wide.
struct Corner {
  SceneBuilder b{8, 8, 1024, 0};
  explicit Corner(float distance, bool has_wall = true) {
    b.scene.settings.integrator = Integrator::ambient_occlusion;
    b.scene.settings.occlusion_distance = distance;
    b.look_at({0, 0, 50}, {0, 0, 0}, orthographic(2));
    b.add(rectangle(2000, 2000), b.diffuse(0.3));
    if (has_wall) b.add(rectangle(2000, 2000), b.diffuse(0.9), moved(1, 0, 0) * turned(90, 0, 1, 0));
    b.light(LightKind::point, unit_spectrum, 1000, moved(0, 0, 1));
  }
  // Mean luminance of each column of pixels.
  std::vector<double> columns() {
    const Film film = render_film(*b.freeze());
    std::vector<double> y(8, 0.0);
    for (size_t p = 0; p < film.sums().size(); ++p) y[p % 8] += mean_xyz(film, p)[1] / 8;
    return y;
  }
};

TEST(AmbientOcclusion, AnOpenFloorIsWhiteWhateverLightsIt) {
  for (const ColorMode mode : {ColorMode::spectral, ColorMode::rgb}) {
    Corner open(INFINITY, false);
    open.b.scene.settings.color = mode;
    for (const double y : open.columns()) EXPECT_NEAR(y, 1, 0.01);
  }
}

TEST(AmbientOcclusion, BesideAnEndlessWallHalfIsOpen) {
  for (const double y : Corner(INFINITY).columns()) EXPECT_NEAR(y, 0.5, 0.01);
}

// Directions that meet the wall at distance d within r have more than d / r along x: of the unit disc that
// cosine-weighted directions fall onto evenly, a segment.
TEST(AmbientOcclusion, WhatIsFartherThanTheDistanceDoesNotCount) {
  const std::vector<double> y = Corner(0.8f).columns();
  for (size_t column = 0; column < 8; ++column) {
    double open = 0;
    for (int k = 0; k < 100; ++k) {
      const double d = 1 - (-1 + (double(column) + (k + 0.5) / 100) / 4), c = std::min(1.0, d / 0.8);
      open += (1 - (std::acos(c) - c * std::sqrt(1 - c * c)) / pi) / 100;
    }
    EXPECT_NEAR(y[column], open, 0.01) << column;
  }
}

TEST(AmbientOcclusion, WhatTheEyeMissesIsBlack) {
  SceneBuilder b(4, 4, 4, 0);
  b.scene.settings.integrator = Integrator::ambient_occlusion;
  b.look_at({0, 0, 5}, {0, 0, 0}, perspective(40));
  b.light(LightKind::environment, unit_spectrum, 1);
  const Film film = render_film(*b.freeze());
  for (size_t p = 0; p < film.sums().size(); ++p) EXPECT_EQ(mean_xyz(film, p)[1], 0);
}

}  // namespace
}  // namespace metamer
