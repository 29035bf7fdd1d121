#include "systems/tone_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "systems/tone_map.h"
#include "tests/support/each_target.h"
#include "tests/systems/support/pictures.h"

namespace metamer {
namespace {

std::array<float, 3> exposed(const std::array<float, 3>& rgb, ToneCurve curve, ColorSpace display = ColorSpace::srgb) {
  Picture picture = picture_of({rgb});
  ToneSettings settings;
  settings.curve = curve;
  settings.display = display;
  expose(picture, settings);
  return {picture.r[0], picture.g[0], picture.b[0]};
}

struct Pinned {
  ToneCurve curve;
  std::array<double, 5> values;  // of the greys 0.01, 0.18, 0.5, 1 and 4
};

// Computed from the formulas as published, by a Python script of its own with 64-bit floats.
TEST(ToneCurve, OfGreysMeetsFiveValuesComputedIndependently) {
  constexpr std::array<float, 5> greys = {0.01f, 0.18f, 0.5f, 1.0f, 4.0f};
  const std::vector<Pinned> cases = {
      {ToneCurve::linear, {0.01, 0.18, 0.5, 1.0, 4.0}},
      {ToneCurve::reinhard, {0.00990099, 0.152542373, 0.333333333, 0.5, 0.8}},
      {ToneCurve::reinhard_extended, {0.009907178, 0.154258475, 0.34375, 0.53125, 1.0}},
      {ToneCurve::hable, {0.007663655, 0.128338449, 0.304300561, 0.492918546, 0.918030079}},
      {ToneCurve::filmic, {0.001130465, 0.225399713, 0.500699223, 0.683541801, 0.901861938}}};
  for (const Pinned& c : cases)
    for (size_t i = 0; i < 5; ++i) {
      SCOPED_TRACE(testing::Message() << tone_curve_name(c.curve) << ' ' << greys[i]);
      const double grey = greys[i];
      EXPECT_NEAR(tone_curve_scalar(c.curve, ColorSpace::srgb, {grey, grey, grey})[1], c.values[i], 1e-7);
      for (const float component : exposed({greys[i], greys[i], greys[i]}, c.curve))
        EXPECT_NEAR(component, c.values[i], 3e-6);
    }
}

TEST(ToneCurve, AgxMeetsFiveColoursComputedIndependently) {
  const std::vector<std::pair<std::array<float, 3>, Color3>> cases = {
      {{0.01f, 0.01f, 0.01f}, {0.0059947, 0.0059953, 0.0059953}},
      {{0.18f, 0.18f, 0.18f}, {0.2144674, 0.2145327, 0.2145367}},
      {{1, 1, 1}, {0.589977, 0.5902072, 0.5902215}},
      {{1, 0.2f, 0.05f}, {0.6533599, 0.2536196, 0.1078805}},
      {{0, 0, 8}, {0.4454923, 0.4455282, 1.0062535}}};
  for (const auto& [rgb, expected] : cases) {
    const Color3 scalar = tone_curve_scalar(ToneCurve::agx, ColorSpace::srgb, {rgb[0], rgb[1], rgb[2]});
    const std::array<float, 3> simd = exposed(rgb, ToneCurve::agx);
    for (size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(scalar[i], expected[i], 2e-7);
      EXPECT_NEAR(simd[i], expected[i], 2e-5);
    }
  }
}

TEST(ToneCurve, OfReinhardExtendedReachesWhereItIsTold) {
  for (const float white : {1.0f, 2.5f, 100.0f}) {
    Picture picture = picture_of({{white, white, white}, {0.5f, 0.5f, 0.5f}});
    ToneSettings settings;
    settings.curve = ToneCurve::reinhard_extended;
    settings.reinhard_white = white;
    expose(picture, settings);
    EXPECT_NEAR(picture.g[0], 1, 1e-6) << white;
    const double expected = 0.5 * (1 + 0.5 / (double{white} * double{white})) / 1.5;
    EXPECT_NEAR(picture.g[1], expected, 1e-6) << white;
    EXPECT_NEAR(tone_curve_scalar(settings.curve, ColorSpace::srgb, {0.5, 0.5, 0.5}, white)[1], expected, 1e-12);
  }
}

// Reinhard's curve acts on luminance: 0.2126390, 0.7151687, 0.0721923 are sRGB's weights, for its rounded white.
TEST(ToneCurve, OfReinhardKeepsTheChromaticity) {
  const std::array<float, 3> plain = exposed({1, 0.2f, 0.05f}, ToneCurve::reinhard);
  const std::array<float, 3> extended = exposed({1, 0.2f, 0.05f}, ToneCurve::reinhard_extended);
  const Color3 expected = {0.73568232, 0.14713646, 0.03678412},
               expected_extended = {0.75220218, 0.15044044, 0.03761011};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(plain[i], expected[i], 3e-5);
    EXPECT_NEAR(extended[i], expected_extended[i], 3e-5);
  }
}

std::vector<std::array<float, 3>> many_colours() {
  std::vector<std::array<float, 3>> colours;
  uint32_t state = 1;
  const auto uniform = [&state] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) * 0x1p-24f;
  };
  for (int i = 0; i < 20000; ++i) {
    const float size = std::exp2(uniform() * 24 - 14);
    colours.push_back({size * uniform(), size * uniform(), size * (uniform() * 1.2f - 0.2f)});
  }
  for (float x = 1e-12f; x < 1e9f; x *= 1.07f) colours.push_back({x, x, x});
  return colours;
}

TEST(ToneCurve, AgreesWithTheScalarFormWithinTheStatedErrorAndBitForBitOnEveryInstructionSet) {
  const std::map<ToneCurve, double> stated = {{ToneCurve::linear, 0},    {ToneCurve::reinhard, 3e-7},
                                              {ToneCurve::hable, 5e-7},  {ToneCurve::reinhard_extended, 5e-7},
                                              {ToneCurve::filmic, 3e-6}, {ToneCurve::agx, 2e-5}};
  const std::vector<std::array<float, 3>> colours = many_colours();
  for (const auto& [curve, error] : stated)
    for (const ColorSpace display : {ColorSpace::srgb, ColorSpace::dci_p3, ColorSpace::rec2020}) {
      Column<float> first;
      for_each_target([&] {
        Picture picture = picture_of(colours);
        ToneSettings settings;
        settings.curve = curve;
        settings.display = display;
        expose(picture, settings);
        double worst = 0;
        for (size_t i = 0; i < colours.size(); ++i) {
          const Color3 exact = tone_curve_scalar(curve, display, {colours[i][0], colours[i][1], colours[i][2]});
          const double size = std::max({1.0, std::fabs(exact[0]), std::fabs(exact[1]), std::fabs(exact[2])});
          worst = std::max({worst, std::fabs(picture.r[i] - exact[0]) / size, std::fabs(picture.g[i] - exact[1]) / size,
                            std::fabs(picture.b[i] - exact[2]) / size});
        }
        EXPECT_LE(worst, error) << tone_curve_name(curve);
        if (first.empty()) first = picture.b;
        EXPECT_EQ(std::memcmp(first.data(), picture.b.data(), first.size() * sizeof(float)), 0);
      });
    }
}

TEST(ToneCurve, NeverTurnsWildValuesIntoNotANumber) {
  constexpr float infinity = HUGE_VALF;
  for (const ToneCurve curve :
       {ToneCurve::reinhard, ToneCurve::reinhard_extended, ToneCurve::hable, ToneCurve::filmic, ToneCurve::agx})
    for (const float value : {infinity, -infinity, std::nanf(""), 3e38f, -3e38f, -1.0f, 0.0f, 1e-40f}) {
      for (const float component : exposed({value, value, value}, curve)) EXPECT_TRUE(std::isfinite(component));
      if (curve == ToneCurve::hable || curve == ToneCurve::filmic || curve == ToneCurve::agx) {
        for (const float component : exposed({value, value, value}, curve)) EXPECT_GE(component, 0);
      }
    }
}

TEST(ToneCurve, IsTheSameInCodesAndInLinearLight) {
  const Picture picture = picture_of(many_colours());
  for (const ToneCurve curve : {ToneCurve::linear, ToneCurve::hable, ToneCurve::agx}) {
    ToneSettings settings{.exposure_stops = 1.5f, .dither = false};
    settings.curve = curve;
    const CodedPicture direct = tone_map(picture, settings);
    Picture light = picture;
    expose(light, settings);
    const CodedPicture after = tone_map(light, {.exposure_stops = 0, .dither = false});
    EXPECT_TRUE(std::equal(direct.codes.begin(), direct.codes.end(), after.codes.begin()));
  }
}

TEST(ToneCurve, ThreadsAndWidthChangeNothing) {
  std::vector<std::array<float, 3>> colours;
  for (uint32_t i = 0; i < 300000; ++i) {
    const float x = static_cast<float>(i) * 1e-5f;
    colours.push_back({x, 0.5f * x, 0.1f});
  }
  Picture picture = picture_of(colours);
  picture.width = 1000;
  picture.height = 300;
  ToneSettings settings;
  settings.curve = ToneCurve::filmic;
  settings.threads = 1;
  const CodedPicture one = tone_map(picture, settings);
  settings.threads = 3;
  const CodedPicture three = tone_map(picture, settings);
  EXPECT_TRUE(std::equal(one.codes.begin(), one.codes.end(), three.codes.begin()));
}

}  // namespace
}  // namespace metamer
