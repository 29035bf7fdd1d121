// The store of spectra: what goes in comes out.
#include "engine/spectrum/spectrum_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "engine/diagnostics.h"
#include "engine/spectrum/named_spectra.h"
#include "engine/spectrum/sources.h"

namespace metamer {
namespace {

TEST(SpectrumSet, BeginsWithZeroAndOne) {
  const SpectrumSet set;
  EXPECT_EQ(set.size(), 2u);
  EXPECT_EQ(set.value(zero_spectrum, 500.0), 0.0);
  EXPECT_EQ(set.value(unit_spectrum, 500.0), 1.0);
}

TEST(SpectrumSet, ConstantsAreExactAndEqualOnesAreOne) {
  SpectrumSet set;
  const SpectrumId half = set.add_constant(0.5).id;
  EXPECT_EQ(set.value(half, 613.7), 0.5);
  EXPECT_TRUE(set.is_constant(half));
  EXPECT_EQ(set.add_constant(0.5).id, half);
  EXPECT_EQ(set.add_constant(0.0).id, zero_spectrum);
  EXPECT_EQ(set.add_constant(1.0).id, unit_spectrum);
  EXPECT_EQ(set.size(), 3u);
}

TEST(SpectrumSet, CoarseTablesArePiecewiseLinear) {
  SpectrumSet set;
  const std::vector<double> lambda = {400.0, 500.0, 600.0};
  const std::vector<double> values = {0.25, 0.5, 0.125};
  const SpectrumId zero = set.add_table(lambda, values, Extend::zero).id;
  const SpectrumId held = set.add_table(lambda, values, Extend::constant).id;
  EXPECT_NEAR(set.value(zero, 450.0), 0.375, 1e-7);
  EXPECT_NEAR(set.value(zero, 500.0), 0.5, 1e-7);
  EXPECT_NEAR(set.value(zero, 550.5), 0.310625, 1e-7);
  EXPECT_EQ(set.value(zero, 399.0), 0.0);
  EXPECT_EQ(set.value(zero, 601.0), 0.0);
  EXPECT_NEAR(set.value(held, 380.0), 0.25, 1e-7);
  EXPECT_NEAR(set.value(held, 830.0), 0.125, 1e-7);
}

// A line 0.02 nm wide, between and on the nodes of the 1 nm grid.
TEST(SpectrumSet, NarrowLinesKeepTheirIntegral) {
  for (const double center : {546.074, 500.0, 611.5}) {
    SpectrumSet set;
    const std::vector<double> lambda = {400.0, center - 0.01, center, center + 0.01, 700.0};
    const std::vector<double> values = {0.0, 0.0, 100.0, 0.0, 0.0};
    const SpectrumId line = set.add_table(lambda, values, Extend::zero).id;
    double integral = 0.0;
    for (double nm = 360.0; nm <= 830.0; nm += 1.0) integral += set.value(line, nm);
    EXPECT_NEAR(integral, 1.0, 1e-6) << center;
  }
}

TEST(SpectrumSet, FinelyTabulatedCurvesAreAveraged) {
  SpectrumSet set;
  std::vector<double> lambda;
  std::vector<double> values;
  double input_integral = 0.0;
  for (int i = 0; i <= 4000; ++i) {
    lambda.push_back(400.0 + 0.05 * i);
    values.push_back(i % 40 < 10 ? 1.0 : 0.0);
    if (i > 0) input_integral += 0.05 * 0.5 * (values[i] + values[i - 1]);
  }
  const SpectrumId id = set.add_table(lambda, values, Extend::zero).id;
  double integral = 0.0;
  for (const double value : set.samples(id)) integral += value;
  EXPECT_NEAR(integral, input_integral, 1e-4);
  EXPECT_LE(set.max_value(id), 1.0);
}

TEST(SpectrumSet, ScalingSharesTheTable) {
  SpectrumSet set;
  const SpectrumId d65 = *set.add_named("D65");
  const size_t tables = set.table_count();
  const SpectrumId twice = set.scaled(d65, 2.0).id;
  EXPECT_EQ(set.table_count(), tables);
  EXPECT_EQ(set.value(twice, 560.0), 2.0 * set.value(d65, 560.0));
  EXPECT_EQ(set.scaled(twice, 0.5).id, d65);
  EXPECT_EQ(set.scaled(d65, 0.0).id, zero_spectrum);
  EXPECT_FALSE(set.scaled(d65, 1e300).ok());
  EXPECT_EQ(*set.add_named("stdillum-D65"), d65);
  EXPECT_EQ(set.table_count(), tables);
}

TEST(SpectrumSet, ProductsMultiply) {
  SpectrumSet set;
  const SpectrumId d65 = *set.add_named("D65");
  const SpectrumId red = set.add_rgb({0.6, 0.1, 0.1}, RgbKind::albedo).id;
  const SpectrumId half = set.add_constant(0.5).id;
  const SpectrumId lit = set.product(d65, red).id;
  for (const double nm : {400.0, 551.0, 700.0}) {
    EXPECT_NEAR(set.value(lit, nm), set.value(d65, nm) * set.value(red, nm), 1e-5);
  }
  EXPECT_EQ(set.product(half, d65).id, set.scaled(d65, 0.5).id);
  EXPECT_EQ(set.product(d65, half).id, set.scaled(d65, 0.5).id);
}

TEST(SpectrumSet, SurvivesCopiesAndMoves) {
  SpectrumSet set;
  const SpectrumId d65 = *set.add_named("D65");
  SpectrumSet copy = set;
  const SpectrumId more = copy.add_constant(3.0).id;
  EXPECT_EQ(copy.value(d65, 500.0), set.value(d65, 500.0));
  EXPECT_EQ(set.size(), more);
  const SpectrumSet moved = std::move(copy);
  EXPECT_EQ(moved.value(more, 500.0), 3.0);
}

TEST(SpectrumSet, RefusesBadInputWithAReason) {
  SpectrumSet set;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> up = {400.0, 500.0};
  const std::vector<double> down = {500.0, 400.0};
  const std::vector<double> same = {500.0, 500.0};
  const std::vector<double> fine = {1.0, 2.0};
  const std::vector<double> bad = {1.0, nan};
  EXPECT_FALSE(set.add_constant(nan).ok());
  EXPECT_FALSE(set.add_constant(1e39).ok());
  EXPECT_FALSE(set.add_table(up, bad, Extend::zero).ok());
  EXPECT_FALSE(set.add_table(bad, fine, Extend::zero).ok());
  EXPECT_FALSE(set.add_table(down, fine, Extend::zero).ok());
  EXPECT_FALSE(set.add_table(same, fine, Extend::zero).ok());
  EXPECT_FALSE(set.add_table(up, std::vector<double>{1.0}, Extend::zero).ok());
  EXPECT_FALSE(set.add_table({}, {}, Extend::zero).ok());
  EXPECT_FALSE(set.add_rgb({0.5, 1.1, 0.5}, RgbKind::albedo).ok());
  EXPECT_FALSE(set.add_rgb({0.5, -0.1, 0.5}, RgbKind::unbounded).ok());
  EXPECT_FALSE(set.add_rgb({0.5, nan, 0.5}, RgbKind::illuminant).ok());
  EXPECT_FALSE(set.add_blackbody(0.0).ok());
  EXPECT_FALSE(set.add_blackbody(nan).ok());
  EXPECT_FALSE(set.add_daylight(3000.0).ok());
  EXPECT_FALSE(set.add_named("D66"));
  EXPECT_EQ(set.size(), 2u);
}

TEST(SpectrumSet, NegativeValuesAreKeptAndCanBeAskedFor) {
  SpectrumSet set;
  const SpectrumId id =
      set.add_table(std::vector<double>{400.0, 500.0}, std::vector<double>{-1.0, 1.0}, Extend::constant).id;
  EXPECT_TRUE(set.has_negative(id));
  EXPECT_NEAR(set.min_value(id), -1.0, 1e-7);
  EXPECT_FALSE(set.has_negative(unit_spectrum));
}

TEST(SpectrumSet, RgbGreysAreFlatAndExactToTheFloat) {
  SpectrumSet set;
  for (const double grey : {1e-6, 1e-4, 0.18, 0.725, 1.0}) {
    const SpectrumId id = set.add_rgb({grey, grey, grey}, RgbKind::albedo).id;
    EXPECT_TRUE(set.is_constant(id));
    EXPECT_EQ(set.value(id, 456.0), static_cast<double>(static_cast<float>(grey)));
  }
  EXPECT_EQ(set.add_rgb({0.0, 0.0, 0.0}, RgbKind::albedo).id, zero_spectrum);
  EXPECT_EQ(set.add_rgb({1.0, 1.0, 1.0}, RgbKind::albedo).id, unit_spectrum);
}

TEST(SpectrumSet, AlbedosStayWithinZeroAndOneAndUnboundedReturnTheirColour) {
  SpectrumSet set;
  const SpectrumId albedo = set.add_rgb({1.0, 0.0, 0.3}, RgbKind::albedo).id;
  EXPECT_GE(set.min_value(albedo), 0.0);
  EXPECT_LE(set.max_value(albedo), 1.0);
  const Color3 copper = {0.200438, 0.924033, 1.102212};
  const Samples reflected = set.samples(set.add_rgb(copper, RgbKind::unbounded).id);
  const Samples& white = white_illuminant(ColorSpace::srgb);
  Samples lit;
  for (size_t i = 0; i < lambda_count; ++i) lit[i] = reflected[i] * white[i] / integrate_xyz(white)[1];
  const Color3 rgb = multiply(xyz_to_rgb(ColorSpace::srgb), integrate_xyz(lit));
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], copper[c], 1e-6);
}

// DESIGN.md, section 1: X = 683 times the integral of L xbar, and EXR R = G = B = 1 is white of 1 cd/m^2. pbrt-v4
// divides an rgb light by 683 times the integral of the white illuminant's Y.
TEST(SpectrumSet, RgbLightsDevelopToTheirRgb) {
  for (size_t i = 0; i < color_space_count; ++i) {
    const auto space = static_cast<ColorSpace>(i);
    SpectrumSet set;
    const double white = set.luminance(set.add_white(space));
    for (const Color3& rgb : {Color3{1.0, 1.0, 1.0}, Color3{17.0, 12.0, 8.0}}) {
      const SpectrumId light = set.scaled(set.add_rgb(rgb, RgbKind::illuminant, space).id, 1.0 / white).id;
      const Color3 developed = multiply(xyz_to_rgb(space), set.xyz(light));
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(developed[c] / rgb[c], 1.0, 1e-5) << color_space_name(space);
    }
  }
}

TEST(SpectrumSet, BlackbodiesAreAbsoluteOrNormalisedToTheirPeak) {
  SpectrumSet set;
  const SpectrumId sun = set.add_blackbody(5772.0).id;
  EXPECT_NEAR(set.value(sun, 500.0) / planck_radiance(5772.0, 500.0), 1.0, 1e-6);
  const SpectrumId unit = set.add_blackbody_normalized(5772.0).id;
  EXPECT_NEAR(set.max_value(unit), 1.0, 1e-5);  // 2.8978e6 / 5772 = 502.04 nm
  EXPECT_EQ(set.add_blackbody(1.0).id, zero_spectrum);
}

// The candela: 683 lm/W at 540 THz, that is 555.17 nm, where ybar is 1 to 1e-4.
TEST(SpectrumSet, OneWattAt555NanometresIs683Lumens) {
  SpectrumSet set;
  const SpectrumId line =
      set.add_table(std::vector<double>{554.0, 555.0, 556.0}, std::vector<double>{0.0, 1.0, 0.0}, Extend::zero).id;
  EXPECT_NEAR(set.luminance(line), 683.0, 0.01);
}

TEST(NamedSpectra, CoverBothVocabulariesAndAllLoad) {
  for (const std::string_view name : {"Au.n",
                                      "Au.k",
                                      "W.n",
                                      "D65",
                                      "E",
                                      "FL11",
                                      "LED-RGB1",
                                      "BK7",
                                      "SF11",
                                      "SF66",
                                      "SF10",
                                      "LAK33",
                                      "FK51",
                                      "fused-silica",
                                      "sapphire",
                                      "diamond",
                                      "water",
                                      "PMMA",
                                      "colorchecker.dark_skin",
                                      "colorchecker.cyan",
                                      "metal-Au-eta",
                                      "metal-Ag-k",
                                      "metal-Cu-eta",
                                      "metal-Al-k",
                                      "glass-BK7",
                                      "glass-SF11",
                                      "stdillum-D65",
                                      "stdillum-A",
                                      "stdillum-F11",
                                      "stdillum-F3",
                                      "stdillum-F10",
                                      "metal-CuZn-eta",
                                      "metal-TiO2-eta",
                                      "metal-MgO-k",
                                      "glass-BAF10",
                                      "glass-LASF9",
                                      "glass-SF5",
                                      "illum-acesD60"}) {
    EXPECT_TRUE(named_spectrum(name)) << name;
  }
  std::set<std::string_view> unique;
  for (const std::string_view name : spectrum_names()) {
    SpectrumSet set;
    EXPECT_TRUE(unique.insert(name).second) << name;
    const auto id = set.add_named(name);
    ASSERT_TRUE(id) << name;
    const bool is_clear = name.ends_with("k") && (name.find("MgO") < name.size() || name.find("TiO2") < name.size());
    EXPECT_EQ(set.max_value(*id) > 0.0, !is_clear) << name;
    EXPECT_GE(set.min_value(*id), 0.0) << name;
  }
  EXPECT_FALSE(named_spectrum("D_series"));
  EXPECT_EQ(nearest_word("stdilum-D65", spectrum_names()), "stdillum-D65");
}

}  // namespace
}  // namespace metamer
