// RGB to spectrum and back.
#include "engine/spectrum/rgb_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace metamer {
namespace {

// The colour by an integral of the test's own, not the solver's: CIE 15 sums of sigmoid times D65, coefficients
// rounded to single precision as they are stored.
Color3 srgb_of(const SigmoidCoefficients& c) {
  const Samples& white = white_illuminant(ColorSpace::srgb);
  const double y = integrate_xyz(white)[1];
  Samples reflected;
  for (size_t i = 0; i < lambda_count; ++i) {
    const SigmoidCoefficients stored = {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
    reflected[i] = white[i] / y * sigmoid_polynomial(stored, lambda_min_nm + static_cast<double>(i));
  }
  return multiply(xyz_to_rgb(ColorSpace::srgb), integrate_xyz(reflected));
}

double round_trip_error(const Color3& rgb) {
  const Color3 back = srgb_of(fit_sigmoid(ColorSpace::srgb, rgb).c);
  double error = 0.0;
  for (size_t c = 0; c < 3; ++c) error = std::max(error, std::abs(back[c] - rgb[c]));
  return error;
}

TEST(RgbFit, SrgbReturnsToItselfOnADenseGridWithCornersAndEdges) {
  const double levels[] = {0.0, 1e-6, 1e-4, 1e-3, 0.01, 0.05, 0.2, 0.5, 0.8, 0.95, 0.99, 0.999, 0.9999, 1.0};
  for (const double r : levels) {
    for (const double g : levels) {
      for (const double b : levels) EXPECT_LT(round_trip_error({r, g, b}), 1e-6) << r << " " << g << " " << b;
    }
  }
}

TEST(RgbFit, SrgbReturnsToItselfAtRandomColours) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    const Color3 rgb = {uniform(random), uniform(random), uniform(random)};
    EXPECT_LT(round_trip_error(rgb), 1e-6) << rgb[0] << " " << rgb[1] << " " << rgb[2];
  }
}

TEST(RgbFit, GreysAreFlat) {
  for (const double grey : {1e-4, 0.18, 0.5, 0.999}) {
    const SigmoidFit fit = fit_sigmoid(ColorSpace::srgb, {grey, grey, grey});
    EXPECT_EQ(fit.c[0], 0.0);
    EXPECT_EQ(fit.c[1], 0.0);
    EXPECT_NEAR(sigmoid_polynomial(fit.c, 500.0), grey, 1e-14);
  }
  EXPECT_EQ(sigmoid_polynomial(fit_sigmoid(ColorSpace::srgb, {0.0, 0.0, 0.0}).c, 500.0), 0.0);
  EXPECT_EQ(sigmoid_polynomial(fit_sigmoid(ColorSpace::srgb, {1.0, 1.0, 1.0}).c, 500.0), 1.0);
}

// S(-x) = 1 - S(x), and white is 1: the spectra of complementary colours are complementary where the fit is unique.
TEST(RgbFit, ComplementaryColoursHaveComplementarySpectra) {
  const Color3 colours[] = {{0.63, 0.065, 0.05}, {0.14, 0.45, 0.091}, {0.2, 0.3, 0.9}};
  for (const Color3& rgb : colours) {
    const auto c = fit_sigmoid(ColorSpace::srgb, rgb).c;
    const auto d = fit_sigmoid(ColorSpace::srgb, {1.0 - rgb[0], 1.0 - rgb[1], 1.0 - rgb[2]}).c;
    for (const double lambda : {400.0, 500.0, 600.0, 700.0}) {
      EXPECT_NEAR(sigmoid_polynomial(c, lambda) + sigmoid_polynomial(d, lambda), 1.0, 1e-5);
    }
  }
}

// Muted colours exist in every space; the white differs, so ACES is fitted under its own.
TEST(RgbFit, OtherSpacesReturnMutedColoursToThemselves) {
  for (size_t i = 0; i < color_space_count; ++i) {
    const auto space = static_cast<ColorSpace>(i);
    for (const Color3& rgb : {Color3{0.6, 0.3, 0.2}, Color3{0.2, 0.5, 0.3}, Color3{0.2, 0.25, 0.5}}) {
      const SigmoidFit fit = fit_sigmoid(space, rgb);
      EXPECT_LT(fit.error, 1e-6) << color_space_name(space);
      const Color3 back = sigmoid_rgb(space, fit.c);
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(back[c], rgb[c], 1e-6);
    }
  }
}

// Rec. 2020's primaries are single wavelengths: no reflectance has their colour at that luminance.
TEST(RgbFit, ImpossibleColoursSaySoAndKeepTheirHue) {
  const SigmoidFit fit = fit_sigmoid(ColorSpace::rec2020, {0.0, 1.0, 0.0});
  EXPECT_GT(fit.error, 1e-3);
  const Color3 back = sigmoid_rgb(ColorSpace::rec2020, fit.c);
  EXPECT_NEAR(std::max(std::abs(back[0]), std::max(std::abs(back[1] - 1.0), std::abs(back[2]))), fit.error, 1e-12);
  EXPECT_GT(back[1], 2.0 * back[0]);
  EXPECT_GT(back[1], 2.0 * back[2]);
}

}  // namespace
}  // namespace metamer
