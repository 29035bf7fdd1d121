#include "systems/display_colour.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/spectrum/lamps.h"
#include "systems/write_frame.h"
#include "tests/support/each_target.h"

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
        const Color3 rgb = developed(white, display_at(d), white, adaptation), one = white_amounts(display_at(d));
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c] / one[c], 1, 2e-6) << display_names()[d];
      }
}

// The amounts of light of 500 nm, 1 W m^-2 sr^-1, are those of the matching experiment, in units of 1/683.
TEST(DisplayColour, OfLampsIsTheirAmounts) {
  Color3 xyz = Color3(observer_value(Observer::cie1931, 500.0));
  for (double& v : xyz) v *= 683;
  const Color3 rgb = developed(xyz, ColorSpace::lamps, std::nullopt, Adaptation::cat16);
  const Color3 expected = lamp_amounts_of_line(500.0, Observer::cie1931);
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], 683 * expected[c], 1e-3);
  EXPECT_LT(rgb[0], -0.2 * 683);
  const Color3 white = developed(white_at(0), ColorSpace::lamps, std::nullopt, Adaptation::cat16);
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(white[c], white_amounts(ColorSpace::lamps)[c], 1e-6);
}

TEST(DisplayColour, LinearLampsStateTheirUnit) {
  const Chromaticities c = linear_chromaticities(ColorSpace::lamps);
  const auto red = chromaticity(Color3(observer_value(Observer::cie1931, 645.16)));
  EXPECT_FLOAT_EQ(c.red[0], static_cast<float>(red[0]));
  // X Y Z of R = G = B = 1 from the stated white and its luminance.
  const float Y = linear_white_luminance(ColorSpace::lamps);
  const Color3 sum = multiply(display_to_xyz(ColorSpace::lamps), Color3{1, 1, 1});
  EXPECT_NEAR(Y * c.white[0] / c.white[1], sum[0], 1e-5);
  EXPECT_NEAR(Y, sum[1], 1e-6);
  EXPECT_EQ(linear_chromaticities(ColorSpace::rec2020), display_chromaticities(ColorSpace::rec2020));
  EXPECT_EQ(linear_white_luminance(ColorSpace::srgb), 1);
}

TEST(Gamut, NegativeAmountsGiveWayWithoutAChangeOfLuminance) {
  for (const ColorSpace display : {ColorSpace::srgb, ColorSpace::lamps}) {
    const Color3 rgb = {-0.3, 0.5, 0.2}, mapped = into_gamut(rgb, display);
    EXPECT_NEAR(mapped[0], 0, 1e-15);
    EXPECT_GT(mapped[1], mapped[2]);
    EXPECT_NEAR(multiply(rgb_to_xyz(display), mapped)[1], multiply(rgb_to_xyz(display), rgb)[1], 1e-12);
    EXPECT_EQ(into_gamut({0.1, 2, 0}, display), (Color3{0.1, 2, 0}));
    EXPECT_EQ(into_gamut({-2, 0.1, 0.1}, ColorSpace::srgb), (Color3{0, 0, 0}));
  }
}

Picture picture_of(const std::vector<Color3>& colours) {
  Picture picture{static_cast<uint32_t>(colours.size()), 1, {}, {}, {}};
  for (const Color3& c : colours) {
    picture.r.push_back(static_cast<float>(c[0]));
    picture.g.push_back(static_cast<float>(c[1]));
    picture.b.push_back(static_cast<float>(c[2]));
  }
  return picture;
}

TEST(Gamut, CodesOfLampsAreMappedAsTheScalarFormSaysOnEveryInstructionSet) {
  std::vector<Color3> colours;
  for (double r = -1.5; r < 1.5; r += 0.17)
    for (double g = -0.5; g < 1.5; g += 0.23)
      for (double b = -0.5; b < 1.5; b += 0.31) colours.push_back({r, g, b});
  const Color3 white = white_amounts(ColorSpace::lamps);
  std::vector<Color3> amounts = colours;
  for (Color3& a : amounts)
    for (size_t c = 0; c < 3; ++c) a[c] *= white[c];
  const Picture picture = picture_of(amounts);
  ToneSettings settings;
  settings.display = ColorSpace::lamps;
  settings.dither = false;
  for_each_target([&] {
    const CodedPicture coded = tone_map(picture, settings);
    for (size_t i = 0; i < colours.size(); ++i) {
      const Color3 expected = into_gamut(colours[i], ColorSpace::lamps);
      for (size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(static_cast<double>(coded.codes[i] >> (8 * c) & 255), 255 * srgb_encode_scalar(expected[c]), 0.502)
            << i;
    }
  });
}

TEST(Gamut, NegativeAmountsAreCounted) {
  const NegativeAmounts negative = negative_amounts(picture_of({{1, 2, 3}, {-1, 2, 3}, {-2, -3, 1}, {0, 0, 0}}));
  EXPECT_EQ(negative.pixels, 2u);
  EXPECT_EQ(negative.least, (std::array<float, 3>{-2, -3, 0}));
}

// Linear amounts of lamps are what an EXR holds: without exposure and curve to the last bit.
TEST(Develop, OfLampsKeepsNegativeAmounts) {
  Picture picture = picture_of({{-0.295, 0.4906, 0.10749}});
  ToneSettings settings;
  settings.display = ColorSpace::lamps;
  expose(picture, settings);
  EXPECT_EQ(picture.r[0], -0.295f);
  settings.exposure_stops = 1;
  expose(picture, settings);
  EXPECT_NEAR(picture.r[0], -0.59, 1e-6);
  EXPECT_NEAR(picture.b[0], 0.21498, 1e-6);
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
    Developed d = develop(develop(observe(film_of(X, Y, Z, 7), Observer::cie1931, 1)), look);
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
        double size = 0;  // of the colours: components may nearly cancel
        for (size_t c = 0; c < 3; ++c) size = std::max(size, std::fabs(a[c]) + std::fabs(b[c]));
        EXPECT_NEAR(sum[i], a[i] + b[i], 1e-6 * size);
        EXPECT_NEAR(twice[i], 2 * a[i], 1e-6 * size);
      }
    }
}

}  // namespace
}  // namespace metamer
