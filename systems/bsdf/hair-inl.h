// Hair: light scattered by a rough dielectric fibre that absorbs inside, four wavelengths at a time. Chiang, Bitterli,
// Tappan, Burley, "A Practical and Controllable Hair and Fur Model for Production Path Tracing", Computer Graphics
// Forum 35(2), 2016, in the form of pbrt-v4 (Pharr, "The Implementation of a Hair Scattering Model", 2016).
//
// Directions are unit vectors in a frame whose x runs along the fibre: sin(theta) = w.x, phi = atan2(w.z, w.y). h in
// [-1, 1] is where across the fibre light meets it, gamma its angle there: sin(gamma_o) = h. Light leaves after p ways
// through the fibre, p = 0 reflected, 1 through it, 2 once reflected inside, 3 all others:
//
//   f_cos = sum over p of M_p(theta_o, theta_i) A_p N_p(phi_i - phi_o)
//
// M_p along the fibre (d'Eon et al., Eurographics 2011, equation 7) for scales tilted by `tilt`, A_p the share of
// light, N_p around it, a logistic distribution of width s. Each of M and N integrates to 1, and without absorption so
// does the sum of A_p: the integral of f_cos over the sphere is then 1. The model is not reciprocal. All directions of
// the sphere are scattered to; the pdf has the mean A_p of the wavelengths in place of A_p. Double twin:
// reference_hair.h.
#if defined(METAMER_SYSTEMS_BSDF_HAIR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_HAIR_INL_H_
#undef METAMER_SYSTEMS_BSDF_HAIR_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_HAIR_INL_H_
#endif

#include "engine/simd/math-inl.h"
#include "engine/simd/vec3-inl.h"
#include "systems/bsdf/fresnel-inl.h"
#include "systems/bsdf/hair.h"
#include "systems/bsdf/local-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Of a fibre: HairShape of each lane, and absorption per radius.
struct HairOptics {
  VF h, eta, sigma_a[4];
  VF variance;                  // of M_0; those of M_1 and M_2, M_3 are a quarter and four times that
  VF width;                     // s
  VF sin_tilt[3], cos_tilt[3];  // of the tilt, twice and four times it
};

struct HairView {
  VF sin_o, cos_o, phi_o;  // theta_o
  VF gamma_o, gamma_t;
  VF attenuation[4][4];             // A_p of each wavelength
  VF share[4];                      // the chance of each p
  VF tilted_sin[3], tilted_cos[3];  // theta_o as the tilt changes it for each p
};

namespace bsdf_detail {

HWY_INLINE VF asin(VF x) { return hn::Sub(splat(0.5f * pi), acos(x)); }

// I_0(x) for x <= 12, the first terms of its series.
HWY_INLINE VF bessel_series(VF x) {
  const VF y = hn::Mul(splat(0.25f), hn::Mul(x, x));
  VF term = splat(1.0f), sum = splat(1.0f);
  for (int i = 1; i < hair_series_terms; ++i) {
    term = hn::Mul(term, hn::Mul(y, splat(1.0f / static_cast<float>(i * i))));
    sum = hn::Add(sum, term);
  }
  return sum;
}
HWY_INLINE VF log_bessel(VF x) {
  const VF inverse = hn::Div(splat(1.0f), hn::Max(x, splat(1.0f)));
  const VF root = hn::Mul(splat(0.5f), hn::Sub(log(inverse), splat(1.83787707f)));  // 1 / sqrt(2 pi x)
  const VF tail = hn::Mul(inverse, hn::MulAdd(splat(0.0625f), inverse, splat(0.125f)));
  const VF large = hn::Add(x, hn::Add(root, tail));
  return hn::IfThenElse(hn::Gt(x, splat(12.0f)), large, log(bessel_series(hn::Min(x, splat(12.0f)))));
}

// M_p per cos(theta) d theta, of variance v.
HWY_INLINE VF longitudinal(VF cos_i, VF cos_o, VF sin_i, VF sin_o, VF v) {
  const VF inverse = hn::Div(splat(1.0f), v);
  const VF a = hn::Mul(hn::Mul(cos_i, cos_o), inverse), b = hn::Mul(hn::Mul(sin_i, sin_o), inverse);
  // 1 / (2 v sinh(1 / v)) as 1 / (v exp(1 / v) (1 - exp(-2 / v))).
  const VF scale = hn::Div(inverse, hn::Sub(splat(1.0f), exp(hn::Mul(splat(-2.0f), inverse))));
  return hn::Mul(scale, exp(hn::Sub(log_bessel(a), hn::Add(b, inverse))));
}

// Where p ways through the fibre turn light to.
HWY_INLINE VF turned(const HairView& view, int p) {
  const VF p_gamma = hn::Mul(splat(2.0f * static_cast<float>(p)), view.gamma_t);
  return hn::Add(hn::Sub(p_gamma, hn::Add(view.gamma_o, view.gamma_o)), splat(static_cast<float>(p) * pi));
}
HWY_INLINE VF logistic_cdf(VF x, VF s) {
  return hn::Div(splat(1.0f), hn::Add(splat(1.0f), exp(hn::Neg(hn::Div(x, s)))));
}
// N_p: a logistic distribution within half a turn on either side.
HWY_INLINE VF azimuthal(const HairView& view, VF s, VF phi, int p) {
  const VF turn = splat(two_pi);
  VF x = hn::Sub(phi, turned(view, p));
  x = hn::NegMulAdd(turn, hn::Round(hn::Div(x, turn)), x);
  const VF e = exp(hn::Neg(hn::Div(hn::Abs(x), s))), one = splat(1.0f), sum = hn::Add(one, e);
  const VF whole = hn::Sub(logistic_cdf(splat(pi), s), logistic_cdf(splat(-pi), s));
  return hn::Div(e, hn::Mul(hn::Mul(s, hn::Mul(sum, sum)), whole));
}
HWY_INLINE VF sample_azimuthal(VF s, VF u) {
  const VF low = logistic_cdf(splat(-pi), s), whole = hn::Sub(logistic_cdf(splat(pi), s), low);
  const VF q = clamp(hn::MulAdd(u, whole, low), 1e-7f, 0.9999999f);
  const VF x = hn::Neg(hn::Mul(s, log(hn::Div(hn::Sub(splat(1.0f), q), q))));
  return hn::Min(hn::Max(x, splat(-pi)), splat(pi));
}

HWY_INLINE void attenuations(const HairOptics& o, const HairView& view, VF cos_gamma_t, VF cos_theta_t, HairView& out) {
  const VF one = splat(1.0f), cos_gamma_o = safe_sqrt(hn::NegMulAdd(o.h, o.h, one));
  const VF f = fresnel_dielectric(o.eta, hn::Div(one, o.eta), hn::Mul(view.cos_o, cos_gamma_o)).reflectance;
  const VF length = hn::Div(hn::Add(cos_gamma_t, cos_gamma_t), hn::Max(cos_theta_t, splat(1e-6f)));
  const VF enters = hn::Sub(one, f);
  VF sum = hn::Zero(FloatTag());
  for (VF& share : out.share) share = hn::Zero(FloatTag());
  for (int j = 0; j < 4; ++j) {
    const VF t = exp(hn::Neg(hn::Mul(o.sigma_a[j], length))), again = hn::Mul(t, f);
    out.attenuation[0][j] = f;
    out.attenuation[1][j] = hn::Mul(hn::Mul(enters, enters), t);
    out.attenuation[2][j] = hn::Mul(out.attenuation[1][j], again);
    out.attenuation[3][j] = hn::Div(hn::Mul(out.attenuation[2][j], again), hn::Max(hn::Sub(one, again), splat(1e-6f)));
    for (int p = 0; p < 4; ++p) {
      out.share[p] = hn::Add(out.share[p], out.attenuation[p][j]);
      sum = hn::Add(sum, out.attenuation[p][j]);
    }
  }
  const VF inverse = hn::Div(one, hn::Max(sum, splat(FLT_MIN)));
  for (VF& share : out.share) share = hn::Mul(share, inverse);
}

HWY_INLINE VF variance_of(const HairOptics& o, int p) {
  return hn::Mul(o.variance, splat(p == 0 ? 1.0f : p == 1 ? 0.25f : 4.0f));
}

}  // namespace bsdf_detail

HWY_INLINE HairView make_hair_view(const Vec3& wo, const HairOptics& o) {
  const VF one = splat(1.0f);
  HairView view;
  view.sin_o = clamp(wo.x, -1.0f, 1.0f);
  view.cos_o = safe_sqrt(hn::NegMulAdd(view.sin_o, view.sin_o, one));
  view.phi_o = atan2(wo.z, wo.y);
  view.gamma_o = bsdf_detail::asin(o.h);
  const VF sin_theta_t = hn::Div(view.sin_o, o.eta);
  const VF cos_theta_t = safe_sqrt(hn::NegMulAdd(sin_theta_t, sin_theta_t, one));
  // The index as it looks across the fibre.
  const VF across = safe_sqrt(hn::NegMulAdd(view.sin_o, view.sin_o, hn::Mul(o.eta, o.eta)));
  const VF sin_gamma_t = clamp(hn::Div(hn::Mul(o.h, view.cos_o), hn::Max(across, splat(1e-6f))), -1.0f, 1.0f);
  view.gamma_t = bsdf_detail::asin(sin_gamma_t);
  bsdf_detail::attenuations(o, view, safe_sqrt(hn::NegMulAdd(sin_gamma_t, sin_gamma_t, one)), cos_theta_t, view);
  // Scales tilt reflections one way and the others the other way: by -2, 1 and 4 times the tilt.
  const int which[3] = {1, 0, 2};
  for (int p = 0; p < 3; ++p) {
    const VF s = p == 0 ? hn::Neg(o.sin_tilt[which[p]]) : o.sin_tilt[which[p]], c = o.cos_tilt[which[p]];
    view.tilted_sin[p] = hn::MulAdd(view.sin_o, c, hn::Mul(view.cos_o, s));
    view.tilted_cos[p] = hn::Abs(hn::MulSub(view.cos_o, c, hn::Mul(view.sin_o, s)));
  }
  return view;
}

// f_cos and the pdf of sample_hair, anywhere on the sphere. Largest errors against double, beta_m and beta_n at least
// 0.1: 2e-4 relative and 1e-6 absolute. (pbrt's I_0 is 0.5 % off where it is largest.)
HWY_INLINE void eval_hair(const HairView& view, const HairOptics& o, const Vec3& wi, VF f_cos[4], VF& pdf) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const VF sin_i = clamp(wi.x, -1.0f, 1.0f), cos_i = safe_sqrt(hn::NegMulAdd(sin_i, sin_i, one));
  const VF phi = hn::Sub(atan2(wi.z, wi.y), view.phi_o);
  for (int j = 0; j < 4; ++j) f_cos[j] = zero;
  pdf = zero;
  for (int p = 0; p < 4; ++p) {
    const VF sin_o = p < 3 ? view.tilted_sin[p] : view.sin_o, cos_o = p < 3 ? view.tilted_cos[p] : view.cos_o;
    const VF along = bsdf_detail::longitudinal(cos_i, cos_o, sin_i, sin_o, bsdf_detail::variance_of(o, p));
    const VF around = p < 3 ? bsdf_detail::azimuthal(view, o.width, phi, p) : splat(0.5f * inverse_pi);
    const VF both = hn::Mul(along, around);
    for (int j = 0; j < 4; ++j) f_cos[j] = hn::MulAdd(both, view.attenuation[p][j], f_cos[j]);
    pdf = hn::MulAdd(both, view.share[p], pdf);
  }
}

// Draws wi: `choice` in [0, 1) takes p, u and v the direction, and what is left of choice where around the fibre.
HWY_INLINE BsdfSample sample_hair(const HairView& view, const HairOptics& o, VF choice, VF u, VF v) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  VF sin_o = view.sin_o, cos_o = view.cos_o, variance = bsdf_detail::variance_of(o, 3);
  // p by its share; `left` is the choice's place within it.
  VF before = hn::Add(hn::Add(view.share[0], view.share[1]), view.share[2]);
  const MF others = hn::Ge(choice, before);
  VF left = hn::Div(hn::Sub(choice, before), hn::Max(view.share[3], splat(FLT_MIN))), turn = zero;
  for (int p = 2; p >= 0; --p) {
    const MF taken = hn::Lt(choice, before);
    before = hn::Max(hn::Sub(before, view.share[p]), zero);
    sin_o = hn::IfThenElse(taken, view.tilted_sin[p], sin_o);
    cos_o = hn::IfThenElse(taken, view.tilted_cos[p], cos_o);
    variance = hn::IfThenElse(taken, bsdf_detail::variance_of(o, p), variance);
    turn = hn::IfThenElse(taken, bsdf_detail::turned(view, p), turn);
    left = hn::IfThenElse(taken, hn::Div(hn::Sub(choice, before), hn::Max(view.share[p], splat(FLT_MIN))), left);
  }
  left = clamp(left, 0.0f, 0.9999999f);
  const VF dphi =
      hn::IfThenElse(others, hn::Mul(splat(two_pi), left), hn::Add(turn, bsdf_detail::sample_azimuthal(o.width, left)));
  // d'Eon et al., "An Energy-Conserving Hair Reflectance Model", 2011, as in pbrt: around the tilted cone.
  const VF tail = exp(hn::Div(splat(-2.0f), variance));
  const VF cos_theta =
      clamp(hn::MulAdd(variance, log(hn::MulAdd(hn::Sub(one, u), tail, hn::Max(u, splat(1e-5f)))), one), -1.0f, 1.0f);
  const VF sin_theta = safe_sqrt(hn::NegMulAdd(cos_theta, cos_theta, one));
  const VF sin_i =
      clamp(hn::NegMulAdd(cos_theta, sin_o, hn::Mul(hn::Mul(sin_theta, sincos_2pi(v).cos), cos_o)), -1.0f, 1.0f);
  const VF cos_i = safe_sqrt(hn::NegMulAdd(sin_i, sin_i, one));
  const SinCos phi = sincos(hn::Add(view.phi_o, dphi));
  BsdfSample sample;
  sample.wi = {sin_i, hn::Mul(cos_i, phi.cos), hn::Mul(cos_i, phi.sin)};
  VF f_cos[4];
  eval_hair(view, o, sample.wi, f_cos, sample.pdf);
  const MF drawn = hn::Gt(sample.pdf, zero);
  const VF inverse = hn::Div(one, hn::IfThenElse(drawn, sample.pdf, one));
  for (int j = 0; j < 4; ++j) sample.weight[j] = hn::IfThenElseZero(drawn, hn::Mul(f_cos[j], inverse));
  return sample;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
