// RenderSettings::clamp_indirect against closed forms: light scattered more than once is limited, all other is not.
#include "tests/support/chi_square.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

// A closed sphere of reflectance one half that emits 1 inwards: 1 of its own, 1/2 scattered once, 1/2 more often.
SceneBuilder glowing_sphere() {
  SceneBuilder b(16, 16, 256, 60);
  b.emit(b.add(sphere(1), b.diffuse(0.5)), unit_spectrum, 1, true);
  b.look_at({0, 0, 0.5}, {0, 0, 0}, perspective(60));
  return b;
}

// A wall of luminance 1000 cd/m^2 behind a pane of so many sides that does nothing.
double luminance_through(uint32_t surfaces, float clamp, ColorMode color) {
  SceneBuilder b(8, 8, 64, 10);
  b.scene.settings.color = color;
  b.scene.settings.clamp_indirect = clamp;
  const double white = b.scene.spectra.luminance(unit_spectrum);
  b.emit(b.add(rectangle(10, 10), b.diffuse(0.0)), unit_spectrum, static_cast<float>(1000 / white), true);
  for (uint32_t i = 0; i < surfaces; ++i)
    b.add(rectangle(10, 10), b.dielectric(b.constant(1)), moved(0, 0, 1.0 + i) * turned(i % 2 ? 180 : 0, 1, 0, 0));
  b.look_at({0, 0, 9}, {0, 0, 0}, perspective(30));
  const Film film = render_film(*b.freeze());
  double sum = 0;
  for (size_t p = 0; p < film.sums().size(); ++p) sum += mean_xyz(film, p)[1];
  return sum / static_cast<double>(film.sums().size());
}

TEST(ClampIndirect, TakesWhatWasScatteredMoreThanOnceAndNothingElse) {
  SceneBuilder b = glowing_sphere();
  expect_mean(
      trace_radiances(*b.freeze()), [](double) { return 2.0; }, 0.02);
  b.scene.settings.clamp_indirect = 1e-6f;
  expect_mean(
      trace_radiances(*b.freeze()), [](double) { return 1.5; }, 0.02);
}

TEST(ClampIndirect, LimitsALuminance) {
  for (const ColorMode color : {ColorMode::spectral, ColorMode::rgb}) {
    EXPECT_EQ(luminance_through(1, 100, color), luminance_through(1, INFINITY, color));
    const double free = luminance_through(2, INFINITY, color);
    EXPECT_NEAR(free, 1000, 20);
    // In RGB the mean of the channels stands for the luminance.
    EXPECT_NEAR(luminance_through(2, 250, color) / free, 0.25, color == ColorMode::rgb ? 0.01 : 1e-5);
    EXPECT_EQ(luminance_through(2, 1100, color), free);
  }
}

}  // namespace
}  // namespace metamer
