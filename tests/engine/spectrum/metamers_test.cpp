#include "engine/spectrum/metamers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/spectrum/lab.h"
#include "engine/spectrum/named_spectra.h"
#include "engine/spectrum/sources.h"

namespace metamer {
namespace {

Viewing viewing(const char* light, Observer observer) { return {*cie_illuminant(light), observer}; }

// Published values, for instance by B. Lindbloom's calculator: sRGB's red and white under D65.
TEST(Lab, MeetsPublishedValues) {
  const Color3 white = {0.95047, 1.0, 1.08883};
  const Color3 red = lab_of_xyz({0.4124564, 0.2126729, 0.0193339}, white);
  EXPECT_NEAR(red[0], 53.2408, 1e-3);
  EXPECT_NEAR(red[1], 80.0925, 1e-3);
  EXPECT_NEAR(red[2], 67.2032, 1e-3);
  EXPECT_NEAR(lab_of_xyz(white, white)[0], 100.0, 1e-12);
  // Below Y = 0.008856 lightness is 903.3 Y.
  EXPECT_NEAR(lab_of_xyz({0.0095047 / 2, 0.005, 0.0108883 / 2}, white)[0], 24389.0 / 27.0 * 0.005, 1e-9);
  EXPECT_DOUBLE_EQ(delta_e_1976({50, 3, -4}, {50, 0, 0}), 5.0);
}

class Metamers : public testing::TestWithParam<const char*> {};

TEST_P(Metamers, AreEqualInOneLightAndSplitInAnotherAndForAnotherObserver) {
  const Viewing same = viewing("D65", Observer::cie1931), lamp = viewing("A", Observer::cie1931),
                wide = viewing("D65", Observer::cie1964);
  const auto curves = make_metamers(*named_spectrum(GetParam()), same, {lamp, wide});
  const Samples first = metamer_samples(curves[0]), second = metamer_samples(curves[1]);
  const Color3 xyz = seen_xyz(first, same), other = seen_xyz(second, same);
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(xyz[c], other[c], 1e-12);
  EXPECT_GT(seen_difference(first, second, lamp), 5.0);
  EXPECT_GT(seen_difference(first, second, wide), 3.0);
  // Both are reflectances, and smooth: no step of 10 nm reaches a fifth.
  for (const MetamerCurve& curve : curves)
    for (size_t i = 0; i < metamer_points; ++i) {
      EXPECT_GE(curve[i], metamer_least);
      EXPECT_LE(curve[i], metamer_most);
      if (i > 0) {
        EXPECT_LT(std::fabs(curve[i] - curve[i - 1]), 0.3);
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Patches, Metamers,
                         testing::Values("colorchecker.light_skin", "colorchecker.foliage", "colorchecker.blue_flower",
                                         "colorchecker.purple", "colorchecker.neutral_5_(.70_D)"),
                         [](const auto& each) {
                           std::string name = std::string(each.param).substr(13);
                           std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                           return name;
                         });

TEST(Metamers, OfOtherLightsAndObserversAreEqualThereToo) {
  Samples grey;
  grey.fill(0.5);
  const Viewing same = viewing("FL11", Observer::cie2015_10), apart = viewing("D50", Observer::cie2015_10),
                other = viewing("FL11", Observer::cie1931);
  const auto curves = make_metamers(grey, same, {apart, other});
  const Samples first = metamer_samples(curves[0]), second = metamer_samples(curves[1]);
  EXPECT_LT(seen_difference(first, second, same), 1e-9);
  EXPECT_GT(seen_difference(first, second, apart), 5.0);
  EXPECT_GT(seen_difference(first, second, other), 1.0);
}

// Nothing can differ from a reflectance that is black or white everywhere.
TEST(Metamers, OfBlackAreBlack) {
  const auto curves = make_metamers(Samples{}, viewing("D65", Observer::cie1931),
                                    {viewing("A", Observer::cie1931), viewing("D65", Observer::cie1964)});
  for (const MetamerCurve& curve : curves)
    for (const double value : curve) EXPECT_DOUBLE_EQ(value, metamer_least);
}

}  // namespace
}  // namespace metamer
