#include "scenes/sky/sky.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/simd/portable_math.h"

namespace metamer {
namespace {

constexpr double pi = std::numbers::pi;
using portable::exp, portable::pow;

double radians(double degrees) { return degrees * pi / 180; }

// Perez' distribution with coefficients A to E.
double perez(const double (&c)[5], double cos_theta, double gamma, double cos_gamma) {
  return (1 + c[0] * exp(c[1] / cos_theta)) * (1 + c[2] * exp(c[3] * gamma) + c[4] * cos_gamma * cos_gamma);
}

Color3 xyz_of(const Color3& luminance_xy) {
  const Color3 unit = xyz_of_chromaticity(luminance_xy[1], luminance_xy[2]);
  return {unit[0] * luminance_xy[0], unit[1] * luminance_xy[0], unit[2] * luminance_xy[0]};
}

void store_rgb(const Color3& xyz, float* rgb) {
  const Color3 linear = multiply(xyz_to_rgb(ColorSpace::rec2020), xyz);
  for (size_t c = 0; c < 3; ++c) rgb[c] = static_cast<float>(std::max(linear[c], 0.0));
}

}  // namespace

double sun_projected_solid_angle() {
  const double sine = portable::sin(radians(sun_diameter_deg / 2));
  return pi * sine * sine;
}

glm::dvec3 sun_direction(const SkySettings& settings) {
  const double elevation = radians(settings.sun_elevation_deg), azimuth = radians(settings.sun_azimuth_deg);
  const double level = portable::cos(elevation);
  return {level * portable::sin(azimuth), level * portable::cos(azimuth), portable::sin(elevation)};
}

Samples sun_radiance(double turbidity, double sun_elevation_deg) {
  constexpr double ozone_cm = 0.35, water_cm = 2, angstrom_exponent = 1.3;
  const double angstrom_turbidity = 0.04608 * turbidity - 0.04586;
  // Relative optical mass: Kasten 1966.
  const double mass = 1 / (portable::sin(radians(sun_elevation_deg)) + 0.15 * pow(3.885 + sun_elevation_deg, -1.253));
  const Samples ozone = resample(require_embedded_data("sky/ozone"), 1, Extend::zero);
  const Samples gases = resample(require_embedded_data("sky/mixed_gases"), 1, Extend::zero);
  const Samples water = resample(require_embedded_data("sky/water_vapour"), 1, Extend::constant);
  Samples radiance = resample(require_embedded_data("sky/sun"), 1, Extend::constant);
  for (size_t i = 0; i < lambda_count; ++i) {
    const double lambda_um = 1e-3 * (lambda_min_nm + static_cast<double>(i));
    const double gas = gases[i] * mass, vapour = water[i] * water_cm * mass;
    const double depth = 0.008735 * pow(lambda_um, -4.08) * mass +
                         angstrom_turbidity * pow(lambda_um, -angstrom_exponent) * mass + ozone[i] * ozone_cm * mass +
                         1.41 * gas / pow(1 + 118.93 * gas, 0.45) + 0.2385 * vapour / pow(1 + 20.07 * vapour, 0.45);
    radiance[i] *= 10 * exp(-depth);  // 10: W cm^-2 um^-1 to W m^-2 nm^-1
  }
  return radiance;
}

SkyModel::SkyModel(double turbidity, double sun_elevation_deg) {
  const double t = turbidity, theta = radians(90 - sun_elevation_deg);
  const DataTable& distribution = require_embedded_data("sky/perez");
  for (size_t c = 0; c < 3; ++c)
    for (size_t k = 0; k < 5; ++k)
      coefficient_[c][k] = distribution.at(5 * c + k, 0) * t + distribution.at(5 * c + k, 1);
  const DataTable& y = require_embedded_data("sky/zenith_luminance");
  const double chi = (4.0 / 9 - t / 120) * (pi - 2 * theta);
  zenith_[0] = 1000 * ((y.at(0, 0) * t + y.at(0, 1)) * portable::tan(chi) + y.at(0, 2) * t + y.at(0, 3));
  const DataTable& xy = require_embedded_data("sky/zenith");
  for (size_t c = 0; c < 2; ++c) {
    const auto row = [&](size_t r) {
      return ((xy.at(r, 0) * theta + xy.at(r, 1)) * theta + xy.at(r, 2)) * theta + xy.at(r, 3);
    };
    zenith_[1 + c] = (row(3 * c) * t + row(3 * c + 1)) * t + row(3 * c + 2);
  }
  for (size_t c = 0; c < 3; ++c)
    per_distribution_[c] = zenith_[c] / perez(coefficient_[c], 1, theta, portable::cos(theta));
}

Color3 SkyModel::at(double cos_theta, double gamma) const {
  const double cos_gamma = portable::cos(gamma);
  Color3 value;
  for (size_t c = 0; c < 3; ++c) value[c] = per_distribution_[c] * perez(coefficient_[c], cos_theta, gamma, cos_gamma);
  return value;
}

SkyImage make_sky(const SkySettings& settings) {
  const SkyModel model(settings.turbidity, settings.sun_elevation_deg);
  const glm::dvec3 sun = sun_direction(settings);
  const uint32_t height = settings.resolution, width = 2 * height;
  SkyImage sky;
  sky.image.name = "sky";
  sky.image.width = width;
  sky.image.height = height;
  sky.image.color_space = ColorSpace::rec2020;
  sky.image.rgb.resize(size_t{3} * width * height);
  for (uint32_t row = 0; row < height / 2; ++row) {
    const auto angle = [&](double r) { return pi * r / height; };
    const double top = portable::sin(angle(row)), bottom = portable::sin(angle(row + 1));
    const double share = pi * (bottom * bottom - top * top) / width;  // of a texel: its solid angle times the cosine
    const double cos_theta = portable::cos(angle(row + 0.5)), sin_theta = portable::sin(angle(row + 0.5));
    for (uint32_t column = 0; column < width; ++column) {
      const double phi = 2 * pi * (column + 0.5) / width;
      const glm::dvec3 d(sin_theta * portable::cos(phi), sin_theta * portable::sin(phi), cos_theta);
      const double gamma = portable::acos(std::clamp(glm::dot(d, sun), -1.0, 1.0));
      const Color3 xyz = xyz_of(model.at(cos_theta, gamma));
      store_rgb(xyz, &sky.image.rgb[3 * (size_t{row} * width + column)]);
      for (size_t c = 0; c < 3; ++c) sky.sky_illuminance[c] += share * xyz[c];
    }
  }
  if (settings.has_sun) {
    const Color3 xyz = integrate_xyz(sun_radiance(settings.turbidity, settings.sun_elevation_deg));
    for (size_t c = 0; c < 3; ++c)
      sky.sun_illuminance[c] = luminous_efficacy * xyz[c] * sun_projected_solid_angle() * sun.z;
  }
  Color3 ground;
  for (size_t c = 0; c < 3; ++c)
    ground[c] = settings.ground_albedo / pi * (sky.sky_illuminance[c] + sky.sun_illuminance[c]);
  for (size_t texel = size_t{height} / 2 * width; texel < size_t{height} * width; ++texel)
    store_rgb(ground, &sky.image.rgb[3 * texel]);
  return sky;
}

}  // namespace metamer
