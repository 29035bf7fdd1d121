#include "engine/film/bands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "engine/film/film.h"
#include "engine/spectrum/wavelengths.h"

namespace metamer {
namespace {

// Samples of four wavelengths each, as the renderer draws them.
struct Lights {
  std::vector<uint32_t> pixel;
  std::array<std::vector<float>, 4> lambda_nm, weight_nm, radiance;
  std::vector<uint8_t> live, recorded;

  void add(uint32_t at, const WavelengthSample& wavelengths, const std::array<float, 4>& values) {
    pixel.push_back(at);
    live.push_back(1);
    recorded.push_back(1);
    for (size_t j = 0; j < 4; ++j) {
      lambda_nm[j].push_back(static_cast<float>(wavelengths.lambda_nm[j]));
      weight_nm[j].push_back(static_cast<float>(wavelengths.inv_pdf_nm[j]));
      radiance[j].push_back(values[j]);
    }
  }
  BandSamples columns() const {
    const auto of = [](const std::array<std::vector<float>, 4>& c) {
      return std::array<const float*, 4>{c[0].data(), c[1].data(), c[2].data(), c[3].data()};
    };
    return {of(lambda_nm), of(weight_nm), of(radiance)};
  }
};

void add(TileFilm& tile, const Lights& lights) {
  add_band_samples(tile, lights.pixel, lights.columns(), lights.live, lights.recorded);
}

// `count` samples of a spectrum in one pixel.
template <class F>
Film film_of(uint32_t band_count, uint32_t count, F&& spectrum) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  Lights lights;
  for (uint32_t k = 0; k < count; ++k) {
    const double u = uniform(random), rotation = uniform(random);
    const WavelengthSample w = sample_wavelengths(u, rotation);
    std::array<float, 4> values;
    for (size_t j = 0; j < 4; ++j) values[j] = static_cast<float>(spectrum(w.lambda_nm[j]));
    lights.add(0, w, values);
  }
  TileFilm tile;
  tile.reset(0, 0, 1, 1, 0, count, band_count);
  add(tile, lights);
  Film film(1, 1, band_count);
  flush(film, tile);
  return film;
}

std::vector<float> means_of(const Film& film) {
  std::vector<float> means(film.band_count());
  std::vector<float*> columns;
  for (float& mean : means) columns.push_back(&mean);
  band_means(film, 0, 1, columns);
  return means;
}

TEST(Bands, AConstantSpectrumIsExactlyConstantHoweverFewSamplesThereAre) {
  for (const uint32_t band_count : {1u, 7u, 36u, 360u})
    for (const uint32_t samples : {1u, 2u, 4u, 50u})
      for (const double radiance : {1.0, 0.3, 2e-6, 7.7e4})
        for (const float mean : means_of(film_of(band_count, samples, [&](double) { return radiance; })))
          ASSERT_NEAR(mean / radiance, 1, 2e-7) << band_count << " bands, " << samples << " samples, " << radiance;
}

// The density of wavelengths changes by half within the wide bands: a plain mean of samples would be off by per cents.
TEST(Bands, AreMeansOverTheBandAlthoughTheDensityOfWavelengthsVaries) {
  const auto ramp = [](double lambda_nm) { return lambda_nm - 350; };
  for (const uint32_t band_count : {3u, 9u}) {
    const std::vector<float> means = means_of(film_of(band_count, 400000, ramp));
    const std::vector<double> edges_nm = band_edges_nm(band_count);
    for (uint32_t b = 0; b < band_count; ++b)
      EXPECT_NEAR(means[b] / ramp((edges_nm[b] + edges_nm[b + 1]) / 2), 1, 5e-3) << b << " of " << band_count;
  }
}

TEST(Bands, BetweenBandsWithSamplesTheOthersLieOnALine) {
  Film film(2, 1, 6);
  const auto put = [&](size_t band, double mean) {
    film.bands()[6 + band].add_weight(uint64_t{100} << 20);
    film.bands()[6 + band].add_radiance(to_units<band_unit_log2>(static_cast<float>(100 * mean)));
  };
  std::array<std::array<float, 2>, 6> means;
  std::vector<float*> columns;
  for (auto& column : means) columns.push_back(column.data());
  put(1, 3);
  band_means(film, 0, 2, columns);
  for (const auto& column : means) {
    EXPECT_EQ(column[0], 0) << "a pixel without samples is black";
    EXPECT_EQ(column[1], 3);
  }
  put(4, 6);
  band_means(film, 0, 2, columns);
  const std::array<float, 6> expected = {3, 3, 4, 5, 6, 6};
  for (size_t b = 0; b < 6; ++b) EXPECT_EQ(means[b][1], expected[b]) << b;
}

TEST(Bands, SumsDoNotDependOnOrderTilesOrRanges) {
  constexpr uint32_t width = 5, height = 4, band_count = 12, samples = 24;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1), exponent(-9, 8);
  Lights lights;
  for (uint32_t k = 0; k < samples; ++k)
    for (uint32_t p = 0; p < width * height; ++p) {
      const double u = uniform(random), rotation = uniform(random);
      std::array<float, 4> values;
      for (float& value : values) value = static_cast<float>(std::pow(10, exponent(random)) - 0.5);
      lights.add(p, sample_wavelengths(u, rotation), values);
    }
  TileFilm tile;
  tile.reset(0, 0, width, height, 0, samples, band_count);
  add(tile, lights);
  Film whole(width, height, band_count), parts(width, height, band_count), other(width, height, band_count);
  flush(whole, tile);

  std::vector<size_t> order(lights.pixel.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::shuffle(order.begin(), order.end(), random);
  for (uint32_t y = 0; y < height; y += 3) {
    const uint32_t rows = std::min(3u, height - y);
    for (const auto& [begin, end] : {std::pair(0u, 7u), std::pair(7u, samples)}) {
      Lights some;
      for (const size_t i : order) {
        const uint32_t row = lights.pixel[i] / width, k = static_cast<uint32_t>(i / (width * height));
        if (row < y || row >= y + rows || k < begin || k >= end) continue;
        WavelengthSample w;
        std::array<float, 4> values;
        for (size_t j = 0; j < 4; ++j) {
          w.lambda_nm[j] = double{lights.lambda_nm[j][i]};
          w.inv_pdf_nm[j] = double{lights.weight_nm[j][i]};
          values[j] = lights.radiance[j][i];
        }
        some.add(lights.pixel[i] - y * width, w, values);
      }
      tile.reset(0, y, width, rows, begin, end, band_count);
      add(tile, some);
      flush(begin == 0 ? parts : other, tile);
    }
  }
  EXPECT_FALSE(parts == whole);
  ASSERT_EQ(merge(parts, other), std::nullopt);
  EXPECT_TRUE(parts == whole);
  Film few(width, height, 3), none(width, height);
  EXPECT_EQ(merge(parts, few), "cannot merge a film of 12 bands with one of 3");
  EXPECT_EQ(merge(parts, none), "cannot merge a film of 12 bands with one of 0");
}

TEST(Bands, WavelengthsOutsideAndDeadLanesAddNothingAndRefusedSamplesAreBlack) {
  TileFilm tile;
  tile.reset(0, 0, 1, 1, 0, 4, 2);
  Lights lights;
  const WavelengthSample w = {{370, 380, 739.9, 740}, {200, 200, 300, 300}};
  lights.add(0, w, {1, 2, 3, 4});
  lights.add(0, w, {5, 6, 7, 8});
  lights.recorded[1] = 0;
  lights.add(0xffffffffu, w, {9, 9, 9, 9});
  lights.live[2] = 0;
  lights.add(0, w, {0, 6e6f, std::numeric_limits<float>::infinity(), 0});
  add(tile, lights);
  EXPECT_EQ(tile.invalid_samples(), 2u);
  EXPECT_EQ(tile.bands()[0].weight_units(), uint64_t{600} << 20);
  EXPECT_EQ(tile.bands()[1].weight_units(), uint64_t{900} << 20);
  EXPECT_NEAR(band_mean(tile.bands()[0]), 400.0 / 600, 1e-15);
  EXPECT_NEAR(band_mean(tile.bands()[1]), 900.0 / 900, 1e-15);
}

TEST(Bands, PartsOfASampleBringItsWeightsOnce) {
  TileFilm tile;
  tile.reset(0, 0, 1, 1, 0, 1, 1);
  Lights lights;
  lights.add(0, {{400, 500, 600, 700}, {100, 100, 100, 100}}, {1, 1, 1, 1});
  BandSamples samples = lights.columns();
  add_band_samples(tile, lights.pixel, samples, lights.live, lights.recorded);
  samples.adds_weights = false;
  samples.scale = 0.5f;
  add_band_samples(tile, lights.pixel, samples, lights.live, lights.recorded);
  EXPECT_EQ(band_mean(tile.bands()[0]), 1.5);
}

TEST(Bands, SumsHoldNegativeNumbersAndTheLargestFilm) {
  BandSum sum = {};
  sum.add_radiance(to_units<band_unit_log2>(-3.5f));
  sum.add_weight(uint64_t{7} << 20);
  EXPECT_EQ(band_mean(sum), -0.5);
  sum.add_radiance(to_units<band_unit_log2>(7.0f));
  EXPECT_EQ(band_mean(sum), 0.5);
  BandSum full = {};
  const FixedSum most = to_units<band_unit_log2>(band_sample_limit) * (FixedSum{max_samples_per_pixel} * 4);
  full.add_radiance(most);
  full.add_radiance(most - 1);
  EXPECT_TRUE(full.radiance_units() == most * 2 - 1) << "a bit to spare";
  full.add_weight(uint64_t{max_samples_per_pixel} * 4 << (14 + 20));
  EXPECT_EQ(full.weight_units(), uint64_t{1} << 58);
  BandSum twice = sum;
  twice.add(sum);
  EXPECT_EQ(twice.weight_units(), uint64_t{14} << 20);
  EXPECT_EQ(band_mean(twice), 0.5);
}

TEST(Bands, EdgesAreEvenlySpaced) {
  const std::vector<double> edges_nm = band_edges_nm(default_band_count);
  ASSERT_EQ(edges_nm.size(), 37u);
  for (size_t i = 0; i < 37; ++i) EXPECT_EQ(edges_nm[i], 380 + 10 * static_cast<double>(i));
}

TEST(Bands, TakeTwentyBytesEachOfMemory) {
  EXPECT_EQ(film_bytes(1000, 1000, 36), 1000u * 1000u * (208u + 36u * 20u) + 1001u);
  EXPECT_EQ(film_bytes(1ull << 31, 1ull << 31, 360), std::numeric_limits<uint64_t>::max());
  const auto huge = check_frame_size(1u << 20, 1u << 20, 36);
  ASSERT_TRUE(huge.has_value());
  EXPECT_NE(huge->find("with 36 bands does not fit in memory"), std::string::npos) << *huge;
  EXPECT_NE(huge->find("(956 bytes a pixel)"), std::string::npos) << *huge;
}

}  // namespace
}  // namespace metamer
