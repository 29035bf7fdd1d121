// Windows of a density: drawn as often as they say, whatever their edges cut, and the SIMD twin against the scalar one.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/engine/sampling/window_distribution_test.cpp"
#include "engine/sampling/window_distribution.h"

#include <gtest/gtest.h>
#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "engine/sampling/window_distribution-inl.h"
#include "engine/simd/column.h"
#include "tests/support/chi_square.h"
#include "tests/support/each_target.h"

#ifndef METAMER_TESTS_ENGINE_SAMPLING_WINDOW_DISTRIBUTION_TEST_ONCE
#define METAMER_TESTS_ENGINE_SAMPLING_WINDOW_DISTRIBUTION_TEST_ONCE
namespace metamer {
struct WindowColumns {
  explicit WindowColumns(size_t n) : x0(n), y0(n), x1(n), y1(n), u(n), v(n), x(n), y(n), pdf(n), again(n) {}
  Column<float> x0, y0, x1, y1, u, v, x, y, pdf, again;
};
}  // namespace metamer
#endif

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

void sample_window_columns(const WindowDistribution* distribution, WindowColumns* c) {
  const FloatTag d;
  for (size_t i = 0; i < c->u.size(); i += hn::Lanes(d)) {
    const WindowV window = {hn::Load(d, c->x0.data() + i), hn::Load(d, c->y0.data() + i), hn::Load(d, c->x1.data() + i),
                            hn::Load(d, c->y1.data() + i)};
    const WindowSampleV s =
        sample_window(*distribution, window, hn::Load(d, c->u.data() + i), hn::Load(d, c->v.data() + i));
    hn::Store(s.x, d, c->x.data() + i);
    hn::Store(s.y, d, c->y.data() + i);
    hn::Store(s.pdf, d, c->pdf.data() + i);
    hn::Store(window_pdf(*distribution, window, s.x, s.y), d, c->again.data() + i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(sample_window_columns);

namespace {

constexpr uint32_t width = 13, height = 7;

// With zeros, a value a thousand times the others, and unusable ones.
std::vector<double> weights() {
  std::vector<double> weights;
  for (uint32_t i = 0; i < width * height; ++i) weights.push_back(i % 5 == 0 ? 0 : 1 + (i * 7) % 11);
  weights[40] = 4000;
  weights[60] = -1;
  weights[61] = std::numeric_limits<double>::quiet_NaN();
  return weights;
}

constexpr DensityWindow windows[] = {{0, 0, 1, 1},
                                     {0.21f, 0.33f, 0.87f, 0.91f},
                                     {0.05f, 0.6f, 0.06f, 0.99f},      // within a column
                                     {0.3f, 0.72f, 0.9f, 0.73f},       // within a row
                                     {0.501f, 0.502f, 0.515f, 0.51f},  // within a cell
                                     {0.9f, 0.9f, 1, 1}};

TEST(WindowDistribution, IsDrawnAsOftenAsItSays) {
  const WindowDistribution distribution = make_window_distribution(weights(), width, height);
  for (const DensityWindow& w : windows) {
    SCOPED_TRACE(w.x0);
    constexpr int bins = 20, draws = 200000;
    std::vector<double> observed(bins * bins, 0.0), expected(bins * bins, 0.0);
    std::mt19937_64 generator(7);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int i = 0; i < draws; ++i) {
      const WindowSample s = sample_window(distribution, w, std::min(uniform(generator), 0x1.fffffep-1f),
                                           std::min(uniform(generator), 0x1.fffffep-1f));
      ASSERT_TRUE(s.x >= w.x0 && s.x <= w.x1 && s.y >= w.y0 && s.y <= w.y1);
      const auto bin = [](float t, float low, float high) {
        return std::clamp(static_cast<int>((t - low) / (high - low) * bins), 0, bins - 1);
      };
      observed[static_cast<size_t>(bin(s.y, w.y0, w.y1) * bins + bin(s.x, w.x0, w.x1))] += 1;
    }
    // The part of each cell in each bin, and the density in its middle.
    double total = 0;
    for (int bin = 0; bin < bins * bins; ++bin)
      for (int cell = 0; cell < static_cast<int>(width * height); ++cell) {
        const auto part = [](double low, double high, int at, double from, double to, double* middle) {
          const double start = std::max(low + (high - low) * at / bins, from),
                       end = std::min(low + (high - low) * (at + 1) / bins, to);
          *middle = (start + end) / 2;
          return std::max(0.0, end - start);
        };
        const int column = cell % static_cast<int>(width), row = cell / static_cast<int>(width);
        double x = 0, y = 0;
        const double across = part(w.x0, w.x1, bin % bins, double(column) / width, double(column + 1) / width, &x);
        const double down = part(w.y0, w.y1, bin / bins, double(row) / height, double(row + 1) / height, &y);
        if (!(across * down > 0)) continue;
        const double share =
            across * down * double{window_pdf(distribution, w, static_cast<float>(x), static_cast<float>(y))};
        expected[static_cast<size_t>(bin)] += share * draws;
        total += share;
      }
    EXPECT_NEAR(total, 1, 1e-4);
    for (double& count : expected) count /= total;
    EXPECT_GT(chi_square_test(observed, expected, 300).p_value, chi_square_level);
  }
}

TEST(WindowDistribution, CellsWithoutWeightAreSeldomDrawnButAre) {
  const WindowDistribution distribution = make_window_distribution(weights(), width, height);
  const DensityWindow all;
  const float dark = window_pdf(distribution, all, 0.5f / width, 0.5f / height);
  EXPECT_NEAR(dark, 1 / 4096.0, 1e-5);
  EXPECT_GT(window_pdf(distribution, all, 1.5f / width, 0.5f / height), dark);
  const WindowDistribution flat = make_window_distribution(std::vector<double>(6, 0.0), 3, 2);
  EXPECT_NEAR(window_pdf(flat, all, 0.5f, 0.5f), 1, 1e-6);
}

TEST(WindowDistribution, EmptyWindowsHaveNothing) {
  const WindowDistribution distribution = make_window_distribution(weights(), width, height);
  for (const DensityWindow& w :
       {DensityWindow{0.5f, 0, 0.5f, 1}, DensityWindow{0, 0.7f, 1, 0.6f}, DensityWindow{1, 1, 1, 1}}) {
    EXPECT_EQ(sample_window(distribution, w, 0.3f, 0.3f).pdf, 0);
    EXPECT_EQ(window_pdf(distribution, w, 0.5f, 0.65f), 0);
  }
  EXPECT_EQ(window_pdf(distribution, {0.2f, 0.2f, 0.3f, 0.3f}, 0.35f, 0.25f), 0) << "outside";
}

TEST(WindowDistribution, TheTwinsAgree) {
  const WindowDistribution distribution = make_window_distribution(weights(), width, height);
  WindowColumns c(4096);
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (size_t i = 0; i < c.u.size(); ++i) {
    const float low_x = uniform(generator), low_y = uniform(generator);
    c.x0[i] = 0.98f * low_x;
    c.y0[i] = 0.98f * low_y;
    c.x1[i] = i % 16 == 3 ? c.x0[i] : c.x0[i] + 0.01f + (0.99f - c.x0[i]) * uniform(generator);
    c.y1[i] = c.y0[i] + 0.01f + (0.99f - c.y0[i]) * uniform(generator);
    c.u[i] = std::min(uniform(generator), 0x1.fffffep-1f);
    c.v[i] = std::min(uniform(generator), 0x1.fffffep-1f);
  }
  for_each_target([&] {
    HWY_DYNAMIC_DISPATCH(sample_window_columns)(&distribution, &c);
    size_t beyond = 0;  // points that rounding puts on the border of the next cell
    for (size_t i = 0; i < c.u.size(); ++i) {
      const WindowSample s = sample_window(distribution, {c.x0[i], c.y0[i], c.x1[i], c.y1[i]}, c.u[i], c.v[i]);
      if (s.pdf == 0) {
        EXPECT_EQ(c.pdf[i], 0);
        EXPECT_EQ(c.again[i], 0);
        continue;
      }
      EXPECT_NEAR(c.x[i], s.x, 2e-6);
      EXPECT_NEAR(c.y[i], s.y, 2e-6);
      EXPECT_NEAR(c.pdf[i] / s.pdf, 1, 1e-5);
      beyond += std::abs(c.again[i] / s.pdf - 1) > 1e-5f;
    }
    EXPECT_LE(beyond, c.u.size() / 500);
  });
}

}  // namespace
}  // namespace metamer
#endif
