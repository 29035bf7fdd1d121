#include "systems/bsdf/reference_hair.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace metamer::reference {
namespace {
constexpr double pi = std::numbers::pi;

// M_p by its definition; the modified Bessel function is the standard library's, scaled where it would overflow.
double longitudinal(double theta_i, double theta_o, double v) {
  const double a = std::cos(theta_i) * std::cos(theta_o) / v, b = std::sin(theta_i) * std::sin(theta_o) / v;
  const double log_bessel = a < 500 ? std::log(std::cyl_bessel_i(0.0, a))
                                    : a - 0.5 * std::log(2 * pi * a) + std::log1p(1 / (8 * a) + 9 / (128 * a * a));
  return std::exp(log_bessel - b - 1 / v) / (v * (1 - std::exp(-2 / v)));
}

double cdf(double x, double s) { return 1 / (1 + std::exp(-x / s)); }

struct Path {
  double theta, variance, turn, share;
  Spectrum4 attenuation;
  bool even;  // all around the fibre
};
std::array<Path, 4> paths(const Direction& wo, const HairOptics& o) {
  std::array<Path, 4> result{};
  const double theta_o = std::asin(std::clamp(wo.x, -1.0, 1.0)), gamma_o = std::asin(o.h);
  const double theta_t = std::asin(std::sin(theta_o) / o.eta);
  const double across = std::sqrt(o.eta * o.eta - std::pow(std::sin(theta_o), 2)) / std::cos(theta_o);
  const double gamma_t = std::asin(o.h / across);
  const double f = fresnel_dielectric(o.eta, std::cos(theta_o) * std::cos(gamma_o));
  double sum = 0;
  for (size_t p = 0; p < 4; ++p) {
    Path& path = result[p];
    for (size_t j = 0; j < 4; ++j) {
      const double t = std::exp(-o.sigma_a[j] * 2 * std::cos(gamma_t) / std::cos(theta_t));
      const double one = (1 - f) * (1 - f) * t;
      path.attenuation[j] = p == 0 ? f : p == 1 ? one : p == 2 ? one * t * f : one * t * f * t * f / (1 - t * f);
      path.share += path.attenuation[j];
    }
    sum += path.share;
    const double tilt = std::asin(o.shape.sin_tilt[0]);
    const double by = p == 0 ? -2 * tilt : p == 1 ? tilt : p == 2 ? 4 * tilt : 0;
    // The cosine of a direction turned past the fibre's axis counts as positive.
    path.theta = std::atan2(std::sin(theta_o + by), std::abs(std::cos(theta_o + by)));
    path.variance = o.shape.variance * (p == 0 ? 1 : p == 1 ? 0.25 : 4);
    path.turn = 2 * double(p) * gamma_t - 2 * gamma_o + double(p) * pi;
    path.even = p == 3;
  }
  for (Path& path : result) path.share /= sum;
  return result;
}

}  // namespace

BsdfValue eval_hair(const Direction& wo, const HairOptics& o, const Direction& wi) {
  BsdfValue value;
  const double theta_i = std::asin(std::clamp(wi.x, -1.0, 1.0));
  const double phi = std::atan2(wi.z, wi.y) - std::atan2(wo.z, wo.y), s = o.shape.width;
  for (const Path& path : paths(wo, o)) {
    const double x = std::remainder(phi - path.turn, 2 * pi);
    const double logistic = std::exp(-std::abs(x) / s) / (s * std::pow(1 + std::exp(-std::abs(x) / s), 2));
    const double around = path.even ? 1 / (2 * pi) : logistic / (cdf(pi, s) - cdf(-pi, s));
    const double both = longitudinal(theta_i, path.theta, path.variance) * around;
    for (size_t j = 0; j < 4; ++j) value.f_cos[j] += both * path.attenuation[j];
    value.pdf += both * path.share;
  }
  return value;
}

BsdfSample sample_hair(const Direction& wo, const HairOptics& o, double choice, double u, double v) {
  const std::array<Path, 4> all = paths(wo, o);
  size_t p = 0;
  double before = 0;
  while (p < 3 && choice >= before + all[p].share) before += all[p++].share;
  const double left = std::clamp((choice - before) / all[p].share, 0.0, 0.9999999), s = o.shape.width;
  double turn = 2 * pi * left;
  if (!all[p].even) {
    const double q = std::clamp(left * (cdf(pi, s) - cdf(-pi, s)) + cdf(-pi, s), 1e-7, 0.9999999);
    turn = all[p].turn + std::clamp(-s * std::log(1 / q - 1), -pi, pi);
  }
  const double variance = all[p].variance;
  const double cos_theta =
      std::clamp(1 + variance * std::log(std::max(u, 1e-5) + (1 - u) * std::exp(-2 / variance)), -1.0, 1.0);
  const double sin_theta = std::sqrt(1 - cos_theta * cos_theta);
  const double sin_i = std::clamp(
      -cos_theta * std::sin(all[p].theta) + sin_theta * std::cos(2 * pi * v) * std::cos(all[p].theta), -1.0, 1.0);
  const double cos_i = std::sqrt(1 - sin_i * sin_i), phi = std::atan2(wo.z, wo.y) + turn;
  BsdfSample sample;
  sample.wi = {sin_i, cos_i * std::cos(phi), cos_i * std::sin(phi)};
  const BsdfValue value = eval_hair(wo, o, sample.wi);
  if (!(value.pdf > 0)) return sample;
  sample.pdf = value.pdf;
  for (size_t j = 0; j < 4; ++j) sample.weight[j] = value.f_cos[j] / value.pdf;
  return sample;
}

}  // namespace metamer::reference
