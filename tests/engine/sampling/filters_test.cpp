// The pixel filters: sampled in proportion to their magnitude; weights are 1 but where there are negative lobes.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/engine/sampling/filters_test.cpp"
#include "engine/sampling/filters.h"

#include <gtest/gtest.h>
#include <hwy/foreach_target.h>

#include <cmath>
#include <random>
#include <vector>

#include "engine/sampling/filters-inl.h"
#include "engine/simd/column.h"
#include "tests/support/chi_square.h"
#include "tests/support/each_target.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

void filter_columns(const PixelFilter* filter, const Column<float>* u, const Column<float>* v, float* x, float* y,
                    float* weight) {
  const FloatTag d;
  for (size_t i = 0; i < u->size(); i += hn::Lanes(d)) {
    const Point2V p = sample_filter(*filter, hn::Load(d, u->data() + i), hn::Load(d, v->data() + i));
    hn::Store(p.x, d, x + i);
    hn::Store(p.y, d, y + i);
    hn::Store(filter_weight(*filter, hn::Load(d, u->data() + i), hn::Load(d, v->data() + i)), d, weight + i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(filter_columns);
namespace {

std::vector<PixelFilter> filters() {
  std::vector<PixelFilter> all;
  all.push_back(make_pixel_filter(FilterKind::box, 0.5, 0.5));
  all.push_back(make_pixel_filter(FilterKind::box, 1.5, 0.25));
  all.push_back(make_pixel_filter(FilterKind::triangle, 2, 2));
  all.push_back(make_pixel_filter(FilterKind::triangle, 1, 0.5));
  all.push_back(make_pixel_filter(FilterKind::gaussian, 1.5, 1.5));  // pbrt-v4's default
  all.push_back(make_pixel_filter(FilterKind::gaussian, 2, 1, {.sigma = 0.4f}));
  all.push_back(make_pixel_filter(FilterKind::gaussian, 1, 1, {.sigma = 20}));    // almost a parabola
  all.push_back(make_pixel_filter(FilterKind::gaussian, 3, 3, {.sigma = 0.3f}));  // cut at ten sigma
  return all;
}

std::vector<PixelFilter> signed_filters() {
  std::vector<PixelFilter> all;
  all.push_back(make_pixel_filter(FilterKind::mitchell, 2, 2));
  all.push_back(make_pixel_filter(FilterKind::mitchell, 1.5, 3, {.b = 0, .c = 0.5f}));  // Catmull and Rom's
  all.push_back(make_pixel_filter(FilterKind::sinc, 4, 4));
  all.push_back(make_pixel_filter(FilterKind::sinc, 2, 2.5, {.tau = 2}));
  return all;
}

double independent_value(const PixelFilter& f, double x, double y) {
  const double rx = f.radius_x, ry = f.radius_y;
  if (std::fabs(x) > rx || std::fabs(y) > ry) return 0;
  switch (f.kind) {
    case FilterKind::box: return 1;
    case FilterKind::triangle: return (rx - std::fabs(x)) * (ry - std::fabs(y));
    default: break;
  }
  const double sigma = f.parameters.sigma;
  const auto g = [&](double t) { return std::exp(-t * t / (2 * sigma * sigma)); };
  return (g(x) - g(rx)) * (g(y) - g(ry));
}

TEST(Filters, TheValueIsDividedByTheIntegral) {
  for (const PixelFilter& f : filters()) {
    const double rx = f.radius_x, ry = f.radius_y;
    const auto value = [&](double x, double y) { return independent_value(f, x, y); };
    const double integral = integrate_rectangle(value, -rx, rx, -ry, ry, 64);
    for (const double x : {0.0, 0.3, -0.7, 0.99}) {
      for (const double y : {0.0, -0.2, 0.8}) {
        const double expected = value(x * rx, y * ry) / integral;
        EXPECT_NEAR(filter_value(f, x * rx, y * ry), expected, 1e-9 * filter_value(f, 0, 0));
      }
    }
    EXPECT_EQ(filter_value(f, rx * 1.001, 0), 0);
  }
}

TEST(Filters, OffsetsAreDrawnInProportionToTheFilter) {
  const size_t bins = 40, n = 1000000;
  for (const PixelFilter& f : filters()) {
    SCOPED_TRACE(static_cast<int>(f.kind));
    const double rx = f.radius_x, ry = f.radius_y;
    std::vector<double> observed(bins * bins, 0), expected(bins * bins);
    std::mt19937_64 rng(13);
    std::uniform_real_distribution<double> unit(0, 1);
    for (size_t i = 0; i < n; ++i) {
      const double u = unit(rng), v = unit(rng);
      const PointD2 p = sample_filter(f, u, v);
      ASSERT_TRUE(std::fabs(p.x) <= rx && std::fabs(p.y) <= ry);
      const auto column = static_cast<size_t>((p.x / rx + 1) / 2 * bins);
      const auto row = static_cast<size_t>((p.y / ry + 1) / 2 * bins);
      observed[std::min(row, bins - 1) * bins + std::min(column, bins - 1)] += 1;
    }
    for (size_t i = 0; i < bins; ++i) {
      for (size_t j = 0; j < bins; ++j) {
        const double x0 = -rx + 2 * rx * double(j) / bins, y0 = -ry + 2 * ry * double(i) / bins;
        expected[i * bins + j] = n * integrate_rectangle([&](double x, double y) { return filter_value(f, x, y); }, x0,
                                                         x0 + 2 * rx / bins, y0, y0 + 2 * ry / bins, 4);
      }
    }
    EXPECT_GT(chi_square_test(observed, expected).p_value, chi_square_level);
  }
}

// Far below what a million draws can show: the table's moments against those of the filter.
TEST(Filters, TheTablesMomentsAreThoseOfTheFilter) {
  for (const PixelFilter& f : filters()) {
    const int n = 200000;
    double second = 0, fourth = 0;
    for (int i = 0; i < n; ++i) {
      const double x = sample_filter(f, (i + 0.5) / n, 0.5).x / f.radius_x;
      second += x * x / n;
      fourth += x * x * x * x / n;
    }
    const double rx = f.radius_x, ry = f.radius_y;
    const auto moment = [&](double power) {
      return integrate_rectangle(
          [&](double x, double y) { return std::pow(std::fabs(x) / rx, power) * filter_value(f, x, y); }, -rx, rx, -ry,
          ry, 64);
    };
    EXPECT_NEAR(second / moment(2), 1, 1e-4);
    EXPECT_NEAR(fourth / moment(4), 1, 1e-4);
  }
}

// Mitchell and Netravali's for B = C = 1/3 is 8/9, 1/18, -5/144 at 0, 1, 3/2; Lanczos's windowed by three pixels is
// sinc(x) sinc(x / 3).
TEST(Filters, NegativeLobesHaveThePublishedValues) {
  const PixelFilter mitchell = make_pixel_filter(FilterKind::mitchell, 4, 2);
  const double centre = filter_value(mitchell, 0, 0);
  EXPECT_NEAR(centre, 8.0 / 9 * 8 / 9 / 2, 1e-6) << "the integral over [-2, 2] is 1, over [-4, 4] 2";
  EXPECT_NEAR(filter_value(mitchell, 2, 0) / centre, 1.0 / 16, 1e-6);
  EXPECT_NEAR(filter_value(mitchell, 0, -1.5) / centre, -5.0 / 128, 1e-6);
  EXPECT_NEAR(filter_value(mitchell, 0, 2), 0, 1e-9);
  const PixelFilter sinc = make_pixel_filter(FilterKind::sinc, 4, 4);
  EXPECT_NEAR(filter_value(sinc, 0.5, 0) / filter_value(sinc, 0, 0), 0.607927, 1e-6);
  EXPECT_NEAR(filter_value(sinc, 0, -1.5) / filter_value(sinc, 0, 0), -0.135095, 1e-6);
  EXPECT_EQ(filter_value(sinc, 4.01, 0), 0);
}

// Means over a grid that has as many places in every cell of the tables.
TEST(Filters, WeightedSamplesOfNegativeLobesAreTheFilter) {
  const int n = 2 * filter_table_cells;
  for (const PixelFilter& f : signed_filters()) {
    SCOPED_TRACE(static_cast<int>(f.kind));
    double mean = 0, least = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double weight = filter_weight(f, (i + 0.5) / n, (j + 0.5) / n);
        mean += weight / n / n;
        least = std::min(least, weight);
      }
    EXPECT_NEAR(mean, 1, 1e-6) << "what is white stays white";
    EXPECT_LT(least, 0);
    for (const double frequency : {0.3, 1.0, 3.0}) {
      double sums[2] = {}, norms[2] = {};
      for (int i = 0; i < 8 * n; ++i) {
        const double u = (i + 0.5) / (8 * n);
        const double weights[2] = {filter_weight(f, u, 0.5), filter_weight(f, 0.5, u)};
        const double offsets[2] = {sample_filter(f, u, 0.5).x, sample_filter(f, 0.5, u).y};
        for (int axis = 0; axis < 2; ++axis) {
          sums[axis] += weights[axis] * std::cos(frequency * offsets[axis]);
          norms[axis] += weights[axis];
        }
      }
      for (int axis = 0; axis < 2; ++axis) {
        const auto wave = [&](double x, double y) {
          return std::cos(frequency * (axis == 0 ? x : y)) * filter_value(f, x, y);
        };
        const double rx = f.radius_x, ry = f.radius_y;
        const double expected = integrate_rectangle(wave, -rx, rx, -ry, ry, 128);
        // Within its cells a table is even.
        EXPECT_NEAR(sums[axis] / norms[axis], expected, 1e-3) << frequency << " " << axis;
      }
    }
  }
}

TEST(Filters, VectorsAgreeWithTheScalarTwin) {
  const size_t n = 1 << 14;
  Column<float> u(n), v(n), x(n), y(n), weight(n);
  std::mt19937 rng(14);
  for (size_t i = 0; i < n; ++i) u[i] = float(rng() >> 8) * 0x1p-24f, v[i] = float(rng() >> 8) * 0x1p-24f;
  u[0] = 0, u[1] = 0.5f, u[2] = 0x1.fffffep-1f, v[0] = 0x1.fffffep-1f;
  std::vector<PixelFilter> all = filters();
  for (PixelFilter& f : signed_filters()) all.push_back(std::move(f));
  for (const PixelFilter& f : all) {
    for_each_target([&] {
      HWY_DYNAMIC_DISPATCH(filter_columns)(&f, &u, &v, x.data(), y.data(), weight.data());
      double worst = 0, worst_weight = 0;
      for (size_t i = 0; i < n; ++i) {
        const PointD2 p = sample_filter(f, u[i], v[i]);
        worst = std::max({worst, std::fabs(x[i] - p.x) / f.radius_x, std::fabs(y[i] - p.y) / f.radius_y});
        worst_weight = std::max(worst_weight, std::fabs(weight[i] - filter_weight(f, u[i], v[i])));
      }
      EXPECT_LE(worst_weight, 1e-6) << static_cast<int>(f.kind);
      EXPECT_LE(worst, f.kind == FilterKind::gaussian ? 1e-5 : 5e-7) << static_cast<int>(f.kind);
    });
  }
}

}  // namespace
}  // namespace metamer
#endif
