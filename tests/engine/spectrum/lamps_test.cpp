// The colour-matching experiment.
#include "engine/spectrum/lamps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/spectrum/sources.h"

namespace metamer {
namespace {

// Stiles & Burch 1955, 2 degrees, in energy units, as CVRL publishes it (stiles_burch1955_2deg_rgb).
TEST(Lamps, A500NmLightNeedsRedOnItsOwnSide) {
  const Color3 amounts = lamp_amounts_of_line(500.0, Observer::stiles_burch1955);
  EXPECT_DOUBLE_EQ(amounts[0], -0.295);
  EXPECT_DOUBLE_EQ(amounts[1], 0.4906);
  EXPECT_DOUBLE_EQ(amounts[2], 0.10749);
  // The other observers agree that red is missing, and roughly on how much: their experiments are others.
  for (size_t i = 0; i < observer_count; ++i) {
    const Color3 other = lamp_amounts_of_line(500.0, static_cast<Observer>(i));
    EXPECT_LT(other[0], -0.2) << observer_names()[i];
    EXPECT_GT(other[0], -0.5) << observer_names()[i];
    EXPECT_GT(other[1], 0.0) << observer_names()[i];
    EXPECT_GT(other[2], 0.0) << observer_names()[i];
  }
}

TEST(Lamps, MatchThemselves) {
  for (size_t i = 0; i < observer_count; ++i)
    for (size_t lamp = 0; lamp < 3; ++lamp) {
      const auto observer = static_cast<Observer>(i);
      const Color3 amounts = lamp_amounts_of_line(lamp_nm[lamp], observer);
      // The 5 nm table of Stiles & Burch, interpolated, is 1 and 0 there within 1 %.
      const double tolerance = observer == Observer::stiles_burch1955 ? 0.011 : 1e-12;
      for (size_t other = 0; other < 3; ++other)
        EXPECT_NEAR(amounts[other], lamp == other ? 1.0 : 0.0, tolerance) << observer_names()[i] << ' ' << lamp;
    }
}

// What a match means: light and lamps have the same tristimulus values.
TEST(Lamps, LookLikeTheLightToTheObserver) {
  const Samples light = *cie_illuminant("FL11");
  for (size_t i = 0; i < observer_count; ++i) {
    const auto observer = static_cast<Observer>(i);
    const Color3 expected = integrate_xyz(light, observer);
    const Color3 mixed = multiply(lamps_to_tristimulus(observer), lamp_amounts(light, observer));
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(mixed[c] / expected[c], 1.0, 1e-12) << observer_names()[i];
  }
  const Color3 xyz = integrate_xyz(light), of_lamps = xyz_of_lamps(lamp_amounts(light, Observer::cie1931));
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(of_lamps[c] / xyz[c], 1.0, 1e-12);
}

// Grassmann's laws for amounts of lamps.
TEST(Lamps, MatchTwiceALightAndSumsOfLightsWithTwiceAndSums) {
  const Samples a = *cie_illuminant("A"), d65 = *cie_illuminant("D65");
  Samples sum, twice;
  for (size_t i = 0; i < lambda_count; ++i) {
    sum[i] = a[i] + d65[i];
    twice[i] = 2 * a[i];
  }
  for (size_t i = 0; i < observer_count; ++i) {
    const auto observer = static_cast<Observer>(i);
    const Color3 of_a = lamp_amounts(a, observer), of_d65 = lamp_amounts(d65, observer);
    const Color3 of_sum = lamp_amounts(sum, observer), of_twice = lamp_amounts(twice, observer);
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(of_sum[c], of_a[c] + of_d65[c], 1e-9 * std::fabs(of_sum[c]));
      EXPECT_NEAR(of_twice[c], 2 * of_a[c], 1e-9 * std::fabs(of_twice[c]));
    }
  }
}

TEST(Lamps, ObserversWereMeasuredWhereTheirTablesAre) {
  EXPECT_EQ(observer_range(Observer::cie1931).first_nm, 360.0);
  EXPECT_EQ(observer_range(Observer::cie1931).last_nm, 830.0);
  EXPECT_EQ(observer_range(Observer::stiles_burch1955).first_nm, 390.0);
  EXPECT_EQ(observer_range(Observer::stiles_burch1955).last_nm, 730.0);
}

}  // namespace
}  // namespace metamer
