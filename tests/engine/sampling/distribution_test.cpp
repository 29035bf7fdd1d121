// Distributions: drawn as often as they say, zero weights never, and the same bits in every lane of every
// instruction set as in the scalar twin.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/engine/sampling/distribution_test.cpp"
#include "engine/sampling/distribution.h"

#include <gtest/gtest.h>
#include <hwy/foreach_target.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "engine/sampling/distribution-inl.h"
#include "engine/simd/column.h"
#include "tests/support/chi_square.h"
#include "tests/support/each_target.h"

#ifndef METAMER_TESTS_ENGINE_SAMPLING_DISTRIBUTION_TEST_ONCE
#define METAMER_TESTS_ENGINE_SAMPLING_DISTRIBUTION_TEST_ONCE
namespace metamer {
struct SampleColumns {
  explicit SampleColumns(size_t n) : u(n), v(n), x(n), y(n), probability(n), pdf(n), index(n) {}
  Column<float> u, v, x, y, probability, pdf;
  Column<int32_t> index;
};
}  // namespace metamer
#endif

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

void sample_1d_columns(const Distribution1D* distribution, SampleColumns* c) {
  const FloatTag d;
  for (size_t i = 0; i < c->u.size(); i += hn::Lanes(d)) {
    const DiscreteSampleV s = sample_discrete(*distribution, hn::Load(d, c->u.data() + i));
    hn::Store(s.index, IntTag(), c->index.data() + i);
    hn::Store(s.probability, d, c->probability.data() + i);
    hn::Store(s.remapped, d, c->x.data() + i);
    hn::Store(discrete_probability(*distribution, s.index), d, c->pdf.data() + i);
  }
}

void sample_2d_columns(const Distribution2D* distribution, SampleColumns* c) {
  const FloatTag d;
  for (size_t i = 0; i < c->u.size(); i += hn::Lanes(d)) {
    const SquareSampleV s = sample_square(*distribution, hn::Load(d, c->u.data() + i), hn::Load(d, c->v.data() + i));
    hn::Store(s.cell, IntTag(), c->index.data() + i);
    hn::Store(s.x, d, c->x.data() + i);
    hn::Store(s.y, d, c->y.data() + i);
    hn::Store(s.pdf, d, c->probability.data() + i);
    hn::Store(square_pdf(*distribution, s.x, s.y), d, c->pdf.data() + i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(sample_1d_columns);
HWY_EXPORT(sample_2d_columns);
namespace {

constexpr float largest_u = 0x1.fffffep-1f;

SampleColumns random_columns(size_t n) {
  SampleColumns c(n);
  std::mt19937 rng(21);
  for (size_t i = 0; i < n; ++i) {
    c.u[i] = static_cast<float>(rng() >> 8) * 0x1p-24f;
    c.v[i] = static_cast<float>(rng() >> 8) * 0x1p-24f;
  }
  c.u[8] = 1, c.u[9] = -1, c.u[10] = 7, c.u[11] = std::numeric_limits<float>::quiet_NaN();
  for (size_t i = 0; i < 4; ++i) c.u[i] = i & 1 ? largest_u : 0, c.v[i] = i & 2 ? largest_u : 0;
  return c;
}

// Spans many orders of magnitude, with zeros here and there and at both ends.
std::vector<double> rough_weights(size_t n, uint32_t seed) {
  std::vector<double> weights(n);
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> exponent(-4, 2);
  for (double& w : weights) w = rng() % 5 == 0 ? 0 : std::pow(10.0, exponent(rng));
  weights.front() = weights.back() = 0;
  return weights;
}

TEST(Distribution, EveryBinIsDrawnInProportionToItsWeight) {
  for (const size_t n : {3u, 7u, 64u, 1000u}) {
    const std::vector<double> weights = rough_weights(n, static_cast<uint32_t>(n));
    const Distribution1D distribution = make_distribution_1d(weights);
    const SampleColumns c = random_columns(1000000);
    std::vector<double> observed(n, 0), expected(n);
    for (const float u : c.u) observed[sample_discrete(distribution, u).index] += 1;
    for (size_t i = 0; i < n; ++i) expected[i] = 1e6 * weights[i] / distribution.sum;
    EXPECT_GT(chi_square_test(observed, expected).p_value, chi_square_level) << n;
    for (size_t i = 0; i < n; ++i) {
      const double probability = discrete_probability(distribution, static_cast<uint32_t>(i));
      ASSERT_NEAR(probability, weights[i] / distribution.sum, static_cast<double>(n) * 0x1p-24);
      ASSERT_EQ(probability > 0, weights[i] > 0);
    }
  }
}

// All 2^24 numbers that the points can be: the count is the probability, exactly.
TEST(Distribution, TheStatedProbabilityIsTheExactOneOnTheGridOfThePoints) {
  const std::vector<double> weights = {0, 1e-12, 3, 0, 0, 1e-30, 2, 5, 1e-9, 0};
  const Distribution1D distribution = make_distribution_1d(weights);
  std::vector<double> counts(weights.size(), 0);
  for (uint32_t i = 0; i < (1u << 24); ++i) {
    counts[sample_discrete(distribution, static_cast<float>(i) * 0x1p-24f).index] += 0x1p-24;
  }
  for (uint32_t i = 0; i < weights.size(); ++i) {
    EXPECT_EQ(counts[i], static_cast<double>(discrete_probability(distribution, i))) << i;
    EXPECT_EQ(counts[i] > 0, weights[i] > 0) << i;
  }
}

TEST(Distribution, WhatIsLeftOfANumberIsUniformAgain) {
  const Distribution1D distribution = make_distribution_1d(std::vector<double>{1, 0, 2, 1});
  std::vector<double> observed(3 * 32, 0), expected(3 * 32);
  const SampleColumns c = random_columns(400000);
  for (const float u : c.u) {
    const DiscreteSample s = sample_discrete(distribution, u);
    ASSERT_TRUE(s.remapped >= 0 && s.remapped < 1);
    observed[(s.index + 1) / 2 * 32 + static_cast<size_t>(s.remapped * 32)] += 1;
  }
  for (size_t i = 0; i < 96; ++i) expected[i] = 400000 * (i / 32 == 1 ? 0.5 : 0.25) / 32;
  EXPECT_GT(chi_square_test(observed, expected).p_value, chi_square_level);
}

TEST(Distribution, AllZeroWeightsAreUniformAndSaySo) {
  const Distribution1D distribution = make_distribution_1d(std::vector<double>(4, 0.0));
  EXPECT_EQ(distribution.sum, 0);
  for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(discrete_probability(distribution, i), 0.25f);
  const Distribution2D square = make_distribution_2d(std::vector<double>(6, 0.0), 3, 2);
  EXPECT_EQ(square.mean, 0);
  EXPECT_NEAR(square_pdf(square, 0.1f, 0.9f), 1, 1e-6);
}

TEST(Distribution, ASingleBinTakesEveryNumberUnchanged) {
  const Distribution1D distribution = make_distribution_1d(std::vector<double>{42.0});
  for (const float u : {0.0f, 0.25f, largest_u}) {
    const DiscreteSample s = sample_discrete(distribution, u);
    EXPECT_EQ(s.index, 0u);
    EXPECT_EQ(s.probability, 1.0f);
    EXPECT_EQ(s.remapped, u);
  }
}

TEST(Distribution, UnusableAndExtremeWeightsDoNotSpoilTheRest) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> weights = {NAN, 1, -3, infinity, 1, 0};
  const Distribution1D distribution = make_distribution_1d(weights);
  EXPECT_EQ(distribution.sum, 2);
  for (uint32_t i = 0; i < 6; ++i) EXPECT_EQ(discrete_probability(distribution, i), i == 1 || i == 4 ? 0.5f : 0.0f);
  for (const double scale : {1e300, 1e-320}) {
    const Distribution1D scaled = make_distribution_1d(std::vector<double>{scale, scale, scale, scale});
    EXPECT_EQ(discrete_probability(scaled, 3), 0.25f);
    EXPECT_TRUE(std::isfinite(scaled.sum));
  }
}

TEST(Distribution, ALargeNumberOfBinsKeepsEachReachable) {
  std::vector<double> weights(max_distribution_bins, 1e-20);
  weights[12345] = 1;
  const Distribution1D distribution = make_distribution_1d(weights);
  EXPECT_EQ(distribution.cdf[0], 0.0f);
  EXPECT_EQ(distribution.cdf[max_distribution_bins], 1.0f);
  for (uint32_t i = 0; i < max_distribution_bins; ++i) ASSERT_GE(discrete_probability(distribution, i), 0x1p-24f);
  EXPECT_NEAR(discrete_probability(distribution, 12345), 0.75, 1e-6);
}

TEST(Distribution, VectorsDrawTheSameBitsAsTheScalarTwin) {
  SampleColumns c = random_columns(1 << 14);
  for (const size_t n : {1u, 2u, 3u, 100u, 4097u}) {
    const Distribution1D distribution = make_distribution_1d(rough_weights(n, 5));
    for_each_target([&] {
      HWY_DYNAMIC_DISPATCH(sample_1d_columns)(&distribution, &c);
      for (size_t i = 0; i < c.u.size(); ++i) {
        const DiscreteSample s = sample_discrete(distribution, c.u[i]);
        ASSERT_EQ(c.index[i], static_cast<int32_t>(s.index));
        ASSERT_EQ(c.probability[i], s.probability);
        ASSERT_EQ(c.pdf[i], s.probability);
        ASSERT_EQ(c.x[i], s.remapped);
      }
    });
  }
}

struct Size {
  uint32_t width, height;
};

TEST(Distribution, SquareSamplesAreTheSameBitsInVectorsAndTheirPdfIsFoundAgain) {
  SampleColumns c = random_columns(1 << 14);
  for (const Size size : {Size{1, 1}, Size{5, 1}, Size{1, 9}, Size{37, 23}, Size{2048, 1024}, Size{3000, 7}}) {
    const size_t cells = size_t{size.width} * size.height;
    const Distribution2D distribution = make_distribution_2d(rough_weights(cells, 6), size.width, size.height);
    for_each_target([&] {
      HWY_DYNAMIC_DISPATCH(sample_2d_columns)(&distribution, &c);
      for (size_t i = 0; i < c.u.size(); ++i) {
        const SquareSample s = sample_square(distribution, c.u[i], c.v[i]);
        ASSERT_EQ(c.index[i], static_cast<int32_t>(s.cell));
        ASSERT_EQ(c.x[i], s.x);
        ASSERT_EQ(c.y[i], s.y);
        ASSERT_EQ(c.probability[i], s.pdf);
        ASSERT_GT(s.pdf, 0.0f);
        ASSERT_EQ(c.pdf[i], s.pdf) << "the point fell into a neighbour of its cell";
        ASSERT_EQ(square_pdf(distribution, s.x, s.y), s.pdf);
        ASSERT_TRUE(s.x >= 0 && s.x < 1 && s.y >= 0 && s.y < 1);
      }
    });
  }
}

TEST(Distribution, CellsOfTheSquareAreDrawnInProportionToTheirWeight) {
  const uint32_t width = 33, height = 17;
  std::vector<double> weights = rough_weights(width * height, 8);
  for (uint32_t x = 0; x < width; ++x) weights[4 * width + x] = 0;  // a row of nothing
  const Distribution2D distribution = make_distribution_2d(weights, width, height);
  const SampleColumns c = random_columns(1000000);
  std::vector<double> observed(weights.size(), 0), expected(weights.size());
  for (size_t i = 0; i < c.u.size(); ++i) observed[sample_square(distribution, c.u[i], c.v[i]).cell] += 1;
  for (size_t i = 0; i < weights.size(); ++i) {
    expected[i] = 1e6 * weights[i] / (distribution.mean * static_cast<double>(weights.size()));
    const auto x = (static_cast<float>(i % width) + 0.5f) / width, y = (static_cast<float>(i / width) + 0.5f) / height;
    EXPECT_EQ(square_pdf(distribution, x, y) > 0, weights[i] > 0);
  }
  EXPECT_GT(chi_square_test(observed, expected).p_value, chi_square_level);
}

}  // namespace
}  // namespace metamer
#endif
