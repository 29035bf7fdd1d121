#include "systems/tone_curve.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace metamer {
namespace {

constexpr std::array<std::string_view, tone_curve_count> names = {"linear", "reinhard", "reinhard-extended",
                                                                  "hable",  "filmic",   "agx"};

struct HableCurve {
  double A = 0.15, B = 0.5, C = 0.1, D = 0.2, E = 0.02, F = 0.3, white = 11.2, bias = 2.0;
};

struct AgxCurve {
  double least = -12.47393, most = 4.026069;  // log2
  double polynomial[7] = {-0.00232, 0.1191, 0.4298, -6.868, 31.96, -40.14, 15.5};
  Matrix3 inset = {{{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                    {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                    {0.0423756549057051, 0.0784336, 0.879142973793104}}};
  Matrix3 outset = {{{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                     {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                     {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}}};
};

double hable_fraction(double x) {
  const HableCurve h;
  return (x * (h.A * x + h.C * h.B) + h.D * h.E) / (x * (h.A * x + h.B) + h.D * h.F) - h.E / h.F;
}

double hable(double x) {
  const HableCurve h;
  return hable_fraction(h.bias * std::max(x, 0.0)) / hable_fraction(h.white);
}

double filmic(double x) {
  const double y = std::max(0.0, x - 0.004);
  return std::pow(y * (6.2 * y + 0.5) / (y * (6.2 * y + 1.7) + 0.06), 2.2);
}

double agx_contrast(double x) {
  const AgxCurve agx;
  const double log2 = std::clamp(std::log2(std::max(x, 1e-30)), agx.least, agx.most);
  const double t = (log2 - agx.least) / (agx.most - agx.least);
  double sum = 0;
  for (size_t i = 7; i-- > 0;) sum = sum * t + agx.polynomial[i];
  return sum;
}

// Between two displays, exactly the identity from one to itself.
Matrix3 conversion(ColorSpace from, ColorSpace to) {
  if (from == to) return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  return multiply(xyz_to_rgb(to), rgb_to_xyz(from));
}

Color3 agx(ColorSpace display, const Color3& rgb) {
  const AgxCurve constants;
  const Matrix3 to_srgb = conversion(display, ColorSpace::srgb);
  Color3 color = multiply(to_srgb, rgb);
  for (double& v : color) v = std::max(v, 0.0);
  color = multiply(constants.inset, color);
  for (double& v : color) v = agx_contrast(v);
  color = multiply(constants.outset, color);
  for (double& v : color) v = std::pow(std::max(v, 0.0), 2.2);
  return multiply(conversion(ColorSpace::srgb, display), color);
}

void store(const Matrix3& m, float (&row_major)[9]) {
  for (size_t i = 0; i < 9; ++i) row_major[i] = static_cast<float>(m[i / 3][i % 3]);
}

}  // namespace

std::span<const std::string_view> tone_curve_names() { return names; }
std::string_view tone_curve_name(ToneCurve curve) { return names[static_cast<size_t>(curve)]; }

Color3 tone_curve_scalar(ToneCurve curve, ColorSpace display, const Color3& rgb, double reinhard_white) {
  Color3 mapped = rgb;
  const double luminance = std::max(multiply(rgb_to_xyz(display), rgb)[1], 0.0);
  const double white_squared = reinhard_white * reinhard_white;
  switch (curve) {
    case ToneCurve::linear: break;
    case ToneCurve::reinhard:
      for (double& v : mapped) v /= 1 + luminance;
      break;
    case ToneCurve::reinhard_extended:
      for (double& v : mapped) v *= (1 + luminance / white_squared) / (1 + luminance);
      break;
    case ToneCurve::hable:
      for (double& v : mapped) v = hable(v);
      break;
    case ToneCurve::filmic:
      for (double& v : mapped) v = filmic(v);
      break;
    case ToneCurve::agx: return agx(display, rgb);
  }
  return mapped;
}

ToneConstants tone_constants(ColorSpace display, float reinhard_white) {
  ToneConstants c;
  for (size_t i = 0; i < 3; ++i) c.luminance[i] = static_cast<float>(rgb_to_xyz(display)[1][i]);
  c.reinhard_inverse_white_squared = static_cast<float>(1 / (double{reinhard_white} * double{reinhard_white}));
  // f(y) = (A y^2 + C B y + D E) / (A y^2 + B y + D F) - E / F: the constant parts cancel on one denominator.
  const HableCurve h;
  const double scale = 1 / hable_fraction(h.white), toe = h.E / h.F;
  c.hable_bias = static_cast<float>(h.bias);
  c.hable_a = static_cast<float>(h.A);
  c.hable_b = static_cast<float>(h.B);
  c.hable_df = static_cast<float>(h.D * h.F);
  c.hable_square = static_cast<float>(scale * (1 - toe));
  c.hable_linear = static_cast<float>(scale * (h.C * h.B - toe * h.B));
  const AgxCurve agx;
  c.agx_least = static_cast<float>(agx.least);
  c.agx_most = static_cast<float>(agx.most);
  c.agx_scale = static_cast<float>(1 / (agx.most - agx.least));
  for (size_t i = 0; i < 7; ++i) c.agx_polynomial[i] = static_cast<float>(agx.polynomial[i]);
  store(agx.inset, c.agx_inset);
  store(agx.outset, c.agx_outset);
  store(conversion(display, ColorSpace::srgb), c.to_srgb);
  store(conversion(ColorSpace::srgb, display), c.from_srgb);
  return c;
}

}  // namespace metamer
