#include "engine/simd/portable_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace metamer {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

double relative_error(double value, long double exact) {
  if (exact == 0) return value == 0 ? 0 : 1;
  return static_cast<double>(std::fabs((static_cast<long double>(value) - exact) / exact));
}

// The 80-bit functions of the C library serve as the truth.
template <class F, class G, class Argument>
void expect_relative_error_below(double bound, const F& f, const G& exact, const Argument& argument) {
  std::mt19937_64 rng(3);
  double worst = 0, at = 0;
  for (int i = 0; i < 200000; ++i) {
    const double x = argument(rng);
    const double error = relative_error(f(x), exact(static_cast<long double>(x)));
    if (!(error <= worst)) worst = error, at = x;
  }
  EXPECT_LE(worst, bound) << "at " << at;
}

auto uniform(double a, double b) {
  return [=](std::mt19937_64& rng) { return std::uniform_real_distribution<double>(a, b)(rng); };
}
auto log_uniform(double a, double b) {
  return [=](std::mt19937_64& rng) { return std::exp(std::uniform_real_distribution<double>(a, b)(rng)); };
}

TEST(PortableMath, ExpAgreesWithTheLibrary) {
  const auto exact = [](long double x) { return std::exp(x); };
  expect_relative_error_below(3e-16, portable::exp, exact, uniform(-1, 1));
  expect_relative_error_below(3e-16, portable::exp, exact, uniform(-700, 709.7));
  EXPECT_EQ(portable::exp(0), 1);
  EXPECT_EQ(portable::exp(1000), inf);
  EXPECT_EQ(portable::exp(-1000), 0);
  EXPECT_NEAR(portable::exp(-744.0) / 0x1p-1074, std::exp(-744.0) / 0x1p-1074, 1);
  EXPECT_TRUE(std::isnan(portable::exp(NAN)));
}

TEST(PortableMath, LogAgreesWithTheLibrary) {
  const auto exact = [](long double x) { return std::log(x); };
  expect_relative_error_below(3e-16, portable::log, exact, log_uniform(-700, 700));
  expect_relative_error_below(3e-16, portable::log, exact, uniform(0.5, 2));
  EXPECT_LE(relative_error(portable::log(5e-324), std::log(static_cast<long double>(5e-324))), 3e-16);
  EXPECT_EQ(portable::log(1), 0);
  EXPECT_EQ(portable::log(0), -inf);
  EXPECT_EQ(portable::log(inf), inf);
  EXPECT_TRUE(std::isnan(portable::log(-1)));
}

TEST(PortableMath, SineCosineAndTangentAgreeWithTheLibrary) {
  const auto sin_l = [](long double x) { return std::sin(x); };
  const auto cos_l = [](long double x) { return std::cos(x); };
  const auto tan_l = [](long double x) { return std::tan(x); };
  for (const double range : {0.8, 7.0, 1e3, 1e6}) {
    expect_relative_error_below(4e-16, portable::sin, sin_l, uniform(-range, range));
    expect_relative_error_below(4e-16, portable::cos, cos_l, uniform(-range, range));
    expect_relative_error_below(8e-16, portable::tan, tan_l, uniform(-range, range));
  }
  for (int n = -100; n <= 100; ++n) {  // the doubles nearest to the zeros, where the reduction cancels most
    const double x = n * 1.57079632679489661923;
    EXPECT_LE(relative_error(portable::sin(x), std::sin(static_cast<long double>(x))), 4e-16) << n;
    EXPECT_LE(relative_error(portable::cos(x), std::cos(static_cast<long double>(x))), 4e-16) << n;
  }
  EXPECT_NEAR(portable::sin(1e9), std::sin(1e9), 1e-6);
  EXPECT_TRUE(std::isnan(portable::sin(inf)));
  EXPECT_TRUE(std::signbit(portable::sin(-0.0)));
}

TEST(PortableMath, Atan2AgreesWithTheLibraryInEveryQuadrantAndAtEveryMagnitude) {
  std::mt19937_64 rng(4);
  std::uniform_real_distribution<double> unit(-1, 1), exponent(-300, 300);
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const double scale = std::pow(10.0, exponent(rng));
    const double y = unit(rng) * scale, x = unit(rng) * ((i & 1) ? scale : scale * std::pow(10.0, 3 * unit(rng)));
    const long double exact = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    worst = std::max(worst, relative_error(portable::atan2(y, x), exact));
  }
  EXPECT_LE(worst, 5e-16);
  for (const double y : {0.0, -0.0, 1.0, -1.0}) {
    for (const double x : {0.0, -0.0, 1.0, -1.0, inf, -inf}) {
      EXPECT_EQ(portable::atan2(y, x), std::atan2(y, x)) << y << ' ' << x;
      EXPECT_EQ(std::signbit(portable::atan2(y, x)), std::signbit(std::atan2(y, x)));
    }
  }
  EXPECT_EQ(portable::atan2(1e-300, 1e-300), std::atan2(1.0, 1.0));
  EXPECT_EQ(portable::atan2(1e308, 1e308), std::atan2(1.0, 1.0));
}

TEST(PortableMath, AcosAgreesWithTheLibraryAlsoNearOne) {
  const auto exact = [](long double x) { return std::acos(x); };
  expect_relative_error_below(6e-16, portable::acos, exact, uniform(-1, 1));
  expect_relative_error_below(6e-16, portable::acos, exact,
                              [](std::mt19937_64& rng) { return 1 - log_uniform(-36, -1)(rng); });
  EXPECT_EQ(portable::acos(1), 0);
  EXPECT_EQ(portable::acos(-1), std::acos(-1.0));
  EXPECT_TRUE(std::isnan(portable::acos(1.0000001)));
}

TEST(PortableMath, PowAgreesWithTheLibraryOverTheWholeRange) {
  std::mt19937_64 rng(5);
  std::uniform_real_distribution<double> exponent(-700, 700), power(-1, 1);
  double worst = 0;
  for (int i = 0; i < 300000; ++i) {
    // x of any magnitude (often near 1), y such that x^y spans the whole range.
    const double log_x = i % 3 == 0 ? exponent(rng) : exponent(rng) * 1e-3;
    const double x = std::exp(log_x), y = exponent(rng) * power(rng) / std::max(1e-9, std::fabs(log_x));
    const long double exact = std::pow(static_cast<long double>(x), static_cast<long double>(y));
    if (exact < 1e-300L || exact > 1e300L) continue;
    worst = std::max(worst, relative_error(portable::pow(x, y), exact));
  }
  EXPECT_LE(worst, 4e-16);
}

TEST(PortableMath, PowHasTheSpecialValuesOfTheStandard) {
  const double values[] = {0.0, -0.0, 1.0, -1.0, 2.0, -2.0, 3.0, -3.0, 0.5, -0.5, inf, -inf, NAN};
  for (const double x : values) {
    for (const double y : values) {
      const double expected = std::pow(x, y), value = portable::pow(x, y);
      if (std::isnan(expected)) {
        EXPECT_TRUE(std::isnan(value)) << x << " ^ " << y;
      } else {
        EXPECT_DOUBLE_EQ(value, expected) << x << " ^ " << y;
        EXPECT_EQ(std::signbit(value), std::signbit(expected)) << x << " ^ " << y;
      }
    }
  }
}

}  // namespace
}  // namespace metamer
