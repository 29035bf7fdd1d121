// A sheet that scatters light evenly to both of its sides, four wavelengths at a time: paper, a leaf, a blind.
//
//   f = reflectance / pi where wi and wo are on one side, transmittance / pi where they are not
//
// Directions are unit vectors in the local shading frame (z = shading normal) and point away from the surface; pdfs are
// per solid angle. It is reciprocal. A side is drawn in proportion to the sum of its albedos over the wavelengths, then
// a direction in proportion to its cosine. Twins: reference.h.
#if defined(METAMER_SYSTEMS_BSDF_DIFFUSE_TRANSMISSION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_DIFFUSE_TRANSMISSION_INL_H_
#undef METAMER_SYSTEMS_BSDF_DIFFUSE_TRANSMISSION_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_DIFFUSE_TRANSMISSION_INL_H_
#endif

#include "engine/sampling/warps-inl.h"
#include "engine/simd/math-inl.h"
#include "engine/simd/vec3-inl.h"
#include "systems/bsdf/local-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Both in [0, 1].
struct SheetOptics {
  VF reflectance[4], transmittance[4];
  VF reflected_share;  // the chance of wo's side; from sheet_share
};
HWY_INLINE VF sheet_share(const SheetOptics& optics) {
  VF reflected = hn::Zero(FloatTag()), all = splat(FLT_MIN);
  for (int j = 0; j < 4; ++j) {
    reflected = hn::Add(reflected, optics.reflectance[j]);
    all = hn::Add(all, hn::Add(optics.reflectance[j], optics.transmittance[j]));
  }
  return hn::Div(reflected, all);
}

// f_cos = f |cos(theta_i)| and the pdf of sample_sheet. Largest errors against double: 6e-7 relative
// and 3e-8 absolute.
HWY_INLINE void eval_sheet(const Vec3& wo, const SheetOptics& optics, const Vec3& wi, VF f_cos[4], VF& pdf) {
  const VF zero = hn::Zero(FloatTag()), sides = hn::Mul(wo.z, wi.z);
  const MF reflects = hn::Gt(sides, zero), scatters = hn::Ne(sides, zero);
  const VF density = hn::IfThenElseZero(scatters, hn::Mul(hn::Abs(wi.z), splat(inverse_pi)));
  const VF share = hn::IfThenElse(reflects, optics.reflected_share, hn::Sub(splat(1.0f), optics.reflected_share));
  pdf = hn::Mul(density, share);
  for (int j = 0; j < 4; ++j)
    f_cos[j] = hn::Mul(density, hn::IfThenElse(reflects, optics.reflectance[j], optics.transmittance[j]));
}

// `choice` takes the side, u and v the direction, all in [0, 1). Largest errors against double: wi and pdf 1e-6, weight
// 1e-6 relative. A draw in the surface's own plane has weight 0 and pdf 0.
HWY_INLINE BsdfSample sample_sheet(const Vec3& wo, const SheetOptics& optics, VF choice, VF u, VF v) {
  const Vec3 up = sample_cosine_hemisphere(u, v);
  const MF reflects = hn::Lt(choice, optics.reflected_share);
  const VF share = hn::IfThenElse(reflects, optics.reflected_share, hn::Sub(splat(1.0f), optics.reflected_share));
  const VF side = hn::Xor(sign_bit(wo.z), hn::IfThenElse(reflects, hn::Zero(FloatTag()), splat(-0.0f)));
  const MF counts = hn::And(hn::Gt(up.z, hn::Zero(FloatTag())), hn::Gt(share, hn::Zero(FloatTag())));
  BsdfSample sample;
  sample.wi = {up.x, up.y, flip_sign(up.z, side)};
  sample.pdf = hn::IfThenElseZero(counts, hn::Mul(cosine_hemisphere_pdf(up.z), share));
  const VF inverse = hn::Div(splat(1.0f), hn::Max(share, splat(FLT_MIN)));
  for (int j = 0; j < 4; ++j) {
    const VF albedo = hn::IfThenElse(reflects, optics.reflectance[j], optics.transmittance[j]);
    sample.weight[j] = hn::IfThenElseZero(counts, hn::Mul(albedo, inverse));
  }
  return sample;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
