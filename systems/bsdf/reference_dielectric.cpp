// The twins of everything that light enters.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/bsdf/limits.h"
#include "systems/bsdf/reference.h"

namespace metamer::reference {
namespace {
double square(double x) { return x * x; }
double side_of(const Direction& w) { return std::signbit(w.z) ? -1.0 : 1.0; }
Direction upper(const Direction& w, double side) { return {w.x, w.y, w.z * side}; }
Direction scaled(const Direction& w, double s) { return {w.x * s, w.y * s, w.z * s}; }
double transparent(double eta, bool schlick, double cos_theta) {
  return schlick ? schlick_dielectric(eta, cos_theta) : fresnel_dielectric(eta, cos_theta);
}
double conducting(double n, double kappa, bool schlick, double cos_theta) {
  return schlick ? schlick_conductor(n, kappa, cos_theta) : fresnel_conductor(n, kappa, cos_theta);
}

// n_i / n_o seen from wo.
double relative(const DielectricOptics& optics, double side, size_t j) {
  const double eta = optics.dispersive ? optics.eta[j] : optics.eta[0];
  return side > 0 ? eta : 1 / eta;
}
bool is_matched(double eta) { return std::abs(eta - 1) < double{matched_index}; }

// The chance that the reflection of a facet is drawn with wavelength `hero` leading.
double reflection_chance(const DielectricOptics& optics, double side, size_t hero, double cos_theta) {
  const double own = transparent(relative(optics, side, hero), optics.schlick, cos_theta);
  if (!optics.dispersive || own == 1) return own;
  double sum = 0;
  for (size_t j = 0; j < 4; ++j) sum += transparent(relative(optics, side, j), optics.schlick, cos_theta);
  return sum / 4;
}
double g1(const Roughness& roughness, const Direction& w) { return 1 / (1 + ggx_lambda(roughness, w)); }
double g2(const Roughness& roughness, const Direction& o, const Direction& i) {
  return 1 / (1 + ggx_lambda(roughness, o) + ggx_lambda(roughness, i));
}
// Of a visible normal.
double facet_pdf(const Roughness& roughness, const Direction& o, const Direction& m) {
  return g1(roughness, o) / o.z * std::max(0.0, dot(o, m)) * ggx_d(roughness, m);
}
// Dupuy & Benyoub 2023, listing 3.
Direction visible_normal(const Roughness& roughness, const Direction& o, double u, double v) {
  const double ax = std::max(roughness.alpha_x, double{least_alpha});
  const double ay = std::max(roughness.alpha_y, double{least_alpha});
  const Direction w = normalize({ax * o.x, ay * o.y, o.z});
  const double phi = 2 * std::numbers::pi * u;
  const double z = (1 - v) * (1 + w.z) - w.z;
  const double r = std::sqrt(std::clamp(1 - z * z, 0.0, 1.0));
  return normalize({ax * (r * std::cos(phi) + w.x), ay * (r * std::sin(phi) + w.y), z + w.z});
}
}  // namespace

BsdfSample sample_dielectric(const Direction& wo, const DielectricOptics& optics, double u) {
  BsdfSample sample;
  sample.delta = true;
  const double side = side_of(wo), cos_theta_o = std::abs(wo.z);
  Spectrum4 f;
  for (size_t j = 0; j < 4; ++j) {
    const double eta_j = optics.dispersive ? optics.eta[j] : optics.eta[0];
    const double eta = side > 0 ? eta_j : 1 / eta_j;
    f[j] = optics.schlick ? schlick_dielectric(eta, cos_theta_o) : fresnel_dielectric(eta, cos_theta_o);
    if (!optics.opaque[j]) continue;
    f[j] = optics.schlick ? schlick_conductor(eta_j, optics.kappa[j], cos_theta_o)
                          : fresnel_conductor(eta_j, optics.kappa[j], cos_theta_o);
  }
  const bool blocked = f[0] == 1 || optics.opaque[0];
  const double p_reflect = blocked ? 1 : optics.dispersive ? (f[0] + f[1] + f[2] + f[3]) / 4 : f[0];
  const double hero_eta = side > 0 ? optics.eta[0] : 1 / optics.eta[0];
  if (u < p_reflect) {
    sample.wi = {-wo.x, -wo.y, wo.z};
    sample.pdf = p_reflect;
    for (size_t j = 0; j < 4; ++j) sample.weight[j] = f[j] / p_reflect;
    return sample;
  }
  if (!refract({-wo.x, -wo.y, -wo.z}, {0, 0, side}, hero_eta, sample.wi)) return sample;
  sample.transmitted = true;
  sample.terminate_secondary = optics.dispersive;
  sample.pdf = 1 - p_reflect;
  for (size_t j = 0; j < (optics.dispersive ? 1u : 4u); ++j) {
    sample.weight[j] = (1 - f[j]) / sample.pdf / square(hero_eta);
  }
  return sample;
}

RoughDielectricValue eval_rough_dielectric(const Direction& wo, const Roughness& roughness,
                                           const DielectricOptics& optics, const Direction& wi) {
  RoughDielectricValue value;
  const double side = side_of(wo);
  const Direction o = upper(wo, side), i = upper(wi, side);
  if (o.z <= 0 || i.z == 0) return value;
  for (size_t j = 0; j < 4; ++j) {
    const double eta = relative(optics, side, j);
    const double g = g2(roughness, o, i);
    if (i.z > 0) {
      const Direction m = normalize({o.x + i.x, o.y + i.y, o.z + i.z});
      const double c = dot(o, m);
      value.f_cos[j] = ggx_d(roughness, m) * g * transparent(eta, optics.schlick, c) / (4 * o.z);
      value.pdf[j] = facet_pdf(roughness, o, m) / (4 * c) * reflection_chance(optics, side, 0, c);
      continue;
    }
    if (is_matched(eta)) continue;
    Direction m = normalize({o.x + eta * i.x, o.y + eta * i.y, o.z + eta * i.z});
    if (m.z < 0) m = scaled(m, -1);
    const double c = dot(o, m), t = dot(i, m);
    if (c <= 0 || t >= 0) continue;
    const double f = transparent(eta, optics.schlick, c);
    if (f == 1) continue;
    const double jacobian = eta * eta * std::abs(t) / square(c + eta * t);
    value.f_cos[j] = ggx_d(roughness, m) * g * (1 - f) * c * jacobian / (o.z * eta * eta);
    value.pdf[j] = facet_pdf(roughness, o, m) * jacobian * (1 - reflection_chance(optics, side, j, c));
  }
  return value;
}

BsdfSample sample_rough_dielectric(const Direction& wo, const Roughness& roughness, const DielectricOptics& optics,
                                   double choice, double u, double v) {
  BsdfSample sample;
  const double side = side_of(wo);
  const Direction o = upper(wo, side);
  if (o.z <= 0) return sample;
  const double eta = relative(optics, side, 0);
  const Direction m = visible_normal(roughness, o, u, v);
  const double p_reflect = reflection_chance(optics, side, 0, dot(o, m));
  if (choice < p_reflect) {
    const Direction i = reflect(scaled(o, -1), m);
    sample.wi = upper(i, side);
    if (i.z <= 0) return sample;
    const RoughDielectricValue value = eval_rough_dielectric(wo, roughness, optics, sample.wi);
    sample.pdf = value.pdf[0];
    for (size_t j = 0; j < 4; ++j) sample.weight[j] = value.f_cos[j] / sample.pdf;
    return sample;
  }
  sample.transmitted = true;
  sample.terminate_secondary = optics.dispersive;
  if (is_matched(eta)) {
    sample.wi = scaled(wo, -1);
    sample.delta = true;
    sample.pdf = 1 - p_reflect;
    const double passes = (1 - transparent(eta, optics.schlick, dot(o, m))) / sample.pdf / square(eta);
    for (size_t j = 0; j < (optics.dispersive ? 1u : 4u); ++j) sample.weight[j] = passes;
    return sample;
  }
  Direction i;
  if (!refract(scaled(o, -1), m, eta, i)) return sample;
  sample.wi = upper(i, side);
  if (i.z >= 0) return sample;
  const RoughDielectricValue value = eval_rough_dielectric(wo, roughness, optics, sample.wi);
  sample.pdf = value.pdf[0];
  for (size_t j = 0; j < (optics.dispersive ? 1u : 4u); ++j) sample.weight[j] = value.f_cos[j] / sample.pdf;
  return sample;
}

ThinShares thin_shares(const ThinOptics& optics, size_t j, double cos_theta) {
  const double eta = optics.eta[j];
  if (optics.opaque[j]) return {conducting(eta, optics.kappa[j], optics.schlick, cos_theta), 0};
  const double f = transparent(eta, optics.schlick, cos_theta), c = cos_transmitted(eta, cos_theta);
  if (f == 1) return {1, 0};
  const double t = optics.optical_depth[j] == 0 ? 1 : c == 0 ? 0 : std::exp(-optics.optical_depth[j] / c);
  // Reflection after reflection, until nothing is left inside.
  ThinShares shares{f, 0};
  double inside = 1 - f;
  for (bool towards_back = true; inside > 1e-9; towards_back = !towards_back) {
    inside *= t;
    (towards_back ? shares.transmitted : shares.reflected) += inside * (1 - f);
    inside *= f;
  }
  return shares;
}

BsdfSample sample_thin(const Direction& wo, const ThinOptics& optics, double u) {
  BsdfSample sample;
  sample.delta = true;
  const double cos_theta = std::abs(wo.z);
  double reflected = 0, transmitted = 0;
  for (size_t j = 0; j < (optics.companions ? 4u : 1u); ++j) {
    reflected += thin_shares(optics, j, cos_theta).reflected;
    transmitted += thin_shares(optics, j, cos_theta).transmitted;
  }
  if (!(reflected + transmitted > 0)) return sample;
  const double p_reflect = reflected / (reflected + transmitted);
  sample.transmitted = u >= p_reflect;
  sample.pdf = sample.transmitted ? 1 - p_reflect : p_reflect;
  sample.wi = sample.transmitted ? scaled(wo, -1) : Direction{-wo.x, -wo.y, wo.z};
  for (size_t j = 0; j < 4; ++j) {
    const ThinShares shares = thin_shares(optics, j, cos_theta);
    sample.weight[j] = (sample.transmitted ? shares.transmitted : shares.reflected) / sample.pdf;
  }
  return sample;
}

}  // namespace metamer::reference
