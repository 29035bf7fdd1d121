#include "systems/tone_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

#include "hwy/targets.h"

namespace metamer {
namespace {

void on_every_target(const std::function<void(const char*)>& check) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    check(hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
}

Picture grey_picture(uint32_t width, uint32_t height, float value) {
  Picture picture{width, height, Column<float>(), Column<float>(), Column<float>()};
  for (Column<float>* column : {&picture.r, &picture.g, &picture.b}) {
    column->resize(picture.pixel_count());
    for (float& v : *column) v = value;
  }
  return picture;
}

uint32_t code_of(float value, float stops = 0) {
  return tone_map(grey_picture(1, 1, value), {.exposure_stops = stops, .dither = false}).codes[0] & 0xff;
}

TEST(ToneMap, EncodesWithinTheStatedErrorOnEveryInstructionSet) {
  Column<float> linear;
  for (uint32_t i = 0; i <= 1u << 20; ++i) linear.push_back(static_cast<float>(i) * 0x1p-20f);
  for (float x = 1e-38f; x < 2; x *= 1.01f) linear.push_back(x);
  for (float x = 0.0031306f; x < 0.003131f; x = std::nextafter(x, 1.0f)) linear.push_back(x);
  on_every_target([&](const char* target) {
    Column<float> encoded(linear.size());
    srgb_encode(linear.size(), linear.data(), encoded.data());
    double worst = 0;
    for (size_t i = 0; i < linear.size(); ++i)
      worst = std::max(worst, std::fabs(encoded[i] - srgb_encode_scalar(linear[i])));
    EXPECT_LE(worst, 4e-7) << target;
  });
}

// The curve's published values: 12.92 times 0.0031308 at the knee; 18 % grey is code 117.6, half is 187.5.
TEST(ToneMap, MeetsPublishedValuesOfTheSrgbCurve) {
  EXPECT_NEAR(srgb_encode_scalar(0.0031308), 0.04045, 1e-6);
  EXPECT_NEAR(srgb_encode_scalar(0.18), 0.461356, 1e-6);
  EXPECT_NEAR(srgb_encode_scalar(0.5), 0.735357, 1e-6);
  EXPECT_NEAR(srgb_encode_scalar(0.214041), 0.5, 1e-6);
  on_every_target([](const char* target) {
    EXPECT_EQ(code_of(0.0f), 0u) << target;
    EXPECT_EQ(code_of(0.0031308f), 10u) << target;
    EXPECT_EQ(code_of(0.18f), 118u) << target;
    EXPECT_EQ(code_of(0.5f), 188u) << target;
    EXPECT_EQ(code_of(1.0f), 255u) << target;
  });
}

TEST(ToneMap, EveryCodeOfTheDisplayReturnsToItselfWithAndWithoutDither) {
  on_every_target([](const char* target) {
    for (uint32_t code = 0; code < 256; ++code) {
      const double v = code / 255.0;
      const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
      EXPECT_EQ(code_of(static_cast<float>(linear)), code) << target;
      const CodedPicture dithered = tone_map(grey_picture(32, 32, static_cast<float>(linear)), {});
      const auto others = std::count_if(dithered.codes.begin(), dithered.codes.end(),
                                        [=](uint32_t c) { return c != code * 0x010101u; });
      EXPECT_LE(others, 1) << target << ' ' << code;  // float rounding of the code may cross one threshold
    }
  });
}

TEST(ToneMap, ClipsAndNeverTurnsNotANumberIntoLight) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  on_every_target([](const char* target) {
    for (const float stops : {0.0f, 100.0f, -100.0f, infinity, std::numeric_limits<float>::quiet_NaN()}) {
      EXPECT_EQ(code_of(std::numeric_limits<float>::quiet_NaN(), stops), 0u) << target;
      EXPECT_EQ(code_of(-1.0f, stops), 0u) << target;
      EXPECT_EQ(code_of(-infinity, stops), 0u) << target;
      EXPECT_EQ(code_of(infinity, stops), 255u) << target;
    }
    EXPECT_EQ(code_of(1e30f), 255u) << target;
    EXPECT_EQ(code_of(std::numeric_limits<float>::denorm_min()), 0u) << target;
  });
}

TEST(ToneMap, AStopDoublesExactly) {
  for (int stops = -10; stops <= 10; ++stops)
    for (const float value : {0.001f, 0.02f, 0.18f, 0.7f})
      EXPECT_EQ(code_of(value, static_cast<float>(stops)), code_of(std::ldexp(value, stops))) << stops;
  // A third of a stop is the factor 1.259921, half a stop 1.414214.
  EXPECT_EQ(code_of(0.25f, 0.5f), code_of(0.25f * 1.41421356f));
  EXPECT_EQ(code_of(0.25f, 1.0f / 3), code_of(0.25f * 1.25992105f));
  EXPECT_EQ(code_of(0.25f, -0.75f), code_of(0.25f * 0.59460356f));
}

TEST(ToneMap, DitherKeepsTheMeanAndStaysBetweenNeighbouringCodes) {
  for (const float value : {0.0001f, 0.01f, 0.1f, 0.18f, 0.5f, 0.9f}) {
    const CodedPicture coded = tone_map(grey_picture(128, 128, value), {});
    const double exact = srgb_encode_scalar(value) * 255;
    double mean = 0;
    for (const uint32_t code : coded.codes) {
      ASSERT_LT(std::fabs((code & 0xff) - exact), 1) << value;
      ASSERT_EQ(code, (code & 0xff) * 0x010101u) << "grey stays grey";
      mean += (code & 0xff) / static_cast<double>(coded.codes.size());
    }
    EXPECT_NEAR(mean, exact, 0.005) << value;
  }
}

// The position in the picture decides, not the lane: small widths wrap several times within a vector.
TEST(ToneMap, DitherDependsOnThePixelsPositionAlone) {
  const float value = 0.3f;
  const CodedPicture large = tone_map(grey_picture(64, 64, value), {});
  on_every_target([&](const char* target) {
    for (const uint32_t width : {1u, 2u, 3u, 5u, 7u, 15u, 16u, 17u, 31u, 33u, 63u}) {
      const CodedPicture small = tone_map(grey_picture(width, 9, value), {});
      for (uint32_t y = 0; y < 9; ++y)
        for (uint32_t x = 0; x < width; ++x)
          ASSERT_EQ(small.codes[y * width + x], large.codes[y * 64 + x])
              << target << ' ' << width << ' ' << x << ' ' << y;
    }
  });
}

TEST(ToneMap, PutsRedFirst) {
  Picture picture = grey_picture(1, 1, 0);
  picture.r[0] = 1;
  picture.g[0] = 0.5f;
  EXPECT_EQ(tone_map(picture, {.exposure_stops = 0, .dither = false}).codes[0], 0x00bcffu);
}

}  // namespace
}  // namespace metamer
