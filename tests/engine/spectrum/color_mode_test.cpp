#include "engine/spectrum/color_mode.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/spectrum/named_spectra.h"
#include "engine/spectrum/spectrum_set.h"

namespace metamer {
namespace {

constexpr ColorMode both[] = {ColorMode::rgb, ColorMode::lamps};

void expect_near(const Color3& color, const Color3& expected, double tolerance) {
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(color[c], expected[c], tolerance) << "channel " << c;
}

Samples flat(double value) {
  Samples samples;
  samples.fill(value);
  return samples;
}

TEST(ColorMode, ItsNamesAreThoseOfTheFlag) {
  for (size_t i = 0; i < color_mode_names().size(); ++i)
    EXPECT_EQ(find_color_mode(color_mode_names()[i]), static_cast<ColorMode>(i));
  EXPECT_EQ(color_mode_name(ColorMode::lamps), "lamps");
  EXPECT_EQ(find_color_mode("RGB"), std::nullopt);
}

TEST(ColorMode, IndicesAreTakenAtTheWavelengthsOfDesign) {
  const double expected[2][3] = {{611, 549, 464}, {645.16, 526.32, 444.44}};
  for (size_t m = 0; m < 2; ++m)
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(coefficient_space(both[m]).lambda_nm[c], expected[m][c], 0.005);
  // Gold's n by Johnson and Christy: 0.29 at 582.1 nm, 0.21 at 616.8 nm, 0.14 at 659.5 nm.
  const Samples n = *named_spectrum("Au.n");
  EXPECT_NEAR(index_coefficients(ColorMode::rgb, n)[0], 0.21 + 0.08 * (616.8 - 611) / (616.8 - 582.1), 2e-4);
  EXPECT_NEAR(index_coefficients(ColorMode::lamps, n)[0], 0.14 + 0.07 * (659.5 - 645.16) / (659.5 - 616.8), 2e-4);
}

TEST(ColorMode, KernelsTellTheChannelsApartByTheirBounds) {
  for (const ColorMode mode : both) {
    const auto& lambda_nm = coefficient_space(mode).lambda_nm;
    EXPECT_GT(lambda_nm[0], red_above_nm);
    EXPECT_LT(lambda_nm[1], red_above_nm);
    EXPECT_GT(lambda_nm[1], blue_below_nm);
    EXPECT_LT(lambda_nm[2], blue_below_nm);
  }
}

TEST(ColorMode, WhiteIsOneInEveryChannel) {
  for (const ColorMode mode : both) {
    expect_near(factor_coefficients(mode, flat(1)), {1, 1, 1}, 1e-12);
    expect_near(albedo_coefficients(mode, flat(0.25)), {0.25, 0.25, 0.25}, 1e-12);
    // White light of 1 cd/m^2 is 1: D65 scaled so that 683 integral L ybar is 1.
    Samples white = white_illuminant(ColorSpace::srgb);
    const double luminance = luminous_efficacy * integrate_xyz(white)[1];
    for (double& value : white) value /= luminance;
    expect_near(light_coefficients(mode, white), {1, 1, 1}, 1e-12);
    for (const ColorSpace space : {ColorSpace::srgb, ColorSpace::rec2020, ColorSpace::aces2065_1})
      expect_near(multiply(image_to_coefficients(mode, space), Color3{1, 1, 1}), {1, 1, 1}, 1e-10);
  }
}

// Sums over 1 nm by a script in numpy, from the tables of engine/spectrum/data, beyond 780 nm as sources.h says. Cyan
// is outside of sRGB.
TEST(ColorMode, PatchesHaveTheCoefficientsComputedElsewhere) {
  struct Patch {
    const char* name;
    Color3 rgb, lamps;
  };
  const Patch patches[] = {
      {"colorchecker.red", {0.446285, 0.028586, 0.042049}, {0.292046, 0.063076, 0.047040}},
      {"colorchecker.cyan", {0, 0.248842, 0.385334}, {0.067677, 0.237795, 0.368763}},
      {"colorchecker.green", {0.060413, 0.305306, 0.060752}, {0.156170, 0.265188, 0.079287}},
      {"colorchecker.dark_skin", {0.176185, 0.078224, 0.050344}, {0.140711, 0.083704, 0.054329}},
  };
  for (const Patch& patch : patches) {
    SCOPED_TRACE(patch.name);
    const Samples spectrum = *named_spectrum(patch.name);
    expect_near(albedo_coefficients(ColorMode::rgb, spectrum), patch.rgb, 2e-6);
    expect_near(albedo_coefficients(ColorMode::lamps, spectrum), patch.lamps, 2e-6);
  }
  const Color3 lamp = light_coefficients(ColorMode::rgb, *named_spectrum("A"));
  expect_near({lamp[0] / 13596882.87, lamp[1] / 6087637.03, lamp[2] / 1719822.64}, {1, 1, 1}, 1e-6);
  const Color3 by_lamps = light_coefficients(ColorMode::lamps, *named_spectrum("A"));
  expect_near({by_lamps[0] / 10927814.45, by_lamps[1] / 6320103.37, by_lamps[2] / 2227566.83}, {1, 1, 1}, 1e-6);
}

// The lamps: a monochromatic light at one of them is that lamp alone; a matrix of known entries.
TEST(ColorMode, TheLampsArePrimaries) {
  const CoefficientSpace& space = coefficient_space(ColorMode::lamps);
  for (size_t c = 0; c < 3; ++c) {
    const Color3 xyz = observer_value(Observer::cie1931, space.lambda_nm[c]);
    const Color3 amounts = multiply(space.from_xyz, xyz);
    for (size_t other = 0; other < 3; ++other) EXPECT_NEAR(amounts[other] / amounts[c], other == c ? 1 : 0, 1e-12);
    EXPECT_GT(amounts[c], 0);
  }
  const double expected[3][3] = {
      {0.6341346, 0.1126162, 0.2037199}, {0.2427720, 0.7402903, 0.0169377}, {0.0000171, 0.0481960, 1.0406153}};
  for (size_t r = 0; r < 3; ++r)
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(space.to_xyz[r][c], expected[r][c], 1e-6);
}

TEST(ColorMode, LightsKeepWhatIsOutsideTheGamutAndReflectancesDoNot) {
  Samples line = flat(0);
  line[500 - lambda_min_nm] = 1;
  EXPECT_LT(light_coefficients(ColorMode::rgb, line)[0], 0);
  EXPECT_LT(light_coefficients(ColorMode::lamps, line)[0], 0);
  Samples band = flat(0);
  for (int nm = 480; nm <= 520; ++nm) band[static_cast<size_t>(nm - lambda_min_nm)] = 1;
  EXPECT_EQ(albedo_coefficients(ColorMode::rgb, band)[0], 0);
  EXPECT_GT(albedo_coefficients(ColorMode::rgb, band)[1], 0);
  Samples minus_green = flat(1);
  for (int nm = 480; nm <= 520; ++nm) minus_green[static_cast<size_t>(nm - lambda_min_nm)] = 0;
  EXPECT_EQ(albedo_coefficients(ColorMode::rgb, minus_green)[0], 1);
  EXPECT_GT(factor_coefficients(ColorMode::rgb, minus_green)[0], 1);
}

TEST(ColorMode, ReflectancesGivenAsRgbComeBack) {
  for (const Color3& rgb :
       {Color3{0.63, 0.065, 0.05}, {0.14, 0.45, 0.091}, {0.725, 0.71, 0.68}, {0, 0, 1}, {1, 1, 0}}) {
    SpectrumSet set;
    const Samples spectrum = set.samples(set.add_rgb(rgb, RgbKind::albedo).id);
    expect_near(albedo_coefficients(ColorMode::rgb, spectrum), rgb, 5e-5);
  }
}

TEST(ColorMode, OneSpectrumCanHaveCoefficientsOfSeveralRoles) {
  SpectrumSet set;
  const SpectrumId id = *set.add_named("Au.n");
  EXPECT_FALSE(set.view().has_coefficients);
  EXPECT_TRUE(std::isinf(set.row(id).coefficients[0]));
  const SpectrumId first = set.with_coefficients(id, {1, 2, 3}), second = set.with_coefficients(id, {4, 5, 6});
  EXPECT_NE(first, second);
  EXPECT_EQ(set.with_coefficients(id, {1, 2, 3}), first);
  EXPECT_EQ(set.row(second).coefficients, (std::array<float, 3>{4, 5, 6}));
  EXPECT_TRUE(set.view().has_coefficients);
  EXPECT_EQ(set.value(first, 550), set.value(id, 550));
  EXPECT_TRUE(std::isinf(set.row(set.scaled(first, 2).id).coefficients[0]));
  EXPECT_EQ(set.row(set.with_coefficients(zero_spectrum, {0, 0, 0})).coefficients[1], 0);
}

}  // namespace
}  // namespace metamer
