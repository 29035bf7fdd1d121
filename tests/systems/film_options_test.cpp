// What the film does with a sample: weighs it by the pixel filter, limits it, balances it.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/spectrum/color.h"
#include "systems/systems.h"
#include "tests/support/chi_square.h"
#include "tests/systems/support/scene_builder.h"

namespace metamer {
namespace {

constexpr uint32_t width = 24, height = 16;

// The right half of the picture is lit, up to an edge between two pixels. The luminance of each column of pixels, that
// of the light being 1.
std::vector<double> columns_beside_an_edge(const Filter& filter, Integrator integrator) {
  SceneBuilder b(width, height, 1024, 0);
  b.scene.settings.filter = filter;
  b.scene.settings.integrator = integrator;
  // A point light would do for `path`, too; an emitting square is what all integrators see.
  b.emit(b.add(rectangle(100, 100), b.diffuse(0.0), moved(50, 0, 0)), b.constant(1), 1, true);
  b.look_at({0, 0, 5}, {0, 0, 0}, orthographic(height));
  const Film film = render_film(*b.freeze());
  EXPECT_EQ(film.invalid_samples(), 0u);
  std::vector<double> columns(width, 0.0);
  for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel)
    columns[pixel % width] += mean_xyz(film, pixel)[1] / height / (683 * 106.86);
  return columns;
}

// The convolution of the step with the filter: the filter's integral from the edge on.
TEST(FilmOptions, AnEdgeIsWhatTheFilterMakesOfIt) {
  Filter mitchell{FilterKind::mitchell, 2, 2, 0.5f}, sinc{FilterKind::sinc, 4, 3, 0.5f};
  for (const Filter& filter : {mitchell, sinc}) {
    const PixelFilter made = make_pixel_filter(filter.kind, filter.radius_x, filter.radius_y);
    for (const Integrator integrator : {Integrator::path, Integrator::recursive}) {
      const std::vector<double> columns = columns_beside_an_edge(filter, integrator);
      double least = 0, most = 0;
      for (uint32_t x = 4; x < width - 4; ++x) {
        const double to_edge = width / 2 - (x + 0.5), rx = filter.radius_x, ry = filter.radius_y;
        const double from = std::clamp(to_edge, -rx, rx);
        const auto value = [&](double u, double v) { return filter_value(made, u, v); };
        const double expected = from < rx ? integrate_rectangle(value, from, rx, -ry, ry, 64) : 0;
        EXPECT_NEAR(columns[x], expected, 0.02) << filter_name(filter.kind) << " column " << x;
        least = std::min(least, expected);
        most = std::max(most, expected);
      }
      EXPECT_LT(least, -0.005) << "darker than black beside the edge";
      EXPECT_GT(most, 1.005);
    }
  }
}

// Samples in two pixels, one of them ten times as bright; with their luminances.
struct TwoSamples {
  std::unique_ptr<World> world;
  Batch batch;
  explicit TwoSamples(const RenderSettings& settings) {
    SceneBuilder b(16, 16, 1, 0);
    b.light(LightKind::environment, unit_spectrum, 1);
    b.look_at({0, 0, 5}, {0, 0, 0}, perspective(40));
    const RenderSettings usual = b.scene.settings;
    b.scene.settings = settings;
    b.scene.settings.width = usual.width;
    b.scene.settings.height = usual.height;
    world = b.freeze();
    batch.slots.size = 16;
    for (uint32_t i = 0; i < 16; ++i) {
      batch.slots.pixel[i] = i < 2 ? i : dead_lane;
      batch.slots.sample[i] = 0;
      batch.slots.weight[i] = 1;
      for (size_t j = 0; j < 4; ++j) {
        batch.slots.lambda_nm[j][i] = 500.0f + 40 * static_cast<float>(j);
        batch.slots.inv_pdf_nm[j][i] = 300;
        batch.slots.radiance[j][i] = i == 0 ? 1 : 10;
      }
    }
  }
  Film film() {
    TileFilm tile;
    tile.reset(0, 0, 16, 16, 0, 1, world->settings.band_count);
    accumulate(*world, batch.slots, tile);
    Film film(16, 16, world->settings.band_count);
    flush(film, tile);
    return film;
  }
};

TEST(FilmOptions, SamplesAreScaledDownToTheLargestComponent) {
  RenderSettings settings;
  settings.band_count = 9;
  const Film all = TwoSamples(settings).film();
  const auto dim = mean_xyz(all, 0), bright = mean_xyz(all, 1);
  const double largest = std::max({bright[0], bright[1], bright[2]});
  settings.largest_component = static_cast<float>(largest / 4);
  const Film limited = TwoSamples(settings).film();
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(mean_xyz(limited, 0)[c], dim[c]) << "is below";
    EXPECT_NEAR(mean_xyz(limited, 1)[c] / bright[c], 0.25, 1e-6) << "keeps its colour";
  }
  EXPECT_NEAR(band_mean(limited.bands()[9 + 4]) / band_mean(all.bands()[9 + 4]), 0.25, 1e-6) << "bands, too";
  EXPECT_EQ(band_mean(limited.bands()[4]), band_mean(all.bands()[4]));
}

TEST(FilmOptions, WeightsOfTheFilterReachFilmAndBands) {
  RenderSettings settings;
  settings.band_count = 9;
  TwoSamples samples(settings);
  const Film plain = samples.film();
  samples.batch.slots.weight[1] = -2;
  const Film film = samples.film();
  for (size_t c = 0; c < 3; ++c) EXPECT_EQ(mean_xyz(film, 1)[c], -2 * mean_xyz(plain, 1)[c]);
  EXPECT_EQ(band_mean(film.bands()[9 + 4]), -2 * band_mean(plain.bands()[9 + 4]));
  EXPECT_EQ(mean_xyz(film, 0), mean_xyz(plain, 0));
}

// The light the film is balanced for is recorded as the white of the primaries; without balance it is what it is.
TEST(FilmOptions, TheLightItIsBalancedForIsWhite) {
  for (const ColorSpace primaries : {ColorSpace::srgb, ColorSpace::aces2065_1}) {
    for (const float kelvin : {0.0f, 3000.0f}) {
      SceneBuilder b(8, 8, 1024, 0);
      b.scene.settings.white_balance_kelvin = kelvin;
      b.scene.settings.primaries = primaries;
      b.light(LightKind::environment, b.scene.spectra.add_blackbody(3000).id, 1);
      b.look_at({0, 0, 5}, {0, 0, 0}, perspective(40));
      const Film film = render_film(*b.freeze());
      Color3 mean = {};
      for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel)
        for (size_t c = 0; c < 3; ++c) mean[c] += mean_xyz(film, pixel)[c];
      // The chromaticity of Planck's radiator of 3000 K: 0.4369, 0.4041.
      const auto expected = kelvin > 0 ? chromaticity(white_xyz(primaries)) : std::array<double, 2>{0.4369, 0.4041};
      EXPECT_NEAR(chromaticity(mean)[0], expected[0], 1e-3) << kelvin;
      EXPECT_NEAR(chromaticity(mean)[1], expected[1], 1e-3) << kelvin;
    }
  }
}

}  // namespace
}  // namespace metamer
