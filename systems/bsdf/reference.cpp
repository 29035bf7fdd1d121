#include "systems/bsdf/reference.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "engine/sampling/warps.h"
#include "systems/bsdf/limits.h"

namespace metamer::reference {
namespace {
constexpr double pi = std::numbers::pi;

double square(double x) { return x * x; }
double schlick_curve(double f0, double cos_theta) { return f0 + (1 - f0) * std::pow(1 - cos_theta, 5); }
bool totally_reflected(double eta, double cos_theta_i) { return eta < 1 && 1 - square(cos_theta_i) > eta * eta; }
Direction upper(const Direction& w, double side) { return {w.x, w.y, w.z * side}; }
double side_of(const Direction& w) { return std::signbit(w.z) ? -1.0 : 1.0; }
Roughness raised(const Roughness& roughness) {
  return {std::max(roughness.alpha_x, double{least_alpha}), std::max(roughness.alpha_y, double{least_alpha})};
}
Spectrum4 reflectance(const ConductorOptics& optics, double cos_theta) {
  Spectrum4 f;
  for (size_t j = 0; j < 4; ++j) {
    f[j] = optics.schlick ? schlick_conductor(optics.n[j], optics.kappa[j], cos_theta)
                          : fresnel_conductor(optics.n[j], optics.kappa[j], cos_theta);
  }
  return f;
}
double glossy_share(const RoughOptics& optics) {
  const double weight = optics.normalized ? 1 : 8 / (optics.shininess + 2);
  double kd = 0, glossy = 0;
  for (size_t j = 0; j < 4; ++j) kd += optics.kd[j], glossy += weight * optics.ks[j];
  return glossy > 0 ? glossy / (kd + glossy) : 0;
}
}  // namespace

double dot(const Direction& a, const Direction& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Direction normalize(const Direction& v) {
  const double length = std::sqrt(dot(v, v));
  return {v.x / length, v.y / length, v.z / length};
}

Direction reflect(const Direction& v, const Direction& n) {
  const double cos_alpha = -dot(v, n);
  return {v.x + 2 * n.x * cos_alpha, v.y + 2 * n.y * cos_alpha, v.z + 2 * n.z * cos_alpha};
}

bool refract(const Direction& v, const Direction& n, double eta, Direction& t) {
  const double cos_alpha = -dot(v, n);
  const double radicand = 1 - (1 - square(cos_alpha)) / square(eta);
  if (radicand < 0) return false;
  const double k = cos_alpha / eta - std::sqrt(radicand);
  t = {v.x / eta + n.x * k, v.y / eta + n.y * k, v.z / eta + n.z * k};
  return true;
}

double cos_transmitted(double eta, double cos_theta_i) {
  return std::sqrt(std::max(0.0, 1 - (1 - square(cos_theta_i)) / square(eta)));
}

Polarised fresnel_dielectric_polarised(double eta, double cos_theta_i) {
  if (totally_reflected(eta, cos_theta_i)) return {1, 1};
  if (eta == 1) return {0, 0};
  const double c = cos_theta_i, ct = cos_transmitted(eta, c);
  return {square((c - eta * ct) / (c + eta * ct)), square((eta * c - ct) / (eta * c + ct))};
}

double fresnel_dielectric(double eta, double cos_theta_i) {
  const Polarised r = fresnel_dielectric_polarised(eta, cos_theta_i);
  return (r.s + r.p) / 2;
}

double schlick_dielectric(double eta, double cos_theta_i) {
  if (totally_reflected(eta, cos_theta_i)) return 1;
  const double cos_thin = eta < 1 ? cos_transmitted(eta, cos_theta_i) : cos_theta_i;
  return schlick_curve(square((eta - 1) / (eta + 1)), cos_thin);
}

double fresnel_conductor(double n, double kappa, double cos_theta_i) {
  using Complex = std::complex<double>;
  const Complex eta(n, kappa);
  const Complex eta_cos_t = std::sqrt(eta * eta - (1 - square(cos_theta_i)));
  const Complex c = cos_theta_i;
  const Complex r_s = (c - eta_cos_t) / (c + eta_cos_t);
  const Complex r_p = (eta * eta * c - eta_cos_t) / (eta * eta * c + eta_cos_t);
  return (std::norm(r_s) + std::norm(r_p)) / 2;
}

double schlick_conductor(double n, double kappa, double cos_theta_i) {
  const double f0 = (square(n - 1) + square(kappa)) / (square(n + 1) + square(kappa));
  if (n >= 1 || kappa >= double{refracting_kappa}) return schlick_curve(f0, cos_theta_i);
  if (totally_reflected(n, cos_theta_i)) return 1;
  return schlick_curve(f0, cos_transmitted(n, cos_theta_i));
}

BsdfValue eval_diffuse(const Direction& wo, const Spectrum4& albedo, const Direction& wi) {
  BsdfValue value;
  if (wo.z * wi.z <= 0) return value;
  value.pdf = std::abs(wi.z) / pi;
  for (size_t j = 0; j < 4; ++j) value.f_cos[j] = albedo[j] / pi * std::abs(wi.z);
  return value;
}

BsdfSample sample_diffuse(const Direction& wo, const Spectrum4& albedo, double u, double v) {
  BsdfSample sample;
  const PointD3 up = warps::cosine_hemisphere(u, v);
  sample.wi = {up.x, up.y, up.z * side_of(wo)};
  sample.pdf = warps::cosine_hemisphere_pdf(up.z);
  if (sample.pdf > 0) sample.weight = albedo;
  return sample;
}

namespace {
double sheet_share(const SheetOptics& optics) {
  double reflected = 0, all = 0;
  for (size_t j = 0; j < 4; ++j) {
    reflected += optics.reflectance[j];
    all += optics.reflectance[j] + optics.transmittance[j];
  }
  return all > 0 ? reflected / all : 0;
}
}  // namespace

BsdfValue eval_sheet(const Direction& wo, const SheetOptics& optics, const Direction& wi) {
  BsdfValue value;
  if (wo.z * wi.z == 0) return value;
  const bool reflects = wo.z * wi.z > 0;
  const double share = sheet_share(optics);
  value.pdf = std::abs(wi.z) / pi * (reflects ? share : 1 - share);
  const Spectrum4& albedo = reflects ? optics.reflectance : optics.transmittance;
  for (size_t j = 0; j < 4; ++j) value.f_cos[j] = albedo[j] / pi * std::abs(wi.z);
  return value;
}

BsdfSample sample_sheet(const Direction& wo, const SheetOptics& optics, double choice, double u, double v) {
  BsdfSample sample;
  const double share = sheet_share(optics);
  const PointD3 up = warps::cosine_hemisphere(u, v);
  sample.transmitted = choice >= share;
  sample.wi = {up.x, up.y, up.z * side_of(wo) * (sample.transmitted ? -1 : 1)};
  const double probability = sample.transmitted ? 1 - share : share;
  sample.pdf = warps::cosine_hemisphere_pdf(up.z) * probability;
  if (!(sample.pdf > 0)) return sample;
  for (size_t j = 0; j < 4; ++j)
    sample.weight[j] = (sample.transmitted ? optics.transmittance : optics.reflectance)[j] / probability;
  return sample;
}

BsdfValue eval_rough(const Direction& wo, const RoughOptics& optics, const Direction& wi) {
  BsdfValue value;
  if (wo.z * wi.z <= 0) return value;
  const double s = optics.shininess, share = glossy_share(optics);
  const double cos_i = std::abs(wi.z), cos_o = std::abs(wo.z);
  // wi + wo = 2 cos(theta_d) H for unit vectors. dot(wo, H) would blow up what a float's direction lacks of length 1.
  const Direction sum = {wo.x + wi.x, wo.y + wi.y, wo.z + wi.z};
  const double cos_d = std::sqrt(dot(sum, sum)) / 2, cos_delta = std::abs(sum.z) / (2 * cos_d);
  for (size_t j = 0; j < 4; ++j) {
    const double f = optics.kd[j] / pi +
                     optics.ks[j] * (s + 1) / (8 * pi) * std::pow(cos_delta, s) / (cos_d * std::max(cos_i, cos_o));
    value.f_cos[j] = optics.normalized ? f * cos_i : optics.kd[j] * cos_i + optics.ks[j] * std::pow(cos_delta, s);
  }
  const double pdf_half_vector = (s + 1) / (2 * pi) * std::pow(cos_delta, s);
  value.pdf = share * pdf_half_vector / (4 * cos_d) + (1 - share) * cos_i / pi;
  return value;
}

BsdfSample sample_rough(const Direction& wo, const RoughOptics& optics, double choice, double u, double v) {
  BsdfSample sample;
  const double side = side_of(wo);
  const Direction o = upper(wo, side);
  if (choice < glossy_share(optics)) {
    const double cos_delta = std::pow(1 - u, 1 / (optics.shininess + 1));
    const double sin_delta = std::sqrt(std::max(0.0, 1 - square(cos_delta)));
    const Direction h = {sin_delta * std::cos(2 * pi * v), sin_delta * std::sin(2 * pi * v), cos_delta};
    sample.wi = upper(reflect({-o.x, -o.y, -o.z}, h), side);
  } else {
    const PointD3 p = warps::cosine_hemisphere(u, v);
    sample.wi = upper({p.x, p.y, p.z}, side);
  }
  const BsdfValue value = eval_rough(wo, optics, sample.wi);
  if (!(value.pdf > 0)) return sample;
  sample.pdf = value.pdf;
  for (size_t j = 0; j < 4; ++j) sample.weight[j] = value.f_cos[j] / value.pdf;
  return sample;
}

bool is_smooth(const Roughness& roughness) {
  return std::max(roughness.alpha_x, roughness.alpha_y) < double{smooth_alpha};
}

double ggx_d(const Roughness& roughness, const Direction& m) {
  const auto [ax, ay] = raised(roughness);
  return 1 / (pi * ax * ay * square(square(m.x / ax) + square(m.y / ay) + square(m.z)));
}

double ggx_lambda(const Roughness& roughness, const Direction& w) {
  const auto [ax, ay] = raised(roughness);
  return (std::sqrt(1 + (square(ax * w.x) + square(ay * w.y)) / square(w.z)) - 1) / 2;
}

BsdfValue eval_conductor(const Direction& wo, const Roughness& roughness, const ConductorOptics& optics,
                         const Direction& wi) {
  BsdfValue value;
  if (wo.z * wi.z <= 0 || is_smooth(roughness)) return value;
  const Direction o = upper(wo, side_of(wo)), i = upper(wi, side_of(wo));
  const Direction m = normalize({o.x + i.x, o.y + i.y, o.z + i.z});
  const double lambda_o = ggx_lambda(roughness, o), lambda_i = ggx_lambda(roughness, i);
  const double d = ggx_d(roughness, m), g = 1 / (1 + lambda_o + lambda_i), g1 = 1 / (1 + lambda_o);
  const Spectrum4 f = reflectance(optics, dot(o, m));
  for (size_t j = 0; j < 4; ++j) value.f_cos[j] = d * g * f[j] / (4 * o.z);
  value.pdf = d * g1 / (4 * o.z);
  return value;
}

BsdfSample sample_conductor(const Direction& wo, const Roughness& roughness, const ConductorOptics& optics, double u,
                            double v) {
  BsdfSample sample;
  const double side = side_of(wo);
  if (is_smooth(roughness)) {
    sample.wi = {-wo.x, -wo.y, wo.z};
    sample.delta = true;
    if (wo.z == 0) return sample;
    sample.weight = reflectance(optics, std::abs(wo.z));
    sample.pdf = 1;
    return sample;
  }
  // Dupuy & Benyoub 2023, listing 3: the directions that see the hemisphere are a spherical cap.
  const auto [ax, ay] = raised(roughness);
  const Direction o = upper(wo, side);
  const Direction w = normalize({ax * o.x, ay * o.y, o.z});
  const double phi = 2 * pi * u;
  const double z = (1 - v) * (1 + w.z) - w.z;
  const double r = std::sqrt(std::clamp(1 - z * z, 0.0, 1.0));
  const Direction h = {r * std::cos(phi) + w.x, r * std::sin(phi) + w.y, z + w.z};
  const Direction m = normalize({ax * h.x, ay * h.y, h.z});
  const Direction i = reflect({-o.x, -o.y, -o.z}, m);
  sample.wi = upper(i, side);
  const BsdfValue value = eval_conductor(wo, roughness, optics, sample.wi);
  if (value.pdf <= 0) return sample;
  sample.pdf = value.pdf;
  for (size_t j = 0; j < 4; ++j) sample.weight[j] = value.f_cos[j] / value.pdf;
  return sample;
}

}  // namespace metamer::reference
