// Reflection and refraction at a smooth boundary, one wavelength per call. Scalar double twins: reference.h.
//
// eta is the relative index n_transmitted / n_incident, kappa the extinction coefficient relative to the incident
// medium; both dimensionless. cos_theta_i is the cosine between the incident direction and the normal, in [0, 1]
// (values above 1 by rounding are taken as 1). Reflectances are those of unpolarised light, in [0, 1].
#if defined(METAMER_SYSTEMS_BSDF_FRESNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_FRESNEL_INL_H_
#undef METAMER_SYSTEMS_BSDF_FRESNEL_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_FRESNEL_INL_H_
#endif

#include "engine/simd/vec3-inl.h"
#include "systems/bsdf/limits.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// What a boundary between two transparent media does at one wavelength.
struct DielectricBoundary {
  VF reflectance;  // exactly 1 in total internal reflection
  VF cos_theta_t;  // of the transmitted ray, in [0, 1]; 0 in total internal reflection
  MF total;        // total internal reflection: there is no transmitted ray
};

namespace bsdf_detail {
// eta cos(theta_t), squared: negative beyond the critical angle. Every question about total internal reflection is
// answered from this one value, so that no two places disagree about a ray at the threshold.
HWY_INLINE VF transmitted_projection_squared(VF eta, VF cos_theta_i) {
  const VF one = splat(1.0f);
  return hn::MulAdd(cos_theta_i, cos_theta_i, hn::Mul(hn::Sub(eta, one), hn::Add(eta, one)));
}
HWY_INLINE VF schlick_curve(VF f0, VF cos_theta) {
  const VF x = hn::Sub(splat(1.0f), cos_theta);
  const VF x2 = hn::Mul(x, x);
  return hn::MulAdd(hn::Sub(splat(1.0f), f0), hn::Mul(hn::Mul(x2, x2), x), f0);
}
}  // namespace bsdf_detail

// The reflected direction R = v + 2 N cos(alpha), cos(alpha) = -v.N; v points towards the surface, N is a unit normal
// on either side. DESIGN.md, section 1.
HWY_INLINE Vec3 reflect(const Vec3& v, const Vec3& n) { return mul_add(n, hn::Mul(splat(-2.0f), dot(v, n)), v); }

// The refracted direction T = v / eta + N (cos(alpha) / eta - cos_theta_t); v points towards the surface, N against v,
// inv_eta = 1 / eta, and cos_theta_t comes from a DielectricBoundary. Meaningless in total internal reflection.
// DESIGN.md, section 1.
HWY_INLINE Vec3 refract(const Vec3& v, const Vec3& n, VF inv_eta, VF cos_theta_t) {
  const VF cos_alpha = hn::Neg(dot(v, n));
  return mul_add(n, hn::MulSub(cos_alpha, inv_eta, cos_theta_t), v * inv_eta);
}

// Exact Fresnel reflectance between transparent media, eta > 0, inv_eta = 1 / eta. With c = cos(theta_i),
// s = sin(theta_i), g = eta cos(theta_t): r_s = (1 - eta^2) / (c + g)^2 and r_p / r_s = (c g - s^2) / (c g + s^2) (Born
// & Wolf, Principles of Optics, section 1.5.2, in sums without cancellation), so that (r_s^2 + r_p^2) / 2 = r_s^2 (c^2
// g^2 + s^4) / (c g + s^2)^2. Grazing incidence gives 1 unless eta = 1, which gives 0. Largest error against double:
// 1e-5 while |g^2| > 1e-3; nearer to the critical angle, where the slope is infinite, 8e-3. Tested for eta in [1/3, 3].
HWY_INLINE DielectricBoundary fresnel_dielectric(VF eta, VF inv_eta, VF cos_theta_i) {
  const FloatTag d;
  const VF one = splat(1.0f);
  const VF c = hn::Min(cos_theta_i, one);
  const VF g2 = bsdf_detail::transmitted_projection_squared(eta, c);
  const MF total = hn::Lt(g2, hn::Zero(d));
  const VF g2_clamped = hn::Max(g2, hn::Zero(d));
  const VF g = hn::Sqrt(g2_clamped);
  const VF s2 = hn::NegMulAdd(c, c, one);
  // c + g is zero only for eta = 1 at grazing incidence, where r_s is zero as well.
  const VF sum = hn::Max(hn::Add(c, g), splat(1e-12f));
  const VF r = hn::Div(hn::Mul(hn::Sub(eta, one), hn::Add(eta, one)), hn::Mul(hn::Mul(sum, sum), hn::MulAdd(c, g, s2)));
  const VF f = hn::Mul(hn::Mul(r, r), hn::MulAdd(hn::Mul(c, c), g2_clamped, hn::Mul(s2, s2)));
  return {hn::IfThenElse(total, one, hn::Min(f, one)), hn::Mul(g, inv_eta), total};
}

// Schlick's approximation F0 + (1 - F0)(1 - cos)^5 (Schlick, Computer Graphics Forum 13(3), 1994) between transparent
// media: the cosine is the one on the side of the smaller index, so both directions agree; 1 beyond the critical angle.
// Arguments as for fresnel_dielectric. Errors against double as fresnel_dielectric. Its distance from the exact form:
// docs/fresnel.md.
HWY_INLINE DielectricBoundary schlick_dielectric(VF eta, VF inv_eta, VF cos_theta_i) {
  const FloatTag d;
  const VF one = splat(1.0f);
  const VF c = hn::Min(cos_theta_i, one);
  const VF g2 = bsdf_detail::transmitted_projection_squared(eta, c);
  const MF total = hn::Lt(g2, hn::Zero(d));
  const VF cos_theta_t = hn::Mul(hn::Sqrt(hn::Max(g2, hn::Zero(d))), inv_eta);
  const VF r0 = hn::Div(hn::Sub(eta, one), hn::Add(eta, one));
  const VF cos_thin = hn::Min(hn::IfThenElse(hn::Lt(eta, one), cos_theta_t, c), one);
  const VF f = bsdf_detail::schlick_curve(hn::Mul(r0, r0), cos_thin);
  return {hn::IfThenElse(total, one, f), cos_theta_t, total};
}

// Exact Fresnel reflectance of an absorbing medium of index n + i kappa, n >= 0, 0 <= kappa <= 1e8, not both 0.
// With (a + i b)^2 = (n + i kappa)^2 - s^2 (Born & Wolf, section 14.2; the sums regrouped to avoid cancellation):
// R_s = ((a - c)^2 + b^2) / ((a + c)^2 + b^2) and (R_s + R_p) / 2 = R_s t / (t + 2 a c s^2), t = c^2 (a^2 + b^2) + s^4.
// Largest error against double: 2e-5; for kappa < refracting_kappa near a critical angle as fresnel_dielectric.
HWY_INLINE VF fresnel_conductor(VF n, VF kappa, VF cos_theta_i) {
  const FloatTag d;
  const VF one = splat(1.0f);
  const VF c = hn::Min(cos_theta_i, one);
  const VF c2 = hn::Mul(c, c);
  const VF s2 = hn::NegMulAdd(c, c, one);
  const VF nk = hn::Mul(n, kappa);
  const VF t0 = hn::NegMulAdd(kappa, kappa, bsdf_detail::transmitted_projection_squared(n, c));
  const VF modulus = hn::Sqrt(hn::MulAdd(t0, t0, hn::Mul(splat(4.0f), hn::Mul(nk, nk))));  // a^2 + b^2
  // The larger of a and b from a sum of like signs, the smaller from a b = n kappa.
  const VF tiny = splat(1e-18f);
  const VF larger = hn::Sqrt(hn::Mul(splat(0.5f), hn::Add(modulus, hn::Abs(t0))));
  const VF smaller = hn::Div(nk, hn::Max(larger, tiny));
  const MF refracting = hn::Ge(t0, hn::Zero(d));
  const VF a = hn::IfThenElse(refracting, larger, smaller);
  const VF b = hn::IfThenElse(refracting, smaller, larger);
  const VF b2 = hn::Mul(b, b);
  const VF difference = hn::Sub(a, c);
  const VF sum = hn::Add(a, c);
  const VF t = hn::MulAdd(c2, modulus, hn::Mul(s2, s2));
  const VF numerator = hn::Mul(hn::MulAdd(difference, difference, b2), t);
  const VF p = hn::MulAdd(hn::Mul(hn::Add(a, a), c), s2, t);
  const VF denominator = hn::Mul(hn::MulAdd(sum, sum, b2), p);
  // Both vanish only at grazing incidence on a medium that is not there (n = 1, kappa = 0).
  return hn::Min(hn::Div(numerator, hn::Max(denominator, tiny)), one);
}

// Schlick's approximation of an absorbing medium with F0 = ((n-1)^2 + kappa^2) / ((n+1)^2 + kappa^2). There is a
// critical angle only where light is refracted at all: for kappa below refracting_kappa and n < 1 the transmitted
// cosine enters and F = 1 beyond; every other medium uses cos(theta_i). Range as fresnel_conductor. Errors as
// fresnel_conductor.
HWY_INLINE VF schlick_conductor(VF n, VF kappa, VF cos_theta_i) {
  const FloatTag d;
  const VF one = splat(1.0f);
  const VF c = hn::Min(cos_theta_i, one);
  const VF k2 = hn::Mul(kappa, kappa);
  const VF below = hn::Sub(n, one);
  const VF above = hn::Add(n, one);
  const VF f0 = hn::Div(hn::MulAdd(below, below, k2), hn::MulAdd(above, above, k2));
  const VF f = bsdf_detail::schlick_curve(f0, c);
  const MF refracting = hn::And(hn::Lt(n, one), hn::Lt(kappa, splat(refracting_kappa)));
  if (hn::AllFalse(d, refracting)) return f;
  const VF g2 = bsdf_detail::transmitted_projection_squared(n, c);
  const VF cos_theta_t = hn::Div(hn::Sqrt(hn::Max(g2, hn::Zero(d))), hn::Max(n, splat(1e-6f)));
  const VF f_inside = bsdf_detail::schlick_curve(f0, hn::Min(cos_theta_t, one));
  return hn::IfThenElse(refracting, hn::IfThenElse(hn::Lt(g2, hn::Zero(d)), one, f_inside), f);
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
