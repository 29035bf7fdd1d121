#include "engine/film/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

namespace metamer {
namespace {

constexpr uint32_t width = 7, height = 5;

struct Samples {
  std::vector<uint32_t> pixel, sample;
  std::vector<float> X, Y, Z;

  void add(uint32_t p, uint32_t k, float x, float y, float z) {
    pixel.push_back(p);
    sample.push_back(k);
    X.push_back(x);
    Y.push_back(y);
    Z.push_back(z);
  }
};

// Magnitudes from 1e-30 to 1e12, a third of them negative, so that a floating-point sum would lose most of them.
float wild_value(std::mt19937& random) {
  const double exponent = std::uniform_real_distribution<double>(-30, 12)(random);
  const double sign = random() % 3 == 0 ? -1 : 1;
  return static_cast<float>(sign * std::pow(10.0, exponent));
}

Samples wild_samples(uint32_t begin, uint32_t end, uint32_t seed) {
  std::mt19937 random(seed);
  Samples samples;
  for (uint32_t k = begin; k < end; ++k)
    for (uint32_t p = 0; p < width * height; ++p) {
      const float x = wild_value(random), y = wild_value(random), z = wild_value(random);
      samples.add(p, k, x, y, z);
    }
  return samples;
}

Samples permuted(const Samples& samples, uint32_t seed) {
  std::vector<size_t> order(samples.pixel.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(seed));
  Samples result;
  for (const size_t i : order)
    result.add(samples.pixel[i], samples.sample[i], samples.X[i], samples.Y[i], samples.Z[i]);
  return result;
}

void add(TileFilm& tile, const Samples& s) { add_samples(tile, s.pixel, s.sample, s.X.data(), s.Y.data(), s.Z.data()); }

// All samples [begin, end) of the film as one unit of work.
void expose(Film& film, const Samples& samples, uint32_t begin, uint32_t end) {
  TileFilm tile;
  tile.reset(0, 0, width, height, begin, end);
  add(tile, samples);
  flush(film, tile);
}

// The samples [begin, end) that lie in a rectangle, in its own pixel numbers.
Samples in_tile(const Samples& all, uint32_t x, uint32_t y, uint32_t w, uint32_t h, uint32_t begin, uint32_t end) {
  Samples inside;
  for (size_t i = 0; i < all.pixel.size(); ++i) {
    const uint32_t px = all.pixel[i] % width, py = all.pixel[i] / width;
    if (px < x || px >= x + w || py < y || py >= y + h || all.sample[i] < begin || all.sample[i] >= end) continue;
    inside.add((py - y) * w + px - x, all.sample[i], all.X[i], all.Y[i], all.Z[i]);
  }
  return inside;
}

void expose_in_tiles(Film& film, const Samples& all, uint32_t side, uint32_t begin, uint32_t end) {
  TileFilm tile;
  for (uint32_t y = 0; y < height; y += side)
    for (uint32_t x = 0; x < width; x += side) {
      const uint32_t w = std::min(side, width - x), h = std::min(side, height - y);
      tile.reset(x, y, w, h, begin, end);
      add(tile, in_tile(all, x, y, w, h, begin, end));
      flush(film, tile);
    }
}

TEST(Film, SumsAreTheSameBytesInEveryOrder) {
  const Samples samples = wild_samples(0, 24, 1);
  Film first(width, height);
  expose(first, samples, 0, 24);
  for (uint32_t seed = 0; seed < 20; ++seed) {
    Film other(width, height);
    expose(other, permuted(samples, seed), 0, 24);
    EXPECT_TRUE(first == other) << "permutation " << seed;
  }
}

TEST(Film, SumsAreTheSameBytesForEveryTileAndPass) {
  const Samples samples = wild_samples(0, 8, 2);
  Film whole(width, height);
  expose(whole, samples, 0, 8);
  for (const uint32_t side : {1u, 2u, 3u, 5u, 64u}) {
    Film tiled(width, height);
    for (const auto& [begin, end] : {std::pair{4u, 8u}, std::pair{0u, 1u}, std::pair{1u, 2u}, std::pair{2u, 4u}})
      expose_in_tiles(tiled, samples, side, begin, end);
    EXPECT_TRUE(whole == tiled) << "tiles of " << side;
  }
}

// Long enough for the threads to collide thousands of times; without the locks sums are lost.
TEST(Film, ThreadsMayFlushTheSamePixelsAtOnce) {
  constexpr uint32_t thread_count = 4, flushes = 20000;
  const Samples samples = wild_samples(0, 4, 3);
  TileFilm tile;
  tile.reset(0, 0, width, height, 0, 4);
  add(tile, samples);
  Film film(width, height);
  std::vector<std::thread> threads;
  for (uint32_t t = 0; t < thread_count; ++t)
    threads.emplace_back([&] {
      for (uint32_t i = 0; i < flushes; ++i) flush(film, tile);
    });
  for (std::thread& thread : threads) thread.join();
  for (size_t p = 0; p < film.pixel_count(); ++p)
    for (uint32_t r = 0; r < replicate_count; ++r) {
      ASSERT_EQ(film.counts()[p].replicate[r], thread_count * flushes);
      for (int c = 0; c < 3; ++c)
        ASSERT_TRUE(film.sums()[p].xyz[r][c] == tile.sums()[p].xyz[r][c] * (thread_count * flushes));
    }
}

// Two limbs of 64 bits and plain long multiplication by doubling: shares nothing with to_fixed.
FixedSum slow_fixed(float value) {
  const bool negative = std::signbit(value);
  long double rest = std::fabs(static_cast<long double>(value)) * 0x1p64L;  // exact: 64-bit mantissa
  rest = std::floor(rest + 0.5L);  // beyond 2^63 quanta a float is whole anyway
  if (std::fabs(value) >= 0x1p-2f) rest = std::fabs(static_cast<long double>(value)) * 0x1p64L;
  FixedSum sum = 0;
  for (int bit = 126; bit >= 0; --bit)
    if (const long double weight = std::ldexp(1.0L, bit); rest >= weight) {
      rest -= weight;
      sum += FixedSum{1} << bit;
    }
  return negative ? -sum : sum;
}

TEST(Film, SumsEqualABitByBitOracle) {
  const Samples samples = wild_samples(0, 40, 4);
  Film film(width, height);
  expose(film, samples, 0, 40);
  std::vector<PixelSums> expected(width * height, PixelSums{});
  for (size_t i = 0; i < samples.pixel.size(); ++i) {
    FixedSum* xyz = expected[samples.pixel[i]].xyz[samples.sample[i] % 4];
    xyz[0] += slow_fixed(samples.X[i]);
    xyz[1] += slow_fixed(samples.Y[i]);
    xyz[2] += slow_fixed(samples.Z[i]);
  }
  for (uint32_t p = 0; p < width * height; ++p)
    for (uint32_t r = 0; r < replicate_count; ++r)
      for (int c = 0; c < 3; ++c)
        EXPECT_TRUE(film.sums()[p].xyz[r][c] == expected[p].xyz[r][c]) << p << ' ' << r << ' ' << c;
}

TEST(FixedPoint, HitsTheLimitsAndTheTiesExactly) {
  const auto quanta = [](float value) { return static_cast<double>(to_fixed(value)); };
  EXPECT_EQ(quanta(1.0f), 0x1p64);
  EXPECT_EQ(quanta(-1.5f), -1.5 * 0x1p64);
  EXPECT_EQ(quanta(sample_limit), 0x1p104);
  EXPECT_EQ(quanta(-sample_limit), -0x1p104);
  EXPECT_EQ(quanta(0x1.fffffep-41f), 0x1.fffffep23);  // the last value that is exact by its exponent alone
  EXPECT_EQ(quanta(0x1p-64f), 1);
  EXPECT_EQ(quanta(0x1p-65f), 1);  // a tie goes away from zero
  EXPECT_EQ(quanta(-0x1p-65f), -1);
  EXPECT_EQ(quanta(0x1.fffffep-66f), 0);
  EXPECT_EQ(quanta(1.5f * 0x1p-64f), 2);
  for (const float nothing : {0.0f, -0.0f, 1e-30f, std::numeric_limits<float>::denorm_min(), 1e-40f})
    EXPECT_EQ(quanta(nothing), 0);
}

TEST(FixedPoint, ErrsByAtMostHalfAQuantum) {
  std::mt19937 random(5);
  for (int i = 0; i < 200000; ++i) {
    const float value = std::ldexp(wild_value(random) > 0 ? 1.37f : -1.61f, static_cast<int>(random() % 40) - 70) +
                        std::ldexp(1.0f, static_cast<int>(random() % 40) - 80);
    const long double error = static_cast<long double>(to_fixed(value)) - static_cast<long double>(value) * 0x1p64L;
    ASSERT_LE(std::fabs(error), 0.5L) << value;
  }
}

TEST(Film, RefusesAndCountsWhatIsNoNumber) {
  constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const float bad[] = {nan, -nan, infinity, -infinity, std::nextafter(sample_limit, infinity), -3e38f};
  Samples samples;
  for (const float value : bad) {
    samples.add(0, 0, value, 1, 1);
    samples.add(0, 1, 1, value, 1);
    samples.add(0, 2, 1, 1, value);
  }
  samples.add(0, 3, sample_limit, -sample_limit, 0);
  TileFilm tile;
  tile.reset(0, 0, 1, 1, 0, 4);
  add(tile, samples);
  EXPECT_EQ(tile.invalid_samples(), 18u);
  Film film(1, 1);
  flush(film, tile);
  flush(film, tile);
  EXPECT_EQ(film.invalid_samples(), 36u);
  for (uint32_t r = 0; r < 3; ++r)
    for (const FixedSum sum : film.sums()[0].xyz[r]) EXPECT_TRUE(sum == 0);
  EXPECT_EQ(to_double(film.sums()[0].xyz[3][0]), 2.0 * sample_limit);
  EXPECT_EQ(mean_xyz(film, 0)[1], -static_cast<double>(sample_limit) / 4);
}

TEST(Film, DeadLanesAddNothing) {
  Samples samples = wild_samples(0, 4, 6);
  std::vector<uint8_t> live(samples.pixel.size());
  Samples kept;
  for (size_t i = 0; i < live.size(); ++i) {
    live[i] = i % 3 == 0 ? 255 : 0;
    if (live[i] != 0) {
      kept.add(samples.pixel[i], samples.sample[i], samples.X[i], samples.Y[i], samples.Z[i]);
    } else {
      samples.pixel[i] = 0xffffffffu;  // a dead lane holds anything
      samples.X[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  TileFilm tile;
  tile.reset(0, 0, width, height, 0, 4);
  add_samples(tile, samples.pixel, samples.sample, samples.X.data(), samples.Y.data(), samples.Z.data(), live);
  Film masked(width, height), plain(width, height);
  flush(masked, tile);
  expose(plain, kept, 0, 4);
  EXPECT_TRUE(masked == plain);
}

TEST(Film, MergingIsAdding) {
  const Samples samples = wild_samples(0, 13, 7);
  Film whole(width, height), early(width, height), late(width, height);
  expose(whole, samples, 0, 13);
  expose_in_tiles(early, samples, 4, 0, 6);
  expose_in_tiles(late, samples, 3, 6, 13);
  EXPECT_FALSE(early == whole);
  ASSERT_EQ(merge(early, late), std::nullopt);
  EXPECT_TRUE(early == whole);
  Film other(width, height + 1);
  EXPECT_EQ(merge(early, other), "cannot merge a film of 7x5 with one of 7x6");
  EXPECT_TRUE(early == whole);
}

TEST(Film, MergeRefusesMoreSamplesThanASumCanHold) {
  Film a(2, 1), b(2, 1);
  a.counts()[1].replicate[2] = max_samples_per_pixel;
  b.counts()[1].replicate[0] = 1;
  b.counts()[0].replicate[0] = 1;
  EXPECT_EQ(merge(a, b), "cannot merge 4194304 and 1 samples of a pixel: at most 4194304 fit");
  EXPECT_EQ(a.counts()[0].total(), 0u);
}

TEST(Film, ManySamplesAtTheLimitDoNotOverflow) {
  Film film(1, 1);
  film.counts()[0].replicate[1] = max_samples_per_pixel;
  for (FixedSum& sum : film.sums()[0].xyz[1]) sum = to_fixed(sample_limit) * max_samples_per_pixel;
  EXPECT_EQ(mean_xyz(film, 0)[2], static_cast<double>(sample_limit));
}

TEST(Film, CountsSamplesOfEveryReplicateForAnyRange) {
  for (uint32_t begin = 0; begin < 9; ++begin)
    for (uint32_t end = begin; end < 23; ++end) {
      TileFilm tile;
      tile.reset(0, 0, 1, 1, begin, end);
      PixelCounts expected = {};
      for (uint32_t k = begin; k < end; ++k) ++expected.replicate[k % 4];
      for (uint32_t r = 0; r < 4; ++r) EXPECT_EQ(tile.counts().replicate[r], expected.replicate[r]);
    }
}

TEST(Film, InterruptedFramesKeepTheirCountsByPixel) {
  Film film(4, 1);
  TileFilm tile;
  tile.reset(0, 0, 2, 1, 0, 3);
  for (uint32_t k = 0; k < 3; ++k) {
    Samples s;
    s.add(1, k, 2, 4, 8);
    add(tile, s);
  }
  flush(film, tile);
  tile.reset(0, 0, 1, 1, 3, 4);
  flush(film, tile);
  const SampleTotals totals = sample_totals(film);
  EXPECT_EQ(totals.total, 7u);
  EXPECT_EQ(totals.fewest, 0u);
  EXPECT_EQ(totals.most, 4u);
  EXPECT_EQ(mean_xyz(film, 1)[0], 2);
  EXPECT_EQ(mean_xyz(film, 1)[2], 8);
  EXPECT_EQ(mean_xyz(film, 3)[1], 0);
  Column<float> X, Y, Z;
  mean_xyz(film, X, Y, Z);
  EXPECT_EQ(X.size(), 4u);
  EXPECT_EQ(Y[1], 4);
}

// Relative standard error of a variance from R replicates is sqrt(2 / (R - 1)) per pixel; over 20000 pixels
// 0.6 %, so 3 % is a bound of five sigma.
TEST(Film, PredictedVarianceIsTheObservedOneAlsoForUnequalReplicates) {
  for (const uint32_t samples : {4u, 6u, 7u, 16u}) {
    constexpr uint32_t pixels = 20000;
    std::mt19937 random(samples);
    std::normal_distribution<float> x(10, 2), y(-3, 0.5f), z(0, 100);
    TileFilm tile;
    tile.reset(0, 0, pixels, 1, 0, samples);
    Samples s;
    for (uint32_t p = 0; p < pixels; ++p)
      for (uint32_t k = 0; k < samples; ++k) s.add(p, k, x(random), y(random), z(random));
    add(tile, s);
    Film film(pixels, 1);
    flush(film, tile);
    double predicted[3] = {};
    for (uint32_t p = 0; p < pixels; ++p)
      for (int c = 0; c < 3; ++c) predicted[c] += variance_of_mean_xyz(film, p)[c] / pixels;
    const double sigma[3] = {2, 0.5, 100};
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(predicted[c] / (sigma[c] * sigma[c] / samples), 1, 0.03) << samples << " samples, channel " << c;
  }
}

TEST(Film, VarianceIsUnknownFromOneReplicate) {
  Film film(1, 1);
  film.counts()[0].replicate[2] = 5;
  EXPECT_EQ(variance_of_mean_xyz(film, 0)[0], HUGE_VAL);
  film.counts()[0].replicate[3] = 5;
  EXPECT_EQ(variance_of_mean_xyz(film, 0)[0], 0);
}

TEST(FilmDeathTest, BrokenInvariantsStopWithBothValues) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  Film film(4, 4);
  TileFilm tile;
  tile.reset(2, 0, 3, 4, 0, 1);
  EXPECT_DEATH(flush(film, tile), "tile 3x4 at 2,0 in a film of 4x4");
  Samples outside;
  outside.add(12, 0, 1, 1, 1);
  EXPECT_DEATH(add(tile, outside), "sample 0 of pixel 12 in a tile of 12 pixels");
  Samples not_of_the_range;
  not_of_the_range.add(0, 1, 1, 1, 1);
  EXPECT_DEATH(add(tile, not_of_the_range), "sample 1 of pixel 0");
  tile.reset(0, 0, 1, 1, 0, max_samples_per_pixel + 1);
  EXPECT_DEATH(flush(film, tile), "the limit is 4194304");
}

TEST(FrameSize, RefusesWhatCannotBeHeld) {
  EXPECT_EQ(film_bytes(1000, 1000), 1000u * 1000u * 208u + 1001u);
  EXPECT_EQ(film_bytes(1ull << 40, 1ull << 40), std::numeric_limits<uint64_t>::max());
  EXPECT_EQ(check_frame_size(640, 480), std::nullopt);
  EXPECT_EQ(check_frame_size(0, 480), "a frame of 0x480 has no pixels");
  EXPECT_EQ(check_frame_size(1u << 21, 1), "a frame of 2097152x1 is too large: a side has at most 1048576 pixels");
  const auto huge = check_frame_size(1u << 20, 1u << 20);
  ASSERT_TRUE(huge.has_value());
  EXPECT_NE(huge->find("does not fit in memory: it needs 241664.0 GiB"), std::string::npos) << *huge;
}

}  // namespace
}  // namespace metamer
