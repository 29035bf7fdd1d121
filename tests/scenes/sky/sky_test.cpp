// The sky's model against its formulas and against what one measures outdoors.
#include "scenes/sky/sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace metamer {
namespace {

constexpr double pi = std::numbers::pi;

SkySettings settings_of(double turbidity, double elevation, double azimuth = 180, uint32_t resolution = 64) {
  SkySettings settings;
  settings.turbidity = turbidity;
  settings.sun_elevation_deg = elevation;
  settings.sun_azimuth_deg = azimuth;
  settings.resolution = resolution;
  return settings;
}

// By hand from appendix A.2. T = 2, sun in the zenith: chi = (4/9 - 1/60) pi = 1.343904, tan = 4.331476,
// Y = 3.1196 * 4.331476 - 0.431 + 2.4192; x = 4 * 0 + 2 * 0.00394 + 0.25886, y = 2 * 0.00516 + 0.26688.
TEST(Sky, TheZenithHasItsTabulatedLuminanceAndChromaticity) {
  const Color3 overhead = SkyModel(2, 90).zenith();
  EXPECT_NEAR(overhead[0], 15500.7, 1);
  EXPECT_NEAR(overhead[1], 0.26674, 1e-9);
  EXPECT_NEAR(overhead[2], 0.2772, 1e-9);
  // T = 3, sun at 60 degrees to the zenith: chi = (4/9 - 1/40) pi/3 = 0.439241, tan = 0.469854,
  // Y = 7.1649 * 0.469854 - 0.6465 + 2.4192; theta = 1.047198, its square 1.096623, its cube 1.148381.
  const Color3 morning = SkyModel(3, 30).zenith();
  EXPECT_NEAR(morning[0], 5139.2, 1);
  const double x = 9 * (0.00166 * 1.148381 - 0.00375 * 1.096623 + 0.00209 * 1.047198) +
                   3 * (-0.02903 * 1.148381 + 0.06377 * 1.096623 - 0.03202 * 1.047198 + 0.00394) + 0.11693 * 1.148381 -
                   0.21196 * 1.096623 + 0.06052 * 1.047198 + 0.25886;
  EXPECT_NEAR(morning[1], x, 1e-6);
  EXPECT_NEAR(morning[1], 0.24493, 2e-5);
}

TEST(Sky, TheDistributionIsOneAtTheZenith) {
  for (const double turbidity : {2.0, 3.5, 10.0})
    for (const double elevation : {5.0, 45.0, 90.0}) {
      const SkyModel model(turbidity, elevation);
      const Color3 straight_up = model.at(1, (90 - elevation) * pi / 180);
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(straight_up[c] / model.zenith()[c], 1, 1e-12);
    }
}

TEST(Sky, IsBrightestAtTheSunBluestOppositeAndPaleAtTheHorizon) {
  const SkyModel model(2.5, 40);
  const double towards = 50 * pi / 180;
  EXPECT_GT(model.at(std::cos(towards), 0.02)[0], 3 * model.zenith()[0]);
  EXPECT_LT(model.at(std::cos(40 * pi / 180), 90 * pi / 180)[0], model.zenith()[0]);
  EXPECT_GT(model.at(0.02, 90 * pi / 180)[1], model.zenith()[1] + 0.02) << "x grows towards white";
}

// Iqbal's extraterrestrial 25503.8 W m^-2 sr^-1 nm^-1 at 550 nm, sun in the zenith, T = 2: optical mass
// 1 / (1 + 0.15 * 93.885^-1.253) = 0.99949; depths of air 0.008735 * 0.55^-4.08 = 0.10013, aerosols
// 0.0463 * 0.55^-1.3 = 0.10072, ozone 0.085 * 0.35 = 0.02975: e^-(0.2306 * 0.99949) = 0.79415.
TEST(Sun, ItsRadianceIsThatAboveTheAtmosphereLessWhatTheAirTakes) {
  const size_t green = 550 - lambda_min_nm;
  EXPECT_NEAR(sun_radiance(2, 90)[green] / 25503.8, 0.79415, 2e-4);
  // Near the horizon 26 times as much air; the red end keeps more than the blue one.
  const Samples low = sun_radiance(2, 2);
  EXPECT_LT(low[green], 0.02 * 25503.8);
  EXPECT_LT(low[450 - lambda_min_nm] / 29658.3, 0.1 * low[650 - lambda_min_nm] / 22339.8);
  // The bands of oxygen at 760 nm and of water at 720 nm stand out.
  const Samples noon = sun_radiance(2, 90);
  EXPECT_LT(noon[760 - lambda_min_nm], 0.75 * noon[755 - lambda_min_nm]);
  EXPECT_LT(noon[720 - lambda_min_nm], 0.92 * noon[710 - lambda_min_nm]);
}

// On the ground one measures 10 to 120 klx on a clear day, more the higher the sun, a tenth to a third from the sky;
// the model's sky is known to be on the bright side, the more so in haze.
TEST(Sky, LightsTheGroundAsOutdoors) {
  for (const double turbidity : {2.0, 4.0, 6.0}) {
    double last = 0;
    for (const double elevation : {10.0, 20.0, 40.0, 60.0, 90.0}) {
      const SkyImage sky = make_sky(settings_of(turbidity, elevation));
      const double total = sky.sky_illuminance[1] + sky.sun_illuminance[1];
      EXPECT_GT(total, last) << turbidity << ", " << elevation;
      if (elevation >= 20) {
        EXPECT_GT(total, 10e3) << turbidity << ", " << elevation;
      }
      EXPECT_LT(total, 145e3) << turbidity << ", " << elevation;
      last = total;
    }
    EXPECT_GT(last, 90e3);
  }
  const SkyImage noon = make_sky(settings_of(2.5, 60));
  EXPECT_GT(noon.sky_illuminance[1], 0.08 * noon.sun_illuminance[1]);
  EXPECT_LT(noon.sky_illuminance[1], 0.5 * noon.sun_illuminance[1]);
}

TEST(Sky, NoDirectionIsDarkerThanBlackOrBeyondTheGamut) {
  for (const double turbidity : {2.0, 3.0, 6.0, 10.0})
    for (const double elevation : {0.5, 5.0, 30.0, 60.0, 90.0}) {
      const SkyImage sky = make_sky(settings_of(turbidity, elevation, 130, 32));
      const size_t upper = sky.image.rgb.size() / 2;
      for (size_t i = 0; i < upper; ++i)
        ASSERT_GT(sky.image.rgb[i], 0) << turbidity << ", " << elevation << ": texel " << i / 3;
    }
}

glm::dvec3 direction_of(const Image& image, size_t texel) {
  const double theta = pi * (double(texel / image.width) + 0.5) / image.height;
  const double phi = 2 * pi * (double(texel % image.width) + 0.5) / image.width;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

TEST(Sky, TheImageIsBrightestTowardsTheSunAndHasTheModelsLuminances) {
  for (const double azimuth : {0.0, 90.0, 200.0}) {
    const SkySettings settings = settings_of(3, 35, azimuth, 128);
    const glm::dvec3 sun = sun_direction(settings);
    const double a = azimuth * pi / 180;
    EXPECT_NEAR(glm::dot(sun, glm::dvec3(std::sin(a), std::cos(a), 0)), std::cos(35 * pi / 180), 1e-12);
    const Image image = make_sky(settings).image;
    size_t brightest = 0;
    for (size_t texel = 0; texel < image.rgb.size() / 3; ++texel)
      if (image.rgb[3 * texel + 1] > image.rgb[3 * brightest + 1]) brightest = texel;
    EXPECT_GT(glm::dot(direction_of(image, brightest), sun), std::cos(3 * pi / 180));
    const SkyModel model(3, 35);
    const Matrix3& to_xyz = rgb_to_xyz(image.color_space);
    for (size_t texel = 100; texel < image.rgb.size() / 6; texel += 777) {
      const glm::dvec3 d = direction_of(image, texel);
      double luminance = 0;
      for (size_t c = 0; c < 3; ++c) luminance += to_xyz[1][c] * double{image.rgb[3 * texel + c]};
      EXPECT_NEAR(luminance / model.at(d.z, std::acos(glm::dot(d, sun)))[0], 1, 1e-5);
    }
  }
}

TEST(Sky, TheGroundReflectsWhatFallsOnIt) {
  SkySettings settings = settings_of(3, 35);
  settings.ground_albedo = 0.3;
  const SkyImage sky = make_sky(settings);
  const Matrix3& to_xyz = rgb_to_xyz(sky.image.color_space);
  double luminance = 0;
  for (size_t c = 0; c < 3; ++c) luminance += to_xyz[1][c] * double{sky.image.rgb[sky.image.rgb.size() - 3 + c]};
  EXPECT_NEAR(luminance, 0.3 / pi * (sky.sky_illuminance[1] + sky.sun_illuminance[1]), 1e-2);
  settings.has_sun = false;
  const SkyImage without = make_sky(settings);
  EXPECT_LT(without.image.rgb.back(), 0.7f * sky.image.rgb.back());
  EXPECT_EQ(without.sun_illuminance[1], 0);
}

}  // namespace
}  // namespace metamer
