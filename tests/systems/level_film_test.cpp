// What the film records of scenes with closed-form answers, by local and recursive light transport: in X, Y and Z, in
// every band, and in RGB mode, each pixel is the answer times what the light source itself shows there.
#include <gtest/gtest.h>

#include <cmath>

#include "systems/bsdf/reference.h"
#include "tests/systems/support/scene_builder.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double tolerance = 1e-4;
const glm::dmat4 floor_up = turned(-90, 1, 0, 0);

struct Answer {
  const char* name;
  bool needs_recursion;
  double (*build)(SceneBuilder& b, SpectrumId light);  // returns radiance over that of a light source of scale 1
};

double lit_plane(SceneBuilder& b, SpectrumId light) {
  b.look_at({0.5, 1, 0.2}, {0, 0, 0}, orthographic(1e-5f), {0.3, 0.2, 0.9});
  b.add(rectangle(4, 4), b.diffuse(0.6), floor_up);
  b.light(LightKind::point, light, 2, moved(0, 2, 0));
  b.light(LightKind::directional, light, 1, turned(-90 + 60, 1, 0, 0));
  return 0.6 / pi * (2.0 / 4 + 0.5);
}
double mirrored_wall(SceneBuilder& b, SpectrumId light) {
  b.look_at({1, 1, 0}, {0, 0, 0}, orthographic(1e-5f), {0.3, 0.2, 0.9});
  b.add(rectangle(4, 4), b.conductor(b.constant(0.2), b.constant(3)), floor_up);
  b.add(rectangle(8, 8), b.diffuse(0.7), moved(-2, 0, 0) * turned(90, 0, 1, 0));
  b.light(LightKind::point, light, 3, moved(1, 2, 0));
  return reference::fresnel_conductor(0.2, 3, std::sqrt(0.5)) * 0.7 / pi * 3 / 9;
}
double slab(SceneBuilder& b, SpectrumId light) {
  b.look_at({1, 1, 0}, {0, 0, 0}, orthographic(1e-2f), {0.3, 0.2, 0.9});
  b.scene.meshes.push_back(cube_mesh());
  b.add(mesh(0), b.dielectric(b.constant(1.5)), moved(0, -0.05, 0) * stretched(100, 0.1, 100));
  b.emit(b.add(rectangle(500, 500), b.diffuse(0.0), moved(0, -1, 0) * floor_up), light, 1);
  const double f = reference::fresnel_dielectric(1.5, std::sqrt(0.5));
  return (1 - f) / (1 + f);
}
double source(SceneBuilder& b, SpectrumId light) {
  b.look_at({0, 1, 0}, {0, 0, 0}, orthographic(1e-5f), {0.3, 0.2, 0.9});
  b.emit(b.add(rectangle(1, 1), b.diffuse(0.0), floor_up), light, 1);
  return 1;
}
constexpr Answer answers[] = {
    {"a lit plane", false, lit_plane}, {"a wall in a mirror", true, mirrored_wall}, {"a slab of glass", true, slab}};

Film film_of(Integrator integrator, ColorMode color, uint32_t bands, double (*build)(SceneBuilder&, SpectrumId),
             double* answer) {
  SceneBuilder b(4, 4, 8, 40);
  b.scene.settings.integrator = integrator;
  b.scene.settings.color = color;
  b.scene.settings.band_count = bands;
  *answer = build(b, b.named("FL2"));
  return render_film(*b.freeze());
}

void expect_times(const Film& film, const Film& light, double answer) {
  for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel)
    for (size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(mean_xyz(film, pixel)[c] / mean_xyz(light, pixel)[c] / answer, 1, tolerance);
  size_t compared = 0;
  for (size_t i = 0; i < film.bands().size(); ++i) {
    EXPECT_EQ(film.bands()[i].weight, light.bands()[i].weight);
    if (light.bands()[i].weight_units() == 0) continue;
    EXPECT_NEAR(band_mean(film.bands()[i]) / band_mean(light.bands()[i]) / answer, 1, tolerance);
    ++compared;
  }
  EXPECT_GE(compared, film.band_count() > 0 ? film.pixel_count() * 10 : 0);
}

TEST(LevelFilm, HasTheClosedFormInEveryChannelAndBand) {
  for (const Answer& answer : answers)
    for (const Integrator integrator : {Integrator::local, Integrator::recursive})
      for (const ColorMode color : {ColorMode::spectral, ColorMode::rgb, ColorMode::lamps}) {
        if (answer.needs_recursion && integrator == Integrator::local) continue;
        SCOPED_TRACE(testing::Message() << answer.name << ", " << integrator_name(integrator) << ", "
                                        << color_mode_name(color));
        const uint32_t bands = color == ColorMode::spectral ? 36 : 0;
        double factor = 0, one = 0;
        const Film film = film_of(integrator, color, bands, answer.build, &factor);
        expect_times(film, film_of(integrator, color, bands, source, &one), factor);
      }
}

}  // namespace
}  // namespace metamer
