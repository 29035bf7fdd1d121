// Colours of lights and the matrices of RGB spaces against published figures.
#include "engine/spectrum/color.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/spectrum/sources.h"

namespace metamer {
namespace {

struct Published {
  const char* name;
  double x, y, tolerance;
};

// Sums over 5 nm from 380 to 780 nm, as CIE computed what it published.
std::array<double, 2> chromaticity_over_5nm(const Samples& spectrum) {
  Color3 xyz{};
  for (double lambda = 380.0; lambda <= 780.0; lambda += 5.0) {
    const auto matching = observer_value(Observer::cie1931, lambda);
    for (size_t c = 0; c < 3; ++c) xyz[c] += interpolate(spectrum, lambda) * matching[c];
  }
  return chromaticity(xyz);
}

// CIE 15:2004 tables T.3 and T.8 (2 degree observer); CIE 15:2018 for the lamps HP1 and LED. Tolerances are the
// rounding of what is printed. Our 1 nm sums see the line spectra of lamps, which CIE gives in 5 nm bands, smoothed
// between the bands, hence 3e-4.
TEST(Color, IlluminantsHaveThePublishedChromaticities) {
  const Published all[] = {
      {"A", 0.44758, 0.40745, 1.1e-5},    {"D65", 0.31272, 0.32903, 1.1e-5}, {"D50", 0.34567, 0.35850, 1.1e-5},
      {"E", 0.33333, 0.33333, 1.1e-5},    {"FL1", 0.3131, 0.3371, 6e-5},     {"FL2", 0.3721, 0.3751, 6e-5},
      {"FL7", 0.3129, 0.3292, 6e-5},      {"FL11", 0.3805, 0.3769, 6e-5},    {"FL12", 0.4370, 0.4042, 6e-5},
      {"HP1", 0.533, 0.415, 6e-5},        {"LED-B1", 0.4560, 0.4078, 6e-5},  {"LED-B5", 0.3118, 0.3236, 6e-5},
      {"LED-RGB1", 0.4557, 0.4211, 6e-5},
  };
  for (const Published& published : all) {
    SCOPED_TRACE(published.name);
    const Samples spectrum = *cie_illuminant(published.name);
    const auto [x5, y5] = chromaticity_over_5nm(spectrum);
    EXPECT_NEAR(x5, published.x, published.tolerance);
    EXPECT_NEAR(y5, published.y, published.tolerance);
    const auto [x, y] = chromaticity(integrate_xyz(spectrum));
    EXPECT_NEAR(x, published.x, 3e-4);
    EXPECT_NEAR(y, published.y, 3e-4);
  }
}

// CIE 15:2004 table T.3: XYZ of D65 and A, normalised to Y = 100.
TEST(Color, WhitePointsHaveThePublishedTristimulusValues) {
  const Color3& d65 = white_xyz(ColorSpace::srgb);
  EXPECT_NEAR(100.0 * d65[0], 95.04, 0.01);
  EXPECT_NEAR(100.0 * d65[2], 108.88, 0.01);
  const Color3 a = integrate_xyz(*cie_illuminant("A"));
  EXPECT_NEAR(100.0 * a[0] / a[1], 109.85, 0.01);
  EXPECT_NEAR(100.0 * a[2] / a[1], 35.58, 0.015);
}

// IEC 61966-2-1 rounds the white point to (0.3127, 0.3290) and the matrices to four digits: 5e-4.
TEST(Color, SrgbMatrixIsThatOfIec61966WithinItsRounding) {
  const Matrix3 to_xyz = {{{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}};
  const Matrix3 to_rgb = {{{3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}}};
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(rgb_to_xyz(ColorSpace::srgb)[r][c], to_xyz[r][c], 3e-4);
      EXPECT_NEAR(xyz_to_rgb(ColorSpace::srgb)[r][c], to_rgb[r][c], 2e-3);
    }
  }
}

// ITU-R BT.2020-2: Y = 0.2627 R + 0.6780 G + 0.0593 B. SMPTE ST 2065-1: Y = 0.3440 R + 0.7282 G - 0.0721 B.
TEST(Color, WideSpacesHaveThePublishedLuminanceRow) {
  const Color3 rec2020 = {0.2627, 0.6780, 0.0593};
  const Color3 aces = {0.3439664498, 0.7281660966, -0.0721325464};
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(rgb_to_xyz(ColorSpace::rec2020)[1][c], rec2020[c], 2e-4);
    EXPECT_NEAR(rgb_to_xyz(ColorSpace::aces2065_1)[1][c], aces[c], 1e-3);
  }
}

TEST(Color, WhiteIsExactlyNeutralInEverySpace) {
  for (size_t i = 0; i < color_space_count; ++i) {
    const auto space = static_cast<ColorSpace>(i);
    const Color3 rgb = multiply(xyz_to_rgb(space), white_xyz(space));
    for (const double channel : rgb) EXPECT_NEAR(channel, 1.0, 1e-14) << color_space_name(space);
  }
}

TEST(Color, AcesWhiteIsNearThePublishedOne) {
  const auto [x, y] = chromaticity(white_xyz(ColorSpace::aces2065_1));
  EXPECT_NEAR(x, 0.32168, 2e-4);
  EXPECT_NEAR(y, 0.33767, 2e-4);
}

// Lindbloom's published Bradford matrix from D50 to D65 (ASTM whites).
TEST(Color, BradfordMapsD50ToD65AsPublished) {
  const Matrix3 published = {
      {{0.9555766, -0.0230393, 0.0631636}, {-0.0282895, 1.0099416, 0.0210077}, {0.0122982, -0.0204830, 1.3299098}}};
  const Matrix3 ours = adaptation_matrix(Adaptation::bradford, {0.96422, 1.0, 0.82521}, {0.95047, 1.0, 1.08883});
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(ours[r][c], published[r][c], 1e-6);
  }
}

TEST(Color, AdaptationTakesWhiteToWhiteAndBack) {
  const Color3 from = white_xyz(ColorSpace::aces2065_1);
  const Color3 to = white_xyz(ColorSpace::srgb);
  for (const Adaptation method : {Adaptation::bradford, Adaptation::cat16}) {
    const Color3 mapped = multiply(adaptation_matrix(method, from, to), from);
    const Matrix3 round = multiply(adaptation_matrix(method, to, from), adaptation_matrix(method, from, to));
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(mapped[c], to[c], 1e-14);
      for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(round[c][k], c == k ? 1.0 : 0.0, 1e-13);
    }
  }
}

// The rows of CAT16's cone matrix sum to 1, so equal-energy white excites all three alike (Li et al. 2017, eq. 10):
// adapting from E scales by the cone response of the target, whose diagonal mean is checked for D65.
TEST(Color, Cat16FromEqualEnergyMeetsTheConeResponsesOfD65) {
  const Color3 d65 = {0.95047, 1.0, 1.08883};
  const Color3 red_cone = {0.401288, 0.650173, -0.051461};
  const Matrix3 m = adaptation_matrix(Adaptation::cat16, {1.0, 1.0, 1.0}, d65);
  const double response = red_cone[0] * d65[0] + red_cone[1] * d65[1] + red_cone[2] * d65[2];
  for (size_t c = 0; c < 3; ++c) {
    const double row = red_cone[0] * m[0][c] + red_cone[1] * m[1][c] + red_cone[2] * m[2][c];
    EXPECT_NEAR(row, response * red_cone[c], 1e-13);
  }
}

// Wien's displacement law and the Stefan-Boltzmann law (CODATA 2018).
TEST(Planck, PeaksWhereWienSaysAndIntegratesToStefanBoltzmann) {
  const double kelvin = 5000.0;
  const double peak_nm = 2.897771955e6 / kelvin;
  EXPECT_GT(planck_radiance(kelvin, peak_nm), planck_radiance(kelvin, peak_nm * 1.001));
  EXPECT_GT(planck_radiance(kelvin, peak_nm), planck_radiance(kelvin, peak_nm * 0.999));
  double radiance = 0.0;
  for (double lambda = 50.5; lambda < 400000.0; lambda += 1.0) radiance += planck_radiance(kelvin, lambda);
  const double expected = 5.670374419e-8 * kelvin * kelvin * kelvin * kelvin / M_PI;
  EXPECT_NEAR(radiance / expected, 1.0, 1e-5);
}

// CIE 15:2004, 4.1.1: A is Planck's law at 2848 K with c2 = 1.435e-2 m K, that is at 2855.5 K with today's constants.
TEST(Planck, IlluminantAIsABlackbodyOf2855Kelvin) {
  const Samples a = *cie_illuminant("A");
  const double kelvin = 2848.0 * 1.438776877e-2 / 1.435e-2;
  for (double lambda = 360.0; lambda <= 830.0; lambda += 5.0) {
    const double expected = 100.0 * planck_radiance(kelvin, lambda) / planck_radiance(kelvin, 560.0);
    EXPECT_NEAR(interpolate(a, lambda) / expected, 1.0, 5e-6) << lambda;
  }
}

TEST(Planck, RayleighJeansHoldsAtExtremeTemperatures) {
  // 2 c k T / lambda^4 per metre; its relative error is half of h c / (lambda k T).
  const double kelvin = 1e9;
  const double lambda = 500e-9;
  const double expected = 2.0 * 299792458.0 * 1.380649e-23 * kelvin / (lambda * lambda * lambda * lambda) * 1e-9;
  EXPECT_NEAR(planck_radiance(kelvin, 500.0) / expected, 1.0, 2e-5);
}

// CIE 15:2004, 4.1.2: D65 and D50 are the daylight components at 6504 and 5003 K; the tables round to 4 or 5 digits.
TEST(Daylight, ComponentsReproduceTheTablesOfD65AndD50) {
  for (const auto& [name, nominal] : {std::pair{"D65", 6500.0}, std::pair{"D50", 5000.0}}) {
    const Samples table = *cie_illuminant(name);
    const Samples components = daylight(nominal * daylight_shift);
    for (size_t i = 0; i < lambda_count; ++i) EXPECT_NEAR(components[i], table[i], 0.02) << name << " " << i + 360;
    EXPECT_NEAR(interpolate(components, 560.0), 100.0, 1e-9);
  }
}

// Wyszecki & Stiles 1982, table 1(3.3.4) gives D55 (0.3324, 0.3474) and D75 (0.2990, 0.3149).
TEST(Daylight, HasThePublishedChromaticities) {
  const Published all[] = {{"D55", 0.3324, 0.3474, 1e-4}, {"D75", 0.2990, 0.3149, 1e-4}};
  const double nominal[] = {5500.0, 7500.0};
  for (size_t i = 0; i < 2; ++i) {
    const auto [x, y] = chromaticity(integrate_xyz(daylight(nominal[i] * daylight_shift)));
    EXPECT_NEAR(x, all[i].x, all[i].tolerance);
    EXPECT_NEAR(y, all[i].y, all[i].tolerance);
  }
}

TEST(Daylight, IsContinuousAcross7000Kelvin) {
  const auto below = daylight_chromaticity(7000.0);
  const auto above = daylight_chromaticity(7000.001);
  EXPECT_NEAR(below[0], above[0], 1e-4);
  EXPECT_NEAR(below[1], above[1], 1e-4);
}

}  // namespace
}  // namespace metamer
