// The Trowbridge-Reitz (GGX) distribution of microfacet normals with anisotropic roughness, and the conductor made of
// it, four wavelengths at a time. Directions are unit vectors in the local shading frame (z = shading normal, x along
// alpha_x) and point away from the surface; pdfs are per solid angle. Scalar double twins: reference.h.
//
//   D(m)      = 1 / (pi ax ay ((mx/ax)^2 + (my/ay)^2 + mz^2)^2)               Trowbridge & Reitz, JOSA 65, 531 (1975)
//   Lambda(w) = (S(w) / |wz| - 1) / 2,  S(w) = sqrt((ax wx)^2 + (ay wy)^2 + wz^2)    Heitz, JCGT 3(2), 2014
//   G1 = 1 / (1 + Lambda(wo)),  G = 1 / (1 + Lambda(wo) + Lambda(wi))   Smith, height-correlated, as pbrt-v4
//   f = D G F / (4 |cos(theta_i) cos(theta_o)|)                         Cook & Torrance 1982, Walter et al. 2007
//
// Normals are sampled among those visible from wo by a spherical cap (Dupuy & Benyoub, Computer Graphics Forum 42(8),
// 2023), so that pdf(wi) = D G1 / (4 cos(theta_o)) and f_cos / pdf = F G / G1, never above 1. Written in S:
//   f_cos = D F |cos(theta_i)| / (2 den),  den = S(wo) |cos(theta_i)| + S(wi) |cos(theta_o)|
//   pdf   = D / (2 (|cos(theta_o)| + S(wo)))
#if defined(METAMER_SYSTEMS_BSDF_GGX_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_GGX_INL_H_
#undef METAMER_SYSTEMS_BSDF_GGX_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_GGX_INL_H_
#endif

#include "engine/simd/math-inl.h"
#include "engine/simd/vec3-inl.h"
#include "systems/bsdf/fresnel-inl.h"
#include "systems/bsdf/limits.h"
#include "systems/bsdf/local-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// What eval and sample share about one viewing direction; made once per path vertex.
struct GgxLobe {
  Vec3 wo;  // mirrored to the upper side
  VF side;  // the sign bit of the caller's wo.z, put back into wi.z
  VF alpha_x, alpha_y, inv_alpha_x, inv_alpha_y;
  VF d_scale;      // 1 / (2 pi alpha_x alpha_y)
  VF s_wo, inv_s;  // S(wo) and its reciprocal
  VF inv_visible;  // 1 / (cos(theta_o) + S(wo))
  MF smooth;       // a delta lobe: both alphas below smooth_alpha
};

// A metal's measured constants, relative to the medium in front of it; lanes of `schlick` use Schlick's approximation.
struct ConductorOptics {
  VF n[4], kappa[4];
  MF schlick;
};

namespace bsdf_detail {
HWY_INLINE VF stretched_length(VF alpha_x, VF alpha_y, const Vec3& w) {
  const VF x = hn::Mul(alpha_x, w.x), y = hn::Mul(alpha_y, w.y);
  return hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(w.z, w.z))));
}
}  // namespace bsdf_detail

// alpha_x, alpha_y in [0, 1]: a rough lobe's are raised to least_alpha; where the larger is below smooth_alpha the lobe
// is a perfect mirror: eval gives 0, sample the mirror direction with probability 1. wo.z may have either sign, for the
// surface reflects on both sides; wo.z = 0 reflects nothing.
HWY_INLINE GgxLobe make_ggx_lobe(const Vec3& wo, VF alpha_x, VF alpha_y) {
  GgxLobe lobe;
  lobe.wo = {wo.x, wo.y, hn::Abs(wo.z)};
  lobe.side = sign_bit(wo.z);
  lobe.smooth = hn::Lt(hn::Max(alpha_x, alpha_y), splat(smooth_alpha));
  lobe.alpha_x = hn::Max(alpha_x, splat(least_alpha));
  lobe.alpha_y = hn::Max(alpha_y, splat(least_alpha));
  const VF inv_product = hn::Div(splat(1.0f), hn::Mul(lobe.alpha_x, lobe.alpha_y));
  lobe.inv_alpha_x = hn::Mul(lobe.alpha_y, inv_product);
  lobe.inv_alpha_y = hn::Mul(lobe.alpha_x, inv_product);
  lobe.d_scale = hn::Mul(hn::Mul(splat(0.5f), splat(inverse_pi)), inv_product);
  lobe.s_wo = bsdf_detail::stretched_length(lobe.alpha_x, lobe.alpha_y, lobe.wo);
  const VF visible = hn::Add(lobe.wo.z, lobe.s_wo);
  const VF inv_both = hn::Div(splat(1.0f), hn::Mul(lobe.s_wo, visible));
  lobe.inv_s = hn::Mul(visible, inv_both);
  lobe.inv_visible = hn::Mul(lobe.s_wo, inv_both);
  return lobe;
}

// F of the four wavelengths at one angle: fresnel_conductor or schlick_conductor, lane by lane.
HWY_INLINE void conductor_reflectance(const ConductorOptics& optics, VF cos_theta, VF reflectance[4]) {
  const FloatTag d;
  if (hn::AllTrue(d, optics.schlick)) {
    for (int j = 0; j < 4; ++j) reflectance[j] = schlick_conductor(optics.n[j], optics.kappa[j], cos_theta);
    return;
  }
  for (int j = 0; j < 4; ++j) reflectance[j] = fresnel_conductor(optics.n[j], optics.kappa[j], cos_theta);
  if (hn::AllFalse(d, optics.schlick)) return;
  for (int j = 0; j < 4; ++j) {
    const VF approximate = schlick_conductor(optics.n[j], optics.kappa[j], cos_theta);
    reflectance[j] = hn::IfThenElse(optics.schlick, approximate, reflectance[j]);
  }
}

// What a perfectly reflecting distribution makes of one light direction: f |cos(theta_i)| without Fresnel's factor, the
// pdf with which sampling visible normals draws wi, and the cosine between wi and the facet's normal. f_cos and pdf are
// 0 where wi is on the other side, and for smooth lobes. Largest relative error against double: 2e-6.
struct GgxReflection {
  VF f_cos, pdf, cos_theta_d;
};
HWY_INLINE GgxReflection eval_ggx_reflection(const GgxLobe& lobe, const Vec3& wi) {
  const VF zero = hn::Zero(FloatTag());
  const Vec3 up = {wi.x, wi.y, flip_sign(wi.z, lobe.side)};
  const MF reflects = hn::AndNot(lobe.smooth, hn::Gt(hn::Min(up.z, lobe.wo.z), zero));
  const Vec3 h = lobe.wo + up;
  const VF h2 = dot(h, h);
  const VF x = hn::Mul(h.x, lobe.inv_alpha_x), y = hn::Mul(h.y, lobe.inv_alpha_y);
  const VF q = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(h.z, h.z)));
  const VF s_wi = bsdf_detail::stretched_length(lobe.alpha_x, lobe.alpha_y, up);
  const VF den = hn::MulAdd(lobe.s_wo, up.z, hn::Mul(s_wi, lobe.wo.z));
  const VF inv_both = hn::Div(splat(1.0f), hn::Mul(q, den));
  const VF ratio = hn::Mul(h2, hn::Mul(den, inv_both));
  const VF half_d = hn::Mul(hn::Mul(ratio, ratio), lobe.d_scale);  // D / 2
  const VF f_cos = hn::Mul(hn::Mul(half_d, up.z), hn::Mul(q, inv_both));
  // h = 2 m cos(theta_d), both directions being unit vectors.
  return {hn::IfThenElseZero(reflects, f_cos), hn::IfThenElseZero(reflects, hn::Mul(half_d, lobe.inv_visible)),
          hn::Mul(splat(0.5f), hn::Sqrt(h2))};
}

// f_cos = f |cos(theta_i)| and the pdf with which sample_conductor draws wi; 0 where wi is on the other side, and for
// smooth lobes. Largest relative error against double: 2e-5.
HWY_INLINE void eval_conductor(const GgxLobe& lobe, const ConductorOptics& optics, const Vec3& wi, VF f_cos[4],
                               VF& pdf) {
  const GgxReflection reflection = eval_ggx_reflection(lobe, wi);
  pdf = reflection.pdf;
  const MF reflects = hn::Gt(reflection.pdf, hn::Zero(FloatTag()));
  VF reflectance[4];
  conductor_reflectance(optics, reflection.cos_theta_d, reflectance);
  for (int j = 0; j < 4; ++j) f_cos[j] = hn::IfThenElseZero(reflects, hn::Mul(reflectance[j], reflection.f_cos));
}

namespace bsdf_detail {
// A normal visible from the lobe's wo, not normalised: m = (alpha_x h.x, alpha_y h.y, h.z), where h is the half vector
// in the space in which the surface is a hemisphere. h2 = h.h, so D(m) = 2 d_scale (m.m / h2)^2.
struct VisibleNormal {
  Vec3 m;
  VF h2;
};
HWY_INLINE VisibleNormal sample_visible_normal(const GgxLobe& lobe, VF u, VF v) {
  const VF one = splat(1.0f);
  const Vec3 w = Vec3{hn::Mul(lobe.alpha_x, lobe.wo.x), hn::Mul(lobe.alpha_y, lobe.wo.y), lobe.wo.z} * lobe.inv_s;
  // The point on the cap, c, has c.z = h_z - w.z; its distance from the axis, sqrt(1 - c.z^2), without the
  // cancellation. h_z is never 0 for v < 1, so that h has a direction.
  const VF crown = hn::Add(one, w.z);
  const VF h_z = hn::Mul(hn::Sub(one, v), crown);
  const VF r2 = hn::Mul(v, hn::MulAdd(crown, h_z, hn::MulAdd(w.x, w.x, hn::Mul(w.y, w.y))));
  const VF r = hn::Sqrt(r2);
  const SinCos phi = sincos_2pi(u);
  const Vec3 h = {hn::MulAdd(r, phi.cos, w.x), hn::MulAdd(r, phi.sin, w.y), h_z};
  return {{hn::Mul(lobe.alpha_x, h.x), hn::Mul(lobe.alpha_y, h.y), h.z}, dot(h, h)};
}
}  // namespace bsdf_detail

// Draws wi; u, v in [0, 1). For smooth lobes the mirror direction with weight F and probability 1 (a delta lobe: its
// lanes are lobe.smooth). A draw below the surface has weight 0 and pdf 0.
// Largest errors against double: wi 3e-5 in each coordinate, weight 5e-5, pdf 1e-4 relative.
HWY_INLINE BsdfSample sample_conductor(const GgxLobe& lobe, const ConductorOptics& optics, VF u, VF v) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const bsdf_detail::VisibleNormal visible = bsdf_detail::sample_visible_normal(lobe, u, v);
  const Vec3 n = if_then_else(lobe.smooth, Vec3{zero, zero, one}, visible.m);
  const VF n2 = dot(n, n);
  const VF inv_length = hn::Div(one, hn::Sqrt(n2));
  const Vec3 m = n * inv_length;
  const VF cos_theta_d = dot(lobe.wo, m);
  const Vec3 up = reflect(-lobe.wo, m);
  const MF reflects = hn::Gt(hn::Min(up.z, lobe.wo.z), zero);
  const VF s_wi = bsdf_detail::stretched_length(lobe.alpha_x, lobe.alpha_y, up);
  const VF den = hn::MulAdd(lobe.s_wo, up.z, hn::Mul(s_wi, lobe.wo.z));
  const VF inv_both = hn::Div(one, hn::Mul(visible.h2, den));
  const VF ratio = hn::Mul(n2, hn::Mul(den, inv_both));
  const VF rough_pdf = hn::Mul(hn::Mul(hn::Mul(ratio, ratio), lobe.d_scale), lobe.inv_visible);
  // G / G1
  const VF shadowing = hn::Mul(hn::Mul(up.z, hn::Add(lobe.wo.z, lobe.s_wo)), hn::Mul(visible.h2, inv_both));
  BsdfSample sample;
  sample.wi = {up.x, up.y, flip_sign(up.z, lobe.side)};
  sample.pdf = hn::IfThenElseZero(reflects, hn::IfThenElse(lobe.smooth, one, rough_pdf));
  const VF common = hn::IfThenElse(lobe.smooth, one, hn::Min(shadowing, one));
  VF reflectance[4];
  conductor_reflectance(optics, cos_theta_d, reflectance);
  for (int j = 0; j < 4; ++j) sample.weight[j] = hn::IfThenElseZero(reflects, hn::Mul(reflectance[j], common));
  return sample;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
