// The points as random numbers: uniform, independent where they should be, and better than independent where
// they should not.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "engine/sampling/points.h"
#include "tests/support/chi_square.h"

namespace metamer {
namespace {

constexpr uint32_t side = 256;  // pixels: side * side
using Pair = std::array<double, 2>;

// Joint histogram, over all pixels, of two numbers that should be independent.
template <class Draw>
double joint_p_value(const Draw& draw, size_t bins = 16) {
  std::vector<double> observed(bins * bins, 0), expected(bins * bins, side * side / double(bins * bins));
  for (uint32_t y = 0; y < side; ++y) {
    for (uint32_t x = 0; x < side; ++x) {
      const Pair p = draw(x, y);
      observed[static_cast<size_t>(p[0] * double(bins)) * bins + static_cast<size_t>(p[1] * double(bins))] += 1;
    }
  }
  return chi_square_test(observed, expected).p_value;
}

TEST(PointsStatistics, EverySinglePointIsUniformInTheSquareOverPixels) {
  for (const uint32_t sample : {0u, 1u, 2u, 7u, 4096u, 1234567u}) {
    for (const uint32_t dimension : {0u, 1u, 9u, 500u}) {
      const double p = joint_p_value([&](uint32_t x, uint32_t y) {
        const Point2 point = sample_2d(make_point_key(x, y, sample, 0), dimension);
        return Pair{point.u, point.v};
      });
      EXPECT_GT(p, chi_square_level) << "sample " << sample << " dimension " << dimension;
    }
  }
}

TEST(PointsStatistics, NeighbouringDimensionsPixelsReplicatesAndSeedsAreIndependent) {
  for (const uint32_t sample : {0u, 5u, 1000u}) {
    const auto p_value = [&](const auto& other) {
      return joint_p_value([&](uint32_t x, uint32_t y) {
        return Pair{sample_1d(make_point_key(x, y, sample, 3), 4), other(x, y)};
      });
    };
    const auto dimension = [&](uint32_t d) {
      return p_value([&, d](uint32_t x, uint32_t y) { return sample_1d(make_point_key(x, y, sample, 3), d); });
    };
    for (const uint32_t d : {0u, 3u, 5u, 6u, 12u, 4u + (1u << 31)}) EXPECT_GT(dimension(d), chi_square_level) << d;
    const auto at = [&](uint32_t dx, uint32_t dy, uint32_t dsample, uint32_t dseed) {
      return p_value([=](uint32_t x, uint32_t y) {
        return sample_1d(make_point_key(x + dx, y + dy, sample + dsample, 3 + dseed), 4);
      });
    };
    EXPECT_GT(at(1, 0, 0, 0), chi_square_level) << "pixel to the right";
    EXPECT_GT(at(0, 1, 0, 0), chi_square_level) << "pixel below";
    EXPECT_GT(at(1u << 16, 0, 0, 0), chi_square_level) << "very large picture";
    EXPECT_GT(at(0, 0, 1, 0), chi_square_level) << "next replicate";
    EXPECT_GT(at(0, 0, 2, 0), chi_square_level) << "replicate after that";
    EXPECT_GT(at(0, 0, 0, 1), chi_square_level) << "next seed";
    EXPECT_GT(at(0, 0, 0, 1u << 31), chi_square_level) << "far seed";
  }
}

// Within a pixel the order of each dimension is shuffled on its own: over a net's 16 points, u of one
// dimension tells nothing of another's.
TEST(PointsStatistics, DimensionsOfTheSamePixelAreUncorrelatedOverItsSamples) {
  const auto correlation = [](uint32_t a, uint32_t b) {
    double sum = 0;
    for (uint32_t pixel = 0; pixel < 4096; ++pixel) {
      for (uint32_t i = 0; i < 16; ++i) {
        const PointKeyScalar key = make_point_key(pixel, 11, i * replicate_count, 0);
        sum += 12 * (sample_1d(key, a) - 0.5) * (sample_1d(key, b) - 0.5);
      }
    }
    return sum / (4096 * 16);
  };
  for (const uint32_t b : {1u, 2u, 3u, 64u}) EXPECT_LT(std::fabs(correlation(0, b)), 5 / std::sqrt(4096 * 16)) << b;
  EXPECT_NEAR(correlation(0, 0), 1, 0.01);
}

struct Estimate {
  double bias_in_sigmas, rmse;
};

// One replicate's mean of f(u, v) over n points, over many pixels.
template <class F>
Estimate estimate(const F& f, double exact, uint32_t n) {
  const uint32_t pixels = 1024;
  double sum = 0, squares = 0;
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    double mean = 0;
    for (uint32_t i = 0; i < n; ++i) mean += f(make_point_key(pixel, 5, i * replicate_count + 1, 0));
    const double error = mean / n - exact;
    sum += error, squares += error * error;
  }
  return {sum / std::sqrt(squares), std::sqrt(squares / pixels)};
}

// Owen, "Scrambled net variance for integrals of smooth functions", 1997: n^-1.5 (times a power of log n) against
// the n^-0.5 of independent samples.
TEST(PointsStatistics, TheErrorOfASmoothIntegrandFallsFasterThanThatOfIndependentSamples) {
  const auto smooth_2d = [](const PointKeyScalar& key) {
    const Point2 p = sample_2d(key, 6);
    return std::exp(p.u) * std::sin(2 * p.v);
  };
  const double exact_2d = (std::exp(1.0) - 1) * (1 - std::cos(2.0)) / 2;
  const auto smooth_1d = [](const PointKeyScalar& key) { return std::exp(sample_1d(key, 8)); };
  const Estimate few_2d = estimate(smooth_2d, exact_2d, 16), many_2d = estimate(smooth_2d, exact_2d, 1024);
  const Estimate few_1d = estimate(smooth_1d, std::exp(1.0) - 1, 16);
  const Estimate many_1d = estimate(smooth_1d, std::exp(1.0) - 1, 1024);
  EXPECT_LT(std::log(many_2d.rmse / few_2d.rmse) / std::log(64.0), -1.3);
  EXPECT_LT(std::log(many_1d.rmse / few_1d.rmse) / std::log(64.0), -1.4);
  for (const Estimate& e : {few_2d, many_2d, few_1d, many_1d}) EXPECT_LT(std::fabs(e.bias_in_sigmas), 4);
}

// Padding gains nothing across dimensions. It may lose a little: neighbours in a net lie in opposite quadrants, so
// (u - 1/2)(v - 1/2) has the same sign for both, and the nested shuffle keeps neighbours together. The variance of
// this integrand, which lives on nothing else, is 1.7 times that of independent samples at any number of them,
// below Owen's bound of e = 2.72 for any integrand on a (0, m, s)-net (2.0 asserted here).
TEST(PointsStatistics, AnInteractionAcrossDimensionsLosesNoMoreThanABoundedFactor) {
  const auto interaction = [](const PointKeyScalar& key) {
    const Point2 a = sample_2d(key, 0), b = sample_2d(key, 1);
    return 144 * (a.u - 0.5) * (a.v - 0.5) * (b.u - 0.5) * (b.v - 0.5);  // variance 1
  };
  for (const uint32_t n : {4u, 16u, 64u, 256u}) {
    const Estimate e = estimate(interaction, 0, n);
    EXPECT_LT(e.rmse * e.rmse * n, 2.0) << n;
    EXPECT_LT(std::fabs(e.bias_in_sigmas), 4) << n;
  }
}

// The four replicates' means are independent, which the variance estimate relies on.
TEST(PointsStatistics, MeansOfReplicatesAreUncorrelated) {
  const uint32_t pixels = 8192;
  double product = 0, square = 0;
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    double means[2] = {0, 0};
    for (uint32_t r = 0; r < 2; ++r) {
      for (uint32_t i = 0; i < 8; ++i) {
        const Point2 p = sample_2d(make_point_key(pixel, 2, i * replicate_count + r, 0), 3);
        means[r] += p.u * p.v - 0.25;
      }
    }
    product += means[0] * means[1];
    square += (means[0] * means[0] + means[1] * means[1]) / 2;
  }
  EXPECT_LT(std::fabs(product / square), 4.5 / std::sqrt(pixels));
}

}  // namespace
}  // namespace metamer
