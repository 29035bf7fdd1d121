// The Lambertian reflector, four wavelengths at a time. Directions are unit vectors in the local shading frame
// (z = shading normal) and point away from the surface; pdfs are per solid angle. Twins: reference.h.
#if defined(METAMER_SYSTEMS_BSDF_DIFFUSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_DIFFUSE_INL_H_
#undef METAMER_SYSTEMS_BSDF_DIFFUSE_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_DIFFUSE_INL_H_
#endif

#include "engine/simd/math-inl.h"
#include "engine/simd/vec3-inl.h"
#include "systems/bsdf/local-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// f_cos = f |cos(theta_i)| with f = albedo / pi in sr^-1, albedo in [0, 1], and the pdf of sample_diffuse,
// |cos(theta_i)| / pi. Two-sided: light is reflected where wi and wo are on the same side of the surface, whichever it
// is; elsewhere both are 0. Largest relative error against double: 4e-7.
HWY_INLINE void eval_diffuse(const Vec3& wo, const VF albedo[4], const Vec3& wi, VF f_cos[4], VF& pdf) {
  const MF same_side = hn::Gt(hn::Mul(wo.z, wi.z), hn::Zero(FloatTag()));
  pdf = hn::IfThenElseZero(same_side, hn::Mul(hn::Abs(wi.z), splat(inverse_pi)));
  for (int j = 0; j < 4; ++j) f_cos[j] = hn::IfThenElseZero(same_side, hn::Mul(albedo[j], pdf));
}

// Draws wi in proportion to |cos(theta_i)| on wo's side (Malley's method over the concentric disk); u, v in [0, 1). The
// weight is the albedo itself.
HWY_INLINE BsdfSample sample_diffuse(const Vec3& wo, const VF albedo[4], VF u, VF v) {
  BsdfSample sample;
  const SinCos phi = sincos_2pi(u);
  const VF r = hn::Sqrt(v);
  const VF z = hn::Sqrt(hn::Sub(splat(1.0f), v));
  sample.wi = {hn::Mul(r, phi.cos), hn::Mul(r, phi.sin), flip_sign(z, sign_bit(wo.z))};
  sample.pdf = hn::Mul(z, splat(inverse_pi));
  for (int j = 0; j < 4; ++j) sample.weight[j] = albedo[j];
  return sample;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
