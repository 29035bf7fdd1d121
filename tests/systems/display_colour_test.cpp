#include "systems/display_colour.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/write_frame.h"

namespace metamer {
namespace {

Color3 developed(const Color3& xyz, ColorSpace display, const std::optional<Color3>& white, Adaptation adaptation) {
  const ColourMatrix m = display_matrix(display, white, adaptation);
  Color3 rgb = {};
  for (size_t row = 0; row < 3; ++row)
    for (size_t column = 0; column < 3; ++column) rgb[row] += double{m[row][column]} * xyz[column];
  return rgb;
}

// CIE 15:2018, table T.3.
TEST(DisplayColour, WhitesHaveTheirPublishedChromaticities) {
  const double published[3][2] = {{0.31272, 0.32903}, {0.34567, 0.35851}, {0.44757, 0.40745}};
  for (size_t i = 0; i < 3; ++i) {
    const auto xy = chromaticity(white_at(i));
    EXPECT_NEAR(xy[0], published[i][0], 3e-5) << white_names()[i];
    EXPECT_NEAR(xy[1], published[i][1], 3e-5) << white_names()[i];
    EXPECT_EQ(white_at(i)[1], 1);
  }
  const auto daylight = chromaticity(white_of_temperature(6504)), lamp = chromaticity(white_of_temperature(2856));
  EXPECT_NEAR(daylight[0], published[0][0], 2e-4);
  EXPECT_NEAR(lamp[0], published[2][0], 2e-4);
  EXPECT_NEAR(lamp[1], published[2][1], 2e-4);
}

TEST(DisplayColour, TheChosenWhiteBecomesNeutralAndKeepsItsLuminance) {
  for (size_t d = 0; d < display_names().size(); ++d)
    for (const Adaptation adaptation : {Adaptation::bradford, Adaptation::cat16})
      for (const Color3& white : {white_at(0), white_at(1), white_at(2), white_of_temperature(9000)}) {
        const Color3 rgb = developed(white, display_at(d), white, adaptation);
        for (const double component : rgb) EXPECT_NEAR(component, 1, 1e-6) << display_names()[d];
      }
}

// D50 white unadapted on sRGB is yellowish, and the methods differ away from white.
TEST(DisplayColour, WithoutAWhiteNothingIsAdapted) {
  const Color3 a = developed(white_at(2), ColorSpace::srgb, std::nullopt, Adaptation::cat16);
  EXPECT_GT(a[0], 1.5);
  EXPECT_LT(a[2], 0.3);
  EXPECT_EQ(display_matrix(ColorSpace::srgb, white_at(0), Adaptation::cat16),
            display_matrix(ColorSpace::srgb, std::nullopt, Adaptation::cat16));
  EXPECT_NE(display_matrix(ColorSpace::srgb, white_at(2), Adaptation::cat16),
            display_matrix(ColorSpace::srgb, white_at(2), Adaptation::bradford));
}

// B. Lindbloom, "Chromatic Adaptation": Bradford from D50 to D65, here applied to a colour, in sRGB.
TEST(DisplayColour, BradfordMeetsLindbloomsMatrix) {
  const Matrix3 published = {
      {{0.9555766, -0.0230393, 0.0631636}, {-0.0282895, 1.0099416, 0.0210077}, {0.0122982, -0.0204830, 1.3299098}}};
  const Color3 xyz = {0.4, 0.3, 0.1};
  const Color3 expected = multiply(xyz_to_rgb(ColorSpace::srgb), multiply(published, xyz));
  const Color3 rgb = developed(xyz, ColorSpace::srgb, white_at(1), Adaptation::bradford);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(rgb[i], expected[i], 2e-4);
}

TEST(DisplayColour, ChromaticitiesAreThoseOfTheStandards) {
  const Chromaticities p3 = display_chromaticities(ColorSpace::dci_p3);
  EXPECT_FLOAT_EQ(p3.red[0], 0.680f);
  EXPECT_FLOAT_EQ(p3.green[1], 0.690f);
  EXPECT_NEAR(p3.white[0], 0.3127f, 1e-4);
  const Chromaticities rec2020 = display_chromaticities(ColorSpace::rec2020);
  EXPECT_FLOAT_EQ(rec2020.green[0], 0.170f);
  EXPECT_FLOAT_EQ(rec2020.blue[1], 0.046f);
}

Picture greys(std::initializer_list<float> values) {
  Picture picture{static_cast<uint32_t>(values.size()), 1, {}, {}, {}};
  for (const float v : values)
    for (Column<float>* column : {&picture.r, &picture.g, &picture.b}) column->push_back(v);
  return picture;
}

TEST(AutomaticExposure, BringsTheGeometricMeanTo18Percent) {
  EXPECT_NEAR(automatic_exposure_stops(greys({0.18f}), ColorSpace::srgb), 0, 1e-6);
  EXPECT_NEAR(automatic_exposure_stops(greys({0.09f, 0.36f, 0.72f}), ColorSpace::srgb), -2.0 / 3, 1e-6);
  EXPECT_NEAR(automatic_exposure_stops(greys({0, 0, 1800, -1, std::nanf("")}), ColorSpace::rec2020), -std::log2(1e4),
              1e-5);
  EXPECT_EQ(automatic_exposure_stops(greys({0, 0}), ColorSpace::srgb), 0);
  Picture many = greys({});
  for (int i = 0; i < 100000; ++i)
    for (Column<float>* column : {&many.r, &many.g, &many.b}) column->push_back(i % 2 == 0 ? 1e-30f : 1e30f);
  many.width = 100000;
  EXPECT_NEAR(automatic_exposure_stops(many, ColorSpace::srgb), std::log2(0.18), 1e-4);
}

Film film_of(float X, float Y, float Z, uint32_t copies) {
  Film film(1, 1);
  TileFilm tile;
  tile.reset(0, 0, 1, 1, 0, copies);
  const uint32_t pixel = 0;
  for (uint32_t k = 0; k < copies; ++k) add_samples(tile, std::span(&pixel, 1), std::span(&k, 1), &X, &Y, &Z);
  flush(film, tile);
  return film;
}

// Grassmann: what is developed before the tone curve is linear in the light.
TEST(Develop, IsLinearInTheLightBeforeToneMapping) {
  const auto colour = [](float X, float Y, float Z, const Look& look) {
    Developed d = develop(film_of(X, Y, Z, 7), look);
    expose(d.picture, d.tone);
    return Color3{d.picture.r[0], d.picture.g[0], d.picture.b[0]};
  };
  for (size_t d = 0; d < display_names().size(); ++d)
    for (const std::optional<Color3>& white : {std::optional<Color3>(), std::optional(white_at(2))}) {
      Look look;
      look.display = display_at(d);
      look.white = white;
      look.exposure_stops = -1.3f;
      const Color3 a = colour(3, 5, 0.5f, look), b = colour(0.25f, 4, 20, look);
      const Color3 sum = colour(3.25f, 9, 20.5f, look), twice = colour(6, 10, 1, look);
      for (size_t i = 0; i < 3; ++i) {
        const double size = std::fabs(a[i]) + std::fabs(b[i]);
        EXPECT_NEAR(sum[i], a[i] + b[i], 1e-6 * size);
        EXPECT_NEAR(twice[i], 2 * a[i], 1e-6 * size);
      }
    }
}

}  // namespace
}  // namespace metamer
