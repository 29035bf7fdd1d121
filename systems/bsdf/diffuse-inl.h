// The Lambertian reflector, four wavelengths at a time. Directions are unit vectors in the local shading frame
// (z = shading normal) and point away from the surface; pdfs are per solid angle. Twins: reference.h.
#if defined(METAMER_SYSTEMS_BSDF_DIFFUSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_DIFFUSE_INL_H_
#undef METAMER_SYSTEMS_BSDF_DIFFUSE_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_DIFFUSE_INL_H_
#endif

#include "engine/sampling/warps-inl.h"
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

// Draws wi in proportion to |cos(theta_i)| on wo's side; u, v in [0, 1). The weight is the albedo itself. A draw in the
// surface's own plane (u or v = 0) has weight 0 and pdf 0. Largest error against double: wi 1e-6, pdf 1e-6.
HWY_INLINE BsdfSample sample_diffuse(const Vec3& wo, const VF albedo[4], VF u, VF v) {
  const Vec3 up = sample_cosine_hemisphere(u, v);
  BsdfSample sample;
  sample.wi = {up.x, up.y, flip_sign(up.z, sign_bit(wo.z))};
  sample.pdf = cosine_hemisphere_pdf(up.z);
  const MF reflects = hn::Gt(up.z, hn::Zero(FloatTag()));
  for (int j = 0; j < 4; ++j) sample.weight[j] = hn::IfThenElseZero(reflects, albedo[j]);
  return sample;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
