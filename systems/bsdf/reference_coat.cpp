#include "systems/bsdf/reference_coat.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/sampling/warps.h"

namespace metamer::reference {
namespace {
constexpr double pi = std::numbers::pi;

double fresnel(const CoatOptics& optics, double eta, double cos_theta) {
  return optics.schlick ? schlick_dielectric(eta, cos_theta) : fresnel_dielectric(eta, cos_theta);
}

// A column of the table between two rows.
double between_rows(const CoatOptics& optics, double eta, size_t column) {
  const double x = std::clamp((eta - optics.rows.eta_least) * optics.rows.rows_per_eta, 0.0,
                              static_cast<double>(optics.rows.last_pair) + 1);
  const size_t pair = std::min<size_t>(static_cast<size_t>(x), optics.rows.last_pair);
  const float* low = optics.table + optics.rows.first + pair * optics.rows.stride + column;
  return std::lerp(double{low[0]}, double{low[optics.rows.stride]}, x - static_cast<double>(pair));
}

// What the body reflects of what enters, (1 - E_mean) included.
double body_albedo(const CoatOptics& optics, size_t j) {
  const double inside = 1 - (1 - coat_surface_average(optics, optics.eta[j])) / (optics.eta[j] * optics.eta[j]);
  const double again = std::clamp(optics.albedo[j] * inside, 0.0, 1.0);
  const double missing = optics.hits < 0 ? 0 : std::pow(again, optics.hits);
  return optics.albedo[j] * (1 - inside) / (1 - optics.albedo[j] * inside) * (1 - missing);
}

double surface_share(const CoatOptics& optics, double cos_o) {
  double surface = 0, body = 0;
  for (size_t j = 0; j < 4; ++j) {
    const double enters = coat_entry(optics, optics.eta[j], cos_o);
    surface += 1 - enters;
    body += enters * body_albedo(optics, j);
  }
  return surface + body > 0 ? surface / (surface + body) : 0;
}

}  // namespace

double coat_surface_average(const CoatOptics& optics, double eta) { return between_rows(optics, eta, 0); }

double coat_surface_albedo(const CoatOptics& optics, double eta, double cos_theta) {
  if (optics.alpha == 0) return fresnel(optics, eta, cos_theta);
  const double x = std::pow(cos_theta, 0.25) * (coat_nodes - 1);
  const size_t node = std::min<size_t>(static_cast<size_t>(x), coat_nodes - 2);
  return std::lerp(between_rows(optics, eta, 1 + node), between_rows(optics, eta, 2 + node),
                   x - static_cast<double>(node));
}

double coat_entry(const CoatOptics& optics, double eta, double cos_theta) {
  const double enters = 1 - coat_surface_albedo(optics, eta, cos_theta);
  if (optics.alpha > 0 || optics.thickness == 0) return enters;
  const double cos_inside = cos_transmitted(eta, cos_theta);
  return cos_inside > 0 ? enters * std::exp(-optics.thickness / cos_inside) : 0;
}

BsdfValue eval_coated(const Direction& wo, const CoatOptics& optics, const Direction& wi) {
  BsdfValue value;
  if (wo.z * wi.z <= 0) return value;
  const double cos_i = std::min(1.0, std::abs(wi.z)), cos_o = std::min(1.0, std::abs(wo.z));
  const double share = surface_share(optics, cos_o);
  value.pdf = (1 - share) * cos_i / pi;
  for (size_t j = 0; j < 4; ++j) {
    const double eta = optics.eta[j], leaves = 1 - coat_surface_average(optics, eta);
    value.f_cos[j] = coat_entry(optics, eta, cos_i) * coat_entry(optics, eta, cos_o) * body_albedo(optics, j) /
                     (pi * leaves) * cos_i;
  }
  if (optics.alpha == 0) return value;
  const Roughness roughness{optics.alpha, optics.alpha_y};
  const Direction o = {wo.x, wo.y, cos_o}, i = {wi.x, wi.y, cos_i};
  const Direction m = normalize({o.x + i.x, o.y + i.y, o.z + i.z});
  const double lambda_o = ggx_lambda(roughness, o), lambda_i = ggx_lambda(roughness, i);
  const double d = ggx_d(roughness, m), g = 1 / (1 + lambda_o + lambda_i), g1 = 1 / (1 + lambda_o);
  for (size_t j = 0; j < 4; ++j) value.f_cos[j] += d * g * fresnel(optics, optics.eta[j], dot(o, m)) / (4 * o.z);
  value.pdf += share * d * g1 / (4 * o.z);
  return value;
}

BsdfSample sample_coated(const Direction& wo, const CoatOptics& optics, double choice, double u, double v) {
  BsdfSample sample;
  const double side = std::signbit(wo.z) ? -1 : 1, cos_o = std::min(1.0, std::abs(wo.z));
  const double share = surface_share(optics, cos_o);
  const bool surface = choice < share;
  if (surface && optics.alpha == 0) {
    sample.wi = {-wo.x, -wo.y, wo.z};
    sample.delta = true;
    if (wo.z == 0) return sample;
    sample.pdf = share;
    for (size_t j = 0; j < 4; ++j) sample.weight[j] = fresnel(optics, optics.eta[j], cos_o) / share;
    return sample;
  }
  if (surface) {
    sample.wi = sample_conductor(wo, {optics.alpha, optics.alpha_y}, {}, u, v).wi;
  } else {
    const PointD3 p = warps::cosine_hemisphere(u, v);
    sample.wi = {p.x, p.y, p.z * side};
  }
  const BsdfValue value = eval_coated(wo, optics, sample.wi);
  if (!(value.pdf > 0)) return sample;
  sample.pdf = value.pdf;
  for (size_t j = 0; j < 4; ++j) sample.weight[j] = value.f_cos[j] / value.pdf;
  return sample;
}

}  // namespace metamer::reference
