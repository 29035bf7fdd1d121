// The vector functions against double precision, on every instruction set this machine has. The bounds are those
// stated in engine/simd/math-inl.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/engine/simd/math_test.cpp"
#include <gtest/gtest.h>
#include <hwy/foreach_target.h>

#include <cfloat>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "engine/simd/column.h"
#include "engine/simd/math-inl.h"
#include "tests/support/each_target.h"

#ifndef METAMER_TESTS_ENGINE_SIMD_MATH_TEST_ONCE
#define METAMER_TESTS_ENGINE_SIMD_MATH_TEST_ONCE
namespace metamer {
enum class Function { exp, exp2, log, pow, sin, cos, sin_2pi, cos_2pi, atan2, acos, safe_sqrt, safe_reciprocal };
}
#endif

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

VF apply(Function function, VF x, VF y) {
  switch (function) {
    case Function::exp: return exp(x);
    case Function::exp2: return exp2(x);
    case Function::log: return log(x);
    case Function::pow: return pow(x, y);
    case Function::sin: return sincos(x).sin;
    case Function::cos: return sincos(x).cos;
    case Function::sin_2pi: return sincos_2pi(x).sin;
    case Function::cos_2pi: return sincos_2pi(x).cos;
    case Function::atan2: return atan2(x, y);
    case Function::acos: return acos(x);
    case Function::safe_sqrt: return safe_sqrt(x);
    case Function::safe_reciprocal: break;
  }
  return safe_reciprocal(x);
}

void apply_columns(Function function, const float* x, const float* y, float* out, size_t n) {
  const FloatTag d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    hn::Store(apply(function, hn::Load(d, x + i), hn::Load(d, y + i)), d, out + i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(apply_columns);
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

float apply_one(Function function, float x, float y = 0) {
  Column<float> xs(16), ys(16), out(16);
  for (size_t i = 0; i < 16; ++i) xs[i] = x, ys[i] = y;
  HWY_DYNAMIC_DISPATCH(apply_columns)(function, xs.data(), ys.data(), out.data(), 16);
  return out[0];
}

enum class Measure { relative, absolute };

struct Range {
  double low, high;
  bool logarithmic = false;
};

float draw(std::mt19937_64& rng, const Range& range) {
  std::uniform_real_distribution<double> u(0, 1);
  if (range.logarithmic) return static_cast<float>(range.low * std::pow(range.high / range.low, u(rng)));
  return static_cast<float>(range.low + (range.high - range.low) * u(rng));
}

template <class Exact>
void expect_error_below(double bound, Measure measure, Function function, const Exact& exact, Range x_range,
                        Range y_range = {0, 0}) {
  const size_t n = size_t{1} << 18;
  std::mt19937_64 rng(6);
  Column<float> x(n), y(n), out(n);
  for (size_t i = 0; i < n; ++i) x[i] = draw(rng, x_range), y[i] = draw(rng, y_range);
  x[0] = static_cast<float>(x_range.low), x[1] = static_cast<float>(x_range.high);
  for_each_target([&] {
    HWY_DYNAMIC_DISPATCH(apply_columns)(function, x.data(), y.data(), out.data(), n);
    double worst = 0;
    size_t at = 0;
    for (size_t i = 0; i < n; ++i) {
      const double truth = exact(static_cast<double>(x[i]), static_cast<double>(y[i]));
      if (measure == Measure::relative && (truth > 3.4028e38 || std::fabs(truth) < 1.1755e-38)) continue;
      double error = std::fabs(static_cast<double>(out[i]) - truth);
      if (measure == Measure::relative) error /= std::fabs(truth);
      if (!(error <= worst)) worst = error, at = i;
    }
    EXPECT_LE(worst, bound) << "at " << x[at] << ", " << y[at] << ": " << out[at];
    EXPECT_GE(worst, bound * 0.2) << "the stated bound is far from tight";
  });
}

TEST(Math, ExponentialsKeepTheirStatedError) {
  const auto exp_d = [](double x, double) { return std::exp(x); };
  const auto exp2_d = [](double x, double) { return std::exp2(x); };
  expect_error_below(1.5e-7, Measure::relative, Function::exp, exp_d, {-87.33, 88.72});
  expect_error_below(1.5e-7, Measure::relative, Function::exp, exp_d, {-1, 1});
  expect_error_below(1.5e-7, Measure::relative, Function::exp2, exp2_d, {-126, 127.99});
  for_each_target([] {
    for (const Function f : {Function::exp, Function::exp2}) {
      EXPECT_EQ(apply_one(f, 0), 1.0f);
      EXPECT_EQ(apply_one(f, -200), 0.0f);
      EXPECT_EQ(apply_one(f, -inf), 0.0f);
      EXPECT_EQ(apply_one(f, 129), inf);
      EXPECT_EQ(apply_one(f, inf), inf);
      EXPECT_TRUE(std::isnan(apply_one(f, not_a_number)));
    }
    EXPECT_EQ(apply_one(Function::exp2, 10), 1024.0f);
  });
}

TEST(Math, LogKeepsItsStatedError) {
  const auto log_d = [](double x, double) { return std::log(x); };
  expect_error_below(2e-7, Measure::relative, Function::log, log_d, {1.2e-38, 3.4e38, true});
  expect_error_below(2e-7, Measure::relative, Function::log, log_d, {0.5, 2});
  expect_error_below(2e-7, Measure::relative, Function::log, log_d, {0.99, 1.01});
  for_each_target([] {
    EXPECT_EQ(apply_one(Function::log, 1), 0.0f);
    EXPECT_EQ(apply_one(Function::log, 0), -inf);
    EXPECT_EQ(apply_one(Function::log, inf), inf);
    EXPECT_TRUE(std::isnan(apply_one(Function::log, -1)));
    EXPECT_TRUE(std::isnan(apply_one(Function::log, not_a_number)));
  });
}

TEST(Math, PowKeepsItsStatedErrorOverTheWholeRange) {
  const auto pow_d = [](double x, double y) { return std::pow(x, y); };
  expect_error_below(2e-7, Measure::relative, Function::pow, pow_d, {1.2e-38, 3.4e38, true}, {-1, 1});
  expect_error_below(2e-7, Measure::relative, Function::pow, pow_d, {0.9, 1.1}, {-900, 900});
  expect_error_below(2e-7, Measure::relative, Function::pow, pow_d, {1e-6, 1, true}, {0, 6});
}

TEST(Math, PowHasTheSpecialValuesOfTheStandard) {
  for_each_target([] {
    for (const float x : {0.0f, 1.0f, 0.5f, 2.0f, inf}) {
      for (const float y : {0.0f, 1.0f, -1.0f, 3.0f, inf, -inf}) {
        EXPECT_FLOAT_EQ(apply_one(Function::pow, x, y), std::pow(x, y)) << x << " ^ " << y;
      }
    }
    EXPECT_TRUE(std::isnan(apply_one(Function::pow, -1, 2)));
    EXPECT_TRUE(std::isnan(apply_one(Function::pow, 2, not_a_number)));
    EXPECT_TRUE(std::isnan(apply_one(Function::pow, not_a_number, 2)));
  });
}

TEST(Math, SineAndCosineKeepTheirStatedError) {
  const auto sin_d = [](double x, double) { return std::sin(x); };
  const auto cos_d = [](double x, double) { return std::cos(x); };
  for (const double range : {7.0, 3000.0}) {
    expect_error_below(1.5e-7, Measure::absolute, Function::sin, sin_d, {-range, range});
    expect_error_below(1.5e-7, Measure::absolute, Function::cos, cos_d, {-range, range});
  }
  const double turn = 6.283185307179586;
  const auto sin_2pi_d = [&](double u, double) { return std::sin(turn * u); };
  const auto cos_2pi_d = [&](double u, double) { return std::cos(turn * u); };
  expect_error_below(1.2e-7, Measure::absolute, Function::sin_2pi, sin_2pi_d, {-1, 1});
  expect_error_below(1.2e-7, Measure::absolute, Function::cos_2pi, cos_2pi_d, {-1, 1});
  for_each_target([] {
    for (const float u : {0.0f, 0.5f, 1.0f}) EXPECT_EQ(apply_one(Function::sin_2pi, u), 0.0f);
    for (const float u : {0.25f, 0.75f}) EXPECT_EQ(apply_one(Function::cos_2pi, u), 0.0f);
    EXPECT_EQ(apply_one(Function::cos_2pi, 0.5f), -1.0f);
    EXPECT_EQ(apply_one(Function::sin_2pi, 0.75f), -1.0f);
  });
}

TEST(Math, Atan2KeepsItsStatedErrorInEveryQuadrant) {
  const auto atan2_d = [](double y, double x) { return std::atan2(y, x); };
  expect_error_below(5e-7, Measure::absolute, Function::atan2, atan2_d, {-1, 1}, {-1, 1});
  for_each_target([] {
    for (const float y : {0.0f, -0.0f, 2.0f, -2.0f}) {
      for (const float x : {0.0f, -0.0f, 3.0f, -3.0f}) {
        EXPECT_FLOAT_EQ(apply_one(Function::atan2, y, x), std::atan2(y, x)) << y << ' ' << x;
        EXPECT_EQ(std::signbit(apply_one(Function::atan2, y, x)), std::signbit(y));
      }
    }
  });
}

TEST(Math, AcosKeepsItsStatedErrorAndItsDetailNearOne) {
  const auto acos_d = [](double x, double) { return std::acos(x); };
  expect_error_below(4e-7, Measure::absolute, Function::acos, acos_d, {-1, 1});
  expect_error_below(3e-7, Measure::relative, Function::acos, acos_d, {0.51, 0.9999999});
  for_each_target([] {
    EXPECT_EQ(apply_one(Function::acos, 1), 0.0f);
    EXPECT_EQ(apply_one(Function::acos, 1.00001f), 0.0f);
    EXPECT_FLOAT_EQ(apply_one(Function::acos, -1.00001f), 3.14159265f);
  });
}

TEST(Math, SafeFunctionsStayFiniteWhereTheExactOnesDoNot) {
  for_each_target([] {
    EXPECT_EQ(apply_one(Function::safe_sqrt, -1e-7f), 0.0f);
    EXPECT_EQ(apply_one(Function::safe_sqrt, 4), 2.0f);
    EXPECT_EQ(apply_one(Function::safe_reciprocal, 0.0f), 1 / FLT_MIN);
    EXPECT_EQ(apply_one(Function::safe_reciprocal, -0.0f), -1 / FLT_MIN);
    EXPECT_EQ(apply_one(Function::safe_reciprocal, -4), -0.25f);
    EXPECT_EQ(apply_one(Function::safe_reciprocal, inf), 0.0f);
  });
}

}  // namespace
}  // namespace metamer
#endif
