#include "tests/support/chi_square.h"

#include <gtest/gtest.h>

#include <random>

namespace metamer {
namespace {

// Abramowitz and Stegun, "Handbook of Mathematical Functions", table 26.8: upper percentage points.
TEST(ChiSquare, PValuesAreThoseOfThePublishedTable) {
  EXPECT_NEAR(chi_square_p_value(3.84146, 1), 0.05, 1e-7);
  EXPECT_NEAR(chi_square_p_value(6.63490, 1), 0.01, 1e-7);
  EXPECT_NEAR(chi_square_p_value(18.3070, 10), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_p_value(124.342, 100), 0.05, 1e-5);
  EXPECT_NEAR(chi_square_p_value(77.9295, 100), 0.95, 1e-5);
  EXPECT_EQ(chi_square_p_value(0, 5), 1);
  EXPECT_LT(chi_square_p_value(1000, 10), 1e-100);
}

TEST(ChiSquare, ARightSamplerPassesAndASlightlyWrongOneFails) {
  std::mt19937 rng(1);
  std::vector<double> observed(50, 0), right(50, 2000), wrong(50, 2000);
  for (int i = 0; i < 100000; ++i) observed[rng() % 50] += 1;
  wrong[3] *= 1.2;
  wrong[4] *= 0.8;
  EXPECT_GT(chi_square_test(observed, right).p_value, 0.01);
  EXPECT_LT(chi_square_test(observed, wrong).p_value, 1e-10);
}

TEST(ChiSquare, SmallBinsArePooledAndImpossibleDrawsAreFatal) {
  const std::vector<double> observed = {1, 0, 2, 97, 100}, expected = {0.5, 0.5, 2, 97, 100};
  EXPECT_EQ(chi_square_test(observed, expected).degrees_of_freedom, 1);
  const std::vector<double> impossible = {0, 0, 3, 97, 100};
  EXPECT_EQ(chi_square_test(observed, impossible).p_value, 0);
}

TEST(ChiSquare, ADensityThatDoesNotIntegrateToOneFails) {
  const std::vector<double> observed = {500, 500}, expected = {550, 550};
  EXPECT_EQ(chi_square_test(observed, expected).p_value, 0);
}

TEST(ChiSquare, DirectionsUniformOnTheSpherePassAndRejectedOnesAreAccountedFor) {
  std::mt19937 rng(2);
  std::normal_distribution<double> normal;
  DirectionHistogram all, upper;
  for (int i = 0; i < 200000; ++i) {
    const double x = normal(rng), y = normal(rng), z = normal(rng), l = std::sqrt(x * x + y * y + z * z);
    all.add(x / l, y / l, z / l);
    if (z > 0) {
      upper.add(x / l, y / l, z / l);
    } else {
      upper.reject();
    }
  }
  const double uniform = 1 / (4 * 3.14159265358979323846);
  EXPECT_GT(all.test([&](double, double, double) { return uniform; }).p_value, chi_square_level);
  EXPECT_GT(upper.test([&](double, double, double z) { return z > 0 ? uniform : 0; }).p_value, chi_square_level);
  EXPECT_LT(all.test([&](double, double, double z) { return uniform * (1 + 0.1 * z); }).p_value, 1e-6);
}

}  // namespace
}  // namespace metamer
