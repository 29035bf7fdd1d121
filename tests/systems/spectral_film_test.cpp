// The spectral film as it is rendered: bands of known scenes, and the same bytes whatever the arrangement.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/spectrum/sources.h"
#include "hwy/targets.h"
#include "systems/develop_bands.h"
#include "systems/write_frame.h"
#include "tests/systems/support/scene_builder.h"

namespace metamer {
namespace {

std::vector<std::vector<float>> means_of(const Film& film) {
  std::vector<std::vector<float>> means(film.band_count(), std::vector<float>(film.pixel_count()));
  std::vector<float*> columns;
  for (auto& column : means) columns.push_back(column.data());
  band_means(film, 0, film.pixel_count(), columns);
  return means;
}

TEST(SpectralFilm, AConstantSpectrumIsConstantInEveryBandOfEveryPixelFromTheFirstSample) {
  for (const uint32_t samples : {1u, 2u, 4u})
    for (const uint32_t band_count : {1u, 36u, 100u}) {
      SceneBuilder b(8, 6, samples, 8);
      b.light(LightKind::environment, b.constant(0.02), 1);
      b.add(sphere(1), b.diffuse(0.5));  // behind the camera
      b.look_at({0, 0, 4}, {0, 0, 9}, perspective(40));
      b.scene.settings.band_count = band_count;
      b.scene.settings.sensor_scale = 3;
      for (const std::vector<float>& band : means_of(render_film(*b.freeze())))
        for (const float mean : band) ASSERT_NEAR(mean / 0.06f, 1, 1e-6) << samples << " " << band_count;
    }
}

TEST(SpectralFilm, BandsOfAnIlluminantAreItsMeans) {
  SceneBuilder b(4, 4, 1024, 1);
  b.light(LightKind::environment, b.named("FL2"), 1e-4f);
  b.add(sphere(1), b.diffuse(0.5));  // behind the camera
  b.look_at({0, 0, 4}, {0, 0, 9}, perspective(40));
  b.scene.settings.band_count = 36;
  const std::vector<std::vector<float>> means = means_of(render_film(*b.freeze()));
  const Samples fl2 = *cie_illuminant("FL2");
  for (size_t band = 0; band < 36; ++band) {
    double expected = 0, mean = 0;
    for (int i = 0; i < 160; ++i)
      expected += interpolate(fl2, 380 + 10 * (double(band) + (i + 0.5) / 160)) / 160 * 1e-4;
    for (const float value : means[band]) mean += double{value} / 16;
    EXPECT_NEAR(mean / expected, 1, 0.04) << band;
  }
}

// A dispersing refraction leaves the hero, four times as heavy: bands must stay means. Glass in a furnace
// is not to be seen, in any band.
TEST(SpectralFilm, DispersionChangesNoBand) {
  SceneBuilder b(6, 6, 4096, 30);
  b.light(LightKind::environment, b.constant(1), 1);
  b.add(sphere(1), b.dielectric(b.named("SF10")));
  b.look_at({0, 0, 4}, {0, 0, 0}, perspective(20));
  b.scene.settings.band_count = 9;
  const std::vector<std::vector<float>> means = means_of(render_film(*b.freeze()));
  for (size_t band = 0; band < 9; ++band) {
    double mean = 0;
    for (const float value : means[band]) mean += double{value} / 36;
    EXPECT_NEAR(mean, 1, 0.05) << band;
  }
}

TEST(SpectralFilm, HasTheSameBytesForEveryTileSizeAndNumberOfThreads) {
  SceneBuilder b(37, 29, 11, 6);
  b.light(LightKind::environment, b.named("D65"), 1e-3f);
  b.add(sphere(0.7f), b.dielectric(b.named("SF10")), moved(-0.6, 0, 0));
  b.add(sphere(0.7f), b.diffuse(0.7), moved(0.8, 0, 0));
  b.look_at({0, 0, 4}, {0, 0, 0}, perspective(40));
  b.scene.settings.band_count = 36;
  const std::unique_ptr<World> world = b.freeze();
  const Film film = render_film(*world, {1, 32});
  ASSERT_EQ(film.band_count(), 36u);
  for (const RenderOptions& options : {RenderOptions{3, 32}, {2, 7}, {4, 64}, {2, 1}})
    EXPECT_TRUE(render_film(*world, options) == film) << options.threads << " threads, tiles of " << options.tile_size;
  b.scene.settings.band_count = 0;
  const Film plain = render_film(*b.freeze(), {2, 32});
  for (size_t p = 0; p < film.pixel_count(); ++p)
    ASSERT_EQ(mean_xyz(plain, p), mean_xyz(film, p)) << "bands change no X, Y, Z";
}

// What is in the film is what is developed, by whichever way the bands come.
TEST(DevelopBands, FilmAndColumnsGiveTheSameBitsOnAllInstructionSetsAndThreads) {
  SceneBuilder b(50, 47, 2, 2);  // 2350 pixels: more than two blocks
  b.add(sphere(1), b.diffuse(0.5));
  b.look_at({0, 0, 4}, {0, 0, 0}, perspective(40));
  b.scene.settings.band_count = 11;
  b.light(LightKind::environment, b.named("A"), 1);
  const Film film = render_film(*b.freeze());
  SpectralPicture picture{50, 47, band_edges_nm(11), {}};
  for (const std::vector<float>& band : means_of(film)) {
    Column<float> column(band.size());
    std::copy(band.begin(), band.end(), column.begin());
    picture.bands.push_back(std::move(column));
  }
  const BandMatrix matrix = band_matrix(picture.edges_nm, Observer::cie2015_10);
  const XyzPicture reference = integrate_bands(picture, matrix, 1);
  for (size_t p = 0; p < film.pixel_count(); ++p) {
    float X = 0;
    for (size_t band = 0; band < 11; ++band) {
      const float term = matrix[0][band] * picture.bands[band][p];
      X = band == 0 ? term : X + term;
    }
    ASSERT_EQ(reference.X[p], X) << p;
  }
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (const uint32_t threads : {1u, 3u})
      for (const XyzPicture& xyz : {integrate_bands(film, matrix, threads), integrate_bands(picture, matrix, threads)})
        for (size_t p = 0; p < film.pixel_count(); ++p) {
          ASSERT_EQ(xyz.X[p], reference.X[p]) << hwy::TargetName(target) << " " << threads;
          ASSERT_EQ(xyz.Y[p], reference.Y[p]);
          ASSERT_EQ(xyz.Z[p], reference.Z[p]);
        }
  }
  hwy::SetSupportedTargetsForTest(0);
}

// Twice the light, and sums of lights (Grassmann's laws), for every observer.
TEST(DevelopBands, IsLinear) {
  SpectralPicture a{16, 1, band_edges_nm(36), {}}, c = a, sum = a;
  for (size_t band = 0; band < 36; ++band) {
    for (SpectralPicture* picture : {&a, &c, &sum}) picture->bands.emplace_back(16);
    for (size_t p = 0; p < 16; ++p) {
      a.bands[band][p] = static_cast<float>(1 + (band * 7 + p) % 5);
      c.bands[band][p] = static_cast<float>(2 + (band * 3 + p) % 11);
      sum.bands[band][p] = 2 * a.bands[band][p] + c.bands[band][p];
    }
  }
  for (const std::string_view name : observer_names()) {
    const BandMatrix matrix = band_matrix(a.edges_nm, *find_observer(name));
    const XyzPicture xa = integrate_bands(a, matrix, 1), xc = integrate_bands(c, matrix, 1);
    const XyzPicture xsum = integrate_bands(sum, matrix, 1);
    for (size_t p = 0; p < 16; ++p) {
      EXPECT_NEAR(xsum.X[p] / (2 * xa.X[p] + xc.X[p]), 1, 1e-6) << name;
      EXPECT_NEAR(xsum.Z[p] / (2 * xa.Z[p] + xc.Z[p]), 1, 1e-6) << name;
    }
  }
}

// Rendered, banded and integrated against rendered and summed: the whole way, on patches under lamps.
TEST(DevelopBands, GivesTheXyzThatTheFilmRecordedDirectly) {
  for (const char* lamp : {"A", "D65", "FL2", "FL11"}) {
    SceneBuilder b(24, 1, 4096, 1);
    b.light(LightKind::directional, b.named(lamp), 1e-2f);
    const DataTable& patches = require_embedded_data("reflectance/colorchecker_ohta");
    for (size_t i = 0; i < 24; ++i) {
      Samples reflectance = resample(patches, i + 1, Extend::constant);
      b.add(rectangle(1, 1), b.diffuse(b.scene.spectra.add_samples(reflectance).id), moved(double(i) - 11.5, 0, 0));
    }
    b.look_at({0, 0, 4}, {0, 0, 0}, orthographic(1));
    b.scene.settings.band_count = 36;
    const Film film = render_film(*b.freeze());
    const XyzPicture direct = observe(film, Observer::cie1931, 1);
    const XyzPicture banded = integrate_bands(film, band_matrix(band_edges_nm(36), Observer::cie1931), 1);
    for (size_t p = 0; p < 24; ++p) {
      ASSERT_GT(direct.Y[p], 0);
      // 0.5 % of the bands, and noise of 4096 samples of wavelengths.
      EXPECT_NEAR(banded.X[p] / direct.X[p], 1, 0.007) << lamp << " " << p;
      EXPECT_NEAR(banded.Y[p] / direct.Y[p], 1, 0.007) << lamp << " " << p;
      EXPECT_NEAR(banded.Z[p] / direct.Z[p], 1, 0.007) << lamp << " " << p;
    }
  }
}

}  // namespace
}  // namespace metamer
