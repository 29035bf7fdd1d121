#include "engine/spectrum/dominant_wavelength.h"

#include <gtest/gtest.h>

namespace metamer {
namespace {

constexpr std::array<double, 2> d65 = {0.3127, 0.3290};

// Primaries of sRGB relative to D65, as D. Pascale gives them, "A Review of RGB Color Spaces", 2003.
TEST(DominantWavelength, OfThePrimariesOfSrgbIsThePublishedOne) {
  EXPECT_NEAR(dominant_wavelength({0.64, 0.33}, d65).lambda_nm, 611.4, 0.2);
  EXPECT_NEAR(dominant_wavelength({0.30, 0.60}, d65).lambda_nm, 549.1, 0.2);
  EXPECT_NEAR(dominant_wavelength({0.15, 0.06}, d65).lambda_nm, 464.2, 0.2);
}

// The examples of colour-science.org's `dominant_wavelength`, `complementary_wavelength` and `excitation_purity`, which
// take whole nanometres.
TEST(DominantWavelength, AndPurityMeetTheExamplesOfAnotherLibrary) {
  const DominantWavelength red = dominant_wavelength({0.54369557, 0.32107944}, d65);
  EXPECT_NEAR(red.lambda_nm, 616.0, 0.5);
  EXPECT_NEAR(red.purity, 0.62288567, 1e-4);
  EXPECT_FALSE(red.is_complementary);
  const DominantWavelength purple = dominant_wavelength({0.37605506, 0.24452225}, d65);
  EXPECT_NEAR(purple.lambda_nm, 509.0, 0.5);
  EXPECT_TRUE(purple.is_complementary);
}

TEST(DominantWavelength, OfPureLightIsItsOwn) {
  for (double lambda_nm = 365.0; lambda_nm < 830.0; lambda_nm += 5.0) {
    const DominantWavelength found =
        dominant_wavelength(chromaticity(Color3(observer_value(Observer::cie1931, lambda_nm))), {1.0 / 3, 1.0 / 3});
    // From 699 nm on all wavelengths have one colour.
    EXPECT_NEAR(found.lambda_nm, std::min(lambda_nm, 699.0), lambda_nm < 690.0 ? 1e-6 : 3.0) << lambda_nm;
    EXPECT_NEAR(found.purity, 1.0, 1e-6) << lambda_nm;
    EXPECT_FALSE(found.is_complementary) << lambda_nm;
  }
}

TEST(DominantWavelength, OfWhiteIsNoneAndOfMixturesWithWhiteIsUnchanged) {
  EXPECT_EQ(dominant_wavelength(d65, d65).purity, 0.0);
  const std::array<double, 2> half = {0.5 * (d65[0] + 0.64), 0.5 * (d65[1] + 0.33)};
  const DominantWavelength full = dominant_wavelength({0.64, 0.33}, d65), mixed = dominant_wavelength(half, d65);
  EXPECT_NEAR(mixed.lambda_nm, full.lambda_nm, 1e-9);
  EXPECT_NEAR(mixed.purity, 0.5 * full.purity, 1e-12);
}

}  // namespace
}  // namespace metamer
