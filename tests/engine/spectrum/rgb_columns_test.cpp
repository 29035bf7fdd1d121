// Images to spectra: the vectorised solver against the colours asked for.
#include "engine/spectrum/rgb_columns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "engine/simd/column.h"
#include "engine/spectrum/rgb_fit.h"
#include "engine/spectrum/rgb_quadrature.h"
#include "engine/spectrum/rgb_start_table.h"
#include "tests/support/each_target.h"

namespace metamer {
namespace {

struct Image {
  Column<float> channel[3];
  Column<float> c[3];
  size_t count = 0;

  void append(double r, double g, double b) {
    channel[0].push_back(static_cast<float>(r));
    channel[1].push_back(static_cast<float>(g));
    channel[2].push_back(static_cast<float>(b));
    ++count;
  }
  void convert(ColorSpace space = ColorSpace::srgb) {
    for (auto& column : c) column.resize(count);
    rgb_to_sigmoid(space, {channel[0].data(), channel[1].data(), channel[2].data()},
                   {c[0].data(), c[1].data(), c[2].data()}, count);
  }
  Color3 rgb(size_t i) const { return {channel[0][i], channel[1][i], channel[2][i]}; }
  SigmoidCoefficients coefficients(size_t i) const { return {c[0][i], c[1][i], c[2][i]}; }
};

// The error as a share of the bound stated in rgb_columns.h.
double share_of_bound(const Image& image, size_t i, ColorSpace space = ColorSpace::srgb) {
  const Color3 wanted = image.rgb(i);
  const Color3 back = sigmoid_rgb(space, image.coefficients(i));
  const auto [low, high] = std::minmax({wanted[0], wanted[1], wanted[2]});
  const double bound = 5e-4 * std::min(high, 1.0 - low) + 5e-5;
  double share = 0.0;
  for (size_t k = 0; k < 3; ++k) share = std::max(share, std::abs(back[k] - wanted[k]) / bound);
  return share;
}

Image dense_grid() {
  Image image;
  const double levels[] = {0.0, 1e-6, 1e-4, 1e-3, 0.01, 0.05,  0.2,    0.35,
                           0.5, 0.65, 0.8,  0.95, 0.99, 0.999, 0.9999, 1.0};
  for (const double r : levels) {
    for (const double g : levels) {
      for (const double b : levels) image.append(r, g, b);
    }
  }
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 4000; ++i) image.append(uniform(random), uniform(random), uniform(random));
  for (int i = 0; i < 4000; ++i) {  // the most saturated: faces of the cube
    Color3 rgb = {uniform(random), uniform(random), uniform(random)};
    rgb[i % 3] = i % 2;
    image.append(rgb[0], rgb[1], rgb[2]);
  }
  return image;
}

TEST(RgbColumns, SrgbReturnsToItselfWithinTheStatedError) {
  Image image = dense_grid();
  for_each_target([&] {
    image.convert();
    double worst = 0.0;
    for (size_t i = 0; i < image.count; ++i) {
      const double share = share_of_bound(image, i);
      worst = std::max(worst, share);
      ASSERT_LT(share, 1.0) << image.rgb(i)[0] << " " << image.rgb(i)[1] << " " << image.rgb(i)[2];
    }
    RecordProperty("worst_share_of_bound", std::to_string(worst));
  });
}

TEST(RgbColumns, GreysAreFlatAndBlackAndWhiteExact) {
  Image image;
  for (const double grey : {0.0, 1e-4, 0.18, 0.5, 0.9, 1.0}) image.append(grey, grey, grey);
  for_each_target([&] {
    image.convert();
    for (size_t i = 0; i < image.count; ++i) {
      EXPECT_EQ(image.c[0][i], 0.0f);
      EXPECT_EQ(image.c[1][i], 0.0f);
      EXPECT_NEAR(sigmoid_polynomial(image.coefficients(i), 500.0), image.channel[0][i], 1e-7);
    }
    EXPECT_EQ(sigmoid_polynomial(image.coefficients(0), 500.0), 0.0);
    EXPECT_EQ(sigmoid_polynomial(image.coefficients(5), 500.0), 1.0);
  });
}

TEST(RgbColumns, OutOfRangeAndNanAreClamped) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Image bad;
  bad.append(2.0, -1.0, nan);
  bad.append(0.3, 0.2, 1e30);
  Image good;
  good.append(1.0, 0.0, 0.0);
  good.append(0.3, 0.2, 1.0);
  for_each_target([&] {
    bad.convert();
    good.convert();
    for (size_t i = 0; i < 2; ++i) EXPECT_EQ(bad.coefficients(i), good.coefficients(i));
  });
}

TEST(RgbColumns, RowsDoNotDependOnTheirNeighbours) {
  Image image = dense_grid();
  for_each_target([&] {
    image.convert();
    for (size_t i = 0; i < image.count; i += 101) {
      Image alone;
      alone.append(image.rgb(i)[0], image.rgb(i)[1], image.rgb(i)[2]);
      alone.convert();
      ASSERT_EQ(alone.coefficients(0), image.coefficients(i)) << i;
    }
  });
}

TEST(RgbColumns, WiderSpacesReturnMutedColoursAndStayFiniteForTheRest) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (size_t s = 1; s < color_space_count; ++s) {
    const auto space = static_cast<ColorSpace>(s);
    Image muted;
    Image any;
    for (int i = 0; i < 512; ++i) {
      const Color3 rgb = {uniform(random), uniform(random), uniform(random)};
      any.append(rgb[0], rgb[1], rgb[2]);
      const double grey = 0.5;
      muted.append(grey + 0.4 * (rgb[0] - grey), grey + 0.4 * (rgb[1] - grey), grey + 0.4 * (rgb[2] - grey));
    }
    muted.convert(space);
    any.convert(space);
    for (size_t i = 0; i < muted.count; ++i) {
      EXPECT_LT(share_of_bound(muted, i, space), 1.0) << color_space_name(space);
      for (const double c : any.coefficients(i)) EXPECT_LE(std::abs(c), largest_sigmoid_coefficient);
    }
  }
}

TEST(RgbQuadrature, ReducedSumsAgreeWithFullOnes) {
  for (const Color3& rgb : {Color3{1.0, 0.0, 0.0}, Color3{0.0, 1.0, 0.0}, Color3{0.0, 0.0, 1.0}, Color3{0.0, 1.0, 1.0},
                            Color3{0.0, 0.14, 1.0}, Color3{0.2, 0.3, 0.1}}) {
    const SigmoidCoefficients c = fit_sigmoid(ColorSpace::srgb, rgb).c;
    Color3 reduced{};
    for (const auto& [t, weight] : reduced_quadrature(ColorSpace::srgb)) {
      const double value = sigmoid((c[0] * t + c[1]) * t + c[2]);
      for (size_t k = 0; k < 3; ++k) reduced[k] += weight[k] * value;
    }
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(reduced[k], rgb[k], 3e-5);
  }
}

TEST(RgbStartTable, HslMapCoversTheCube) {
  EXPECT_EQ(rgb_of_hsl(0.0, 1.0, 0.5), (Color3{1.0, 0.0, 0.0}));
  EXPECT_EQ(rgb_of_hsl(2.0, 1.0, 0.5), (Color3{0.0, 1.0, 0.0}));
  EXPECT_EQ(rgb_of_hsl(3.0, 1.0, 0.5), (Color3{0.0, 1.0, 1.0}));
  EXPECT_EQ(rgb_of_hsl(4.0, 1.0, 0.5), (Color3{0.0, 0.0, 1.0}));
  EXPECT_EQ(rgb_of_hsl(5.5, 1.0, 0.5), (Color3{1.0, 0.0, 0.5}));
  EXPECT_EQ(rgb_of_hsl(1.5, 0.0, 0.25), (Color3{0.25, 0.25, 0.25}));
}

}  // namespace
}  // namespace metamer
