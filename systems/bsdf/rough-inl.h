// The rough reflector, diffuse plus glossy after Blinn (SIGGRAPH 1977), four wavelengths at a time, in two forms.
// Directions are unit vectors in the local shading frame (z = shading normal) and point away from the surface; pdfs are
// per solid angle. Scalar double twins: reference.h. H is the half vector of wi and wo, delta its angle to the normal,
// theta_d its angle to either direction, s the shininess.
//
//   taught:      f_cos = kd cos(theta_i) + ks cos^s(delta)                                    DESIGN.md, section 1
//                kd and ks are the bare factors, in sr^-1. The glossy term has no cosine, so the BRDF is not
//                reciprocal, and nothing bounds its energy: at normal view it reflects pi kd + 8 pi ks (1 -
//                2^(-(s+2)/2)) / (s+2).
//   normalised:  f = kd / pi + ks (s + 1) / (8 pi) cos^s(delta) / (cos(theta_d) max(cos(theta_i), cos(theta_o)))
//                the isotropic lobe of Ashikhmin & Shirley, "An Anisotropic Phong BRDF Model", JGT 5(2), 2000, equation
//                4, with ks in place of its Fresnel factor. kd and ks are albedos. f is symmetric in wi and wo. As
//                d(omega_i) = 4 cos(theta_d) d(omega_H) and cos(theta_i) / max(...) <= 1, the glossy term reflects at
//                most ks (s + 1) / (2 pi) times the integral of cos^s(delta) over the hemisphere of H, which is ks:
//                from every direction no more than kd + ks comes back.
//
// Light from behind the surface gives nothing. Both sides reflect.
//
// Sampling is a mixture, one density for all four wavelengths: with the chance `glossy_share` H is drawn in proportion
// to cos^s(delta), which gives wi the density (s + 1) cos^s(delta) / (8 pi cos(theta_d)), else wi in proportion to
// cos(theta_i).
#if defined(METAMER_SYSTEMS_BSDF_ROUGH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_ROUGH_INL_H_
#undef METAMER_SYSTEMS_BSDF_ROUGH_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_ROUGH_INL_H_
#endif

#include "engine/sampling/warps-inl.h"
#include "engine/simd/math-inl.h"
#include "engine/simd/vec3-inl.h"
#include "systems/bsdf/local-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// kd and ks at least 0, shininess from 0 to largest_shininess.
struct RoughOptics {
  VF kd[4], ks[4];
  VF shininess;
  MF normalized;
};

// What eval and sample share about one vertex.
struct RoughLobe {
  Vec3 wo;  // mirrored to the upper side
  VF side;  // the sign bit of the caller's wo.z, put back into wi.z
  VF glossy_share;
};

// The glossy lobe is chosen in proportion to what it reflects, all wavelengths together: ks against kd where they are
// albedos; about 8 pi ks / (s + 2) against pi kd in the taught form.
HWY_INLINE RoughLobe make_rough_lobe(const Vec3& wo, const RoughOptics& optics) {
  const VF one = splat(1.0f);
  const VF kd = hn::Add(hn::Add(optics.kd[0], optics.kd[1]), hn::Add(optics.kd[2], optics.kd[3]));
  const VF ks = hn::Add(hn::Add(optics.ks[0], optics.ks[1]), hn::Add(optics.ks[2], optics.ks[3]));
  const VF taught = hn::Div(splat(8.0f), hn::Add(optics.shininess, splat(2.0f)));
  const VF glossy = hn::Mul(ks, hn::IfThenElse(optics.normalized, one, taught));
  const VF share = hn::Div(glossy, hn::Max(hn::Add(kd, glossy), splat(FLT_MIN)));
  return {{wo.x, wo.y, hn::Abs(wo.z)}, sign_bit(wo.z), share};
}

namespace bsdf_detail {
// log(1 + x) for x in [0, 1e30], relative 5e-7 however small x: what rounding takes from 1 + x it takes from both the
// logarithm and the divisor (Goldberg, "What Every Computer Scientist Should Know", 1991, theorem 4).
HWY_INLINE VF log_one_plus(VF x) {
  const VF one = splat(1.0f);
  const VF w = hn::Add(one, x), rounded = hn::Sub(w, one);
  const MF tiny = hn::Eq(rounded, hn::Zero(FloatTag()));
  return hn::IfThenElse(tiny, x, hn::Mul(x, hn::Div(log(w), hn::IfThenElse(tiny, one, rounded))));
}

// 1 - e^-x for x >= 0, relative 2e-6; `power` is e^-x.
HWY_INLINE VF one_minus_exp(VF x, VF power) {
  const VF series = hn::Mul(x, math_detail::polynomial(x, {1.0f, -0.5f, 1.0f / 6, -1.0f / 24}));
  return hn::IfThenElse(hn::Lt(x, splat(0.05f)), series, hn::Sub(splat(1.0f), power));
}

// H in proportion to cos^s(delta): cos(delta) = (1 - u)^(1 / (s + 1)), its sine without cancellation.
HWY_INLINE Vec3 sample_half_vector(VF shininess, VF u, VF v) {
  const VF one = splat(1.0f);
  const VF x = hn::Div(hn::Mul(splat(-2.0f), log(hn::Sub(one, u))), hn::Add(shininess, one));
  const VF cos2 = exp(hn::Neg(x));
  const VF sine = safe_sqrt(one_minus_exp(x, cos2));
  const SinCos phi = sincos_2pi(v);
  return {hn::Mul(sine, phi.cos), hn::Mul(sine, phi.sin), hn::Sqrt(cos2)};
}
}  // namespace bsdf_detail

// f_cos = f |cos(theta_i)|, for the taught form kd |cos(theta_i)| + ks cos^s(delta) as it stands, and the pdf with
// which sample_rough draws wi; 0 where wi is behind the surface. Largest errors against double: relative 2e-6 (1 + x)
// with x = -ln(cos^s(delta)), for s up to 1000; the rounding of the directions adds 2e-7 sqrt(s) to that beyond.
HWY_INLINE void eval_rough(const RoughLobe& lobe, const RoughOptics& optics, const Vec3& wi, VF f_cos[4], VF& pdf) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f), s = optics.shininess;
  const VF cos_o = lobe.wo.z, cos_i = flip_sign(wi.z, lobe.side);
  const MF reflects = hn::Gt(hn::Min(cos_i, cos_o), zero);
  const VF h_x = hn::Add(lobe.wo.x, wi.x), h_y = hn::Add(lobe.wo.y, wi.y), h_z = hn::Add(cos_o, cos_i);
  const VF across2 = hn::MulAdd(h_x, h_x, hn::Mul(h_y, h_y));
  const VF up2 = hn::Max(hn::Mul(h_z, h_z), splat(1e-36f));
  // cos^s(delta) = (1 + tan^2(delta))^(-s/2)
  const VF tan2 = hn::Min(hn::Div(across2, up2), splat(1e30f));
  const VF power = exp(hn::Mul(hn::Mul(splat(-0.5f), s), bsdf_detail::log_one_plus(tan2)));
  // |wi + wo| = 2 cos(theta_d)
  const VF length = hn::Sqrt(hn::Add(across2, up2));
  const VF pdf_glossy = hn::Mul(hn::Mul(hn::Add(s, one), splat(0.25f * inverse_pi)), hn::Div(power, length));
  const VF pdf_diffuse = hn::Mul(cos_i, splat(inverse_pi));
  const VF mixture = hn::MulAdd(lobe.glossy_share, pdf_glossy, hn::Mul(hn::Sub(one, lobe.glossy_share), pdf_diffuse));
  pdf = hn::IfThenElseZero(reflects, mixture);
  const VF facing = hn::Div(cos_i, hn::Max(hn::Max(cos_i, cos_o), splat(FLT_MIN)));
  const VF diffuse = hn::IfThenElse(optics.normalized, pdf_diffuse, cos_i);
  const VF glossy = hn::IfThenElse(optics.normalized, hn::Mul(pdf_glossy, facing), power);
  for (int j = 0; j < 4; ++j) {
    const VF sum = hn::MulAdd(optics.kd[j], diffuse, hn::Mul(optics.ks[j], glossy));
    f_cos[j] = hn::IfThenElseZero(reflects, sum);
  }
}

// Draws wi: `choice` in [0, 1) takes the lobe, u and v in [0, 1) the direction in it. A draw below the surface has
// weight 0 and pdf 0. Largest errors against double: wi 1e-5 in each coordinate, weight and pdf those of eval_rough at
// wi.
HWY_INLINE BsdfSample sample_rough(const RoughLobe& lobe, const RoughOptics& optics, VF choice, VF u, VF v) {
  const VF zero = hn::Zero(FloatTag());
  const Vec3 h = bsdf_detail::sample_half_vector(optics.shininess, u, v);
  const VF cos_d = dot(lobe.wo, h);
  const Vec3 mirrored = mul_add(h, hn::Add(cos_d, cos_d), -lobe.wo);
  const MF glossy = hn::Lt(choice, lobe.glossy_share);
  const Vec3 up = if_then_else(glossy, mirrored, sample_cosine_hemisphere(u, v));
  BsdfSample sample;
  sample.wi = {up.x, up.y, flip_sign(up.z, lobe.side)};
  VF f_cos[4];
  eval_rough(lobe, optics, sample.wi, f_cos, sample.pdf);
  const MF drawn = hn::Gt(sample.pdf, zero);
  const VF inverse = hn::Div(splat(1.0f), hn::IfThenElse(drawn, sample.pdf, splat(1.0f)));
  for (int j = 0; j < 4; ++j) sample.weight[j] = hn::IfThenElseZero(drawn, hn::Mul(f_cos[j], inverse));
  return sample;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
