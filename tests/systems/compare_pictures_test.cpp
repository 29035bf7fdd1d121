#include "systems/compare_pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "engine/spectrum/lab.h"

namespace metamer {
namespace {

Picture picture_of(uint32_t width, uint32_t height, const std::vector<Color3>& pixels) {
  Picture picture{width, height, {}, {}, {}};
  for (const Color3& rgb : pixels) {
    picture.r.push_back(static_cast<float>(rgb[0]));
    picture.g.push_back(static_cast<float>(rgb[1]));
    picture.b.push_back(static_cast<float>(rgb[2]));
  }
  return picture;
}

// White of luminance 0.18418651851244416 is L* = 50; of 0.19 51.  Between greys CIEDE2000 is the difference of L* over
// S_L = 1 + 0.015 (L - 50)^2 / sqrt(20 + (L - 50)^2).
TEST(ComparePictures, GreysDifferByTheirLightness) {
  const auto grey = [](double L) {
    const double f = (L + 16) / 116;
    return Color3{f * f * f, f * f * f, f * f * f};
  };
  const Picture a = picture_of(3, 1, {grey(49), grey(20), grey(90)}),
                b = picture_of(3, 1, {grey(51), grey(26), grey(90)});
  const PictureDifference difference = compare_pictures(xyz_of(a, {}), xyz_of(b, {}), {0, 1});
  EXPECT_NEAR(difference.delta_e[0], 2, 1e-3);
  const double s = 1 + 0.015 * 27 * 27 / std::sqrt(20.0 + 27 * 27);
  EXPECT_NEAR(difference.delta_e[1], 6 / s, 1e-3);
  EXPECT_EQ(difference.delta_e[2], 0);
  EXPECT_NEAR(difference.mean, (2 + 6 / s) / 3, 1e-3);
  EXPECT_NEAR(difference.median, 2, 1e-3);
  EXPECT_NEAR(difference.largest, 6 / s, 1e-3);
  EXPECT_EQ(difference.largest_pixel, 1u);
}

TEST(ComparePictures, ExposureActsOnBothAndWhiteIsTheBrightest) {
  const Picture a = picture_of(2, 1, {{0.01, 0.02, 0.03}, {7, 7, 7}}),
                b = picture_of(2, 1, {{0.02, 0.02, 0.02}, {9, 9, 9}});
  const PictureDifference dim = compare_pictures(xyz_of(a, {}), xyz_of(b, {}), {0, 1});
  const PictureDifference bright = compare_pictures(xyz_of(a, {}), xyz_of(b, {}), {3, 1});
  EXPECT_GT(bright.delta_e[0], 1.5 * dim.delta_e[0]);
  EXPECT_NEAR(dim.delta_e[1], 0, 1e-3);
  EXPECT_GT(compare_pictures(xyz_of(a, {}), xyz_of(b, {}), {-4, 1}).delta_e[1], 1);
}

TEST(ComparePictures, TheSameColourInOtherPrimariesIsNoDifference) {
  const Color3 xyz = {0.3, 0.35, 0.2};
  const Chromaticities rec2020 = {{0.708f, 0.292f}, {0.170f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.3290f}};
  const Picture a = picture_of(1, 1, {multiply(xyz_to_rgb(ColorSpace::srgb), xyz)});
  const Picture b = picture_of(1, 1, {multiply(xyz_to_rgb(ColorSpace::rec2020), xyz)});
  EXPECT_LT(compare_pictures(xyz_of(a, {}), xyz_of(b, rec2020), {0, 1}).largest, 0.05);
  EXPECT_GT(compare_pictures(xyz_of(a, {}), xyz_of(b, {}), {0, 1}).largest, 1);
}

TEST(ComparePictures, QuantilesAreThoseOfThePixelsAndThreadsChangeNothing) {
  std::vector<Color3> dark, light;
  for (int i = 0; i < 10001; ++i) {
    const double f = (50 + 1e-4 * i + 16) / 116, g = 66.0 / 116;
    dark.push_back({g * g * g, g * g * g, g * g * g});
    light.push_back({f * f * f, f * f * f, f * f * f});
  }
  const XyzPicture a = xyz_of(picture_of(10001, 1, dark), {}), b = xyz_of(picture_of(10001, 1, light), {});
  const PictureDifference one = compare_pictures(a, b, {0, 1}), three = compare_pictures(a, b, {0, 3});
  EXPECT_NEAR(one.median, 0.5, 1e-3);
  EXPECT_NEAR(one.percentile_95, 0.95, 1e-3);
  EXPECT_TRUE(std::equal(one.delta_e.begin(), one.delta_e.end(), three.delta_e.begin()));
}

TEST(ComparePictures, WhatIsNotFiniteIsLeftOutAndGreenInTheMap) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Picture a = picture_of(3, 1, {{nan, 0, 0}, {0.5, 0.5, 0.5}, {0.2, 0.2, 0.2}});
  const Picture b = picture_of(3, 1, {{0, 0, 0}, {0.5, 0.5, 0.5}, {0.9, 0.1, 0.9}});
  const PictureDifference difference = compare_pictures(xyz_of(a, {}), xyz_of(b, {}), {0, 1});
  EXPECT_EQ(difference.not_finite, 1u);
  EXPECT_EQ(difference.median, difference.largest);
  const Picture map = difference_map(difference, 3, 1, 10);
  EXPECT_EQ(map.r[0], 0);
  EXPECT_EQ(map.g[0], 1);
  EXPECT_NEAR(map.g[1], 0, 1e-6);
  EXPECT_NEAR(map.r[2], 1, 1e-3);
  EXPECT_NEAR(map.b[2], 1, 1e-3);
}

// Equal steps of difference are nearly equal steps of lightness.
TEST(ComparePictures, TheMapsLightnessRisesEvenly) {
  PictureDifference difference;
  for (int i = 0; i <= 20; ++i) difference.delta_e.push_back(static_cast<float>(i) / 2);
  const Picture map = difference_map(difference, 21, 1, 10);
  for (size_t i = 0; i <= 20; ++i) {
    const Color3 rgb = {double{map.r[i]}, double{map.g[i]}, double{map.b[i]}};
    const Color3 lab = lab_of_xyz(multiply(rgb_to_xyz(ColorSpace::srgb), rgb), white_xyz(ColorSpace::srgb));
    EXPECT_NEAR(lab[0], 5 * static_cast<double>(i), 0.1) << i;
  }
}

// Four samples, one in each replicate: halves are replicates 0 and 1, 2 and 3.
TEST(ComparePictures, AFilmsHalvesAreItsReplicates) {
  Film film(1, 1);
  TileFilm tile;
  tile.reset(0, 0, 1, 1, 0, 4);
  const uint32_t pixel[4] = {}, sample[4] = {0, 1, 2, 3};
  const float X[4] = {1, 2, 3, 4}, Y[4] = {5, 6, 7, 8}, Z[4] = {9, 10, 11, 12};
  add_samples(tile, pixel, sample, X, Y, Z);
  flush(film, tile);
  EXPECT_EQ(xyz_of(film).X[0], 2.5f);
  EXPECT_EQ(xyz_of(film, 0).Y[0], 5.5f);
  EXPECT_EQ(xyz_of(film, 1).Z[0], 11.5f);
}

}  // namespace
}  // namespace metamer
