// A thin plate: two parallel boundaries as one surface, with all reflections between them, four wavelengths at a time.
// Light goes straight through or is mirrored, both delta lobes. With F of one boundary and T the transmittance from one
// to the other, the geometric series over the reflections inside (Stokes 1862) give
//   R = F + F T^2 (1 - F)^2 / (1 - F^2 T^2),  T' = T (1 - F)^2 / (1 - F^2 T^2);  R = 2 F / (1 + F) without absorption.
// Local directions as in dielectric-inl.h; both sides are alike. Scalar double twin: reference.h.
#if defined(METAMER_SYSTEMS_BSDF_THIN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_THIN_INL_H_
#undef METAMER_SYSTEMS_BSDF_THIN_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_THIN_INL_H_
#endif

#include "engine/simd/math-inl.h"
#include "systems/bsdf/dielectric-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// eta and kappa of the plate against what is around it; wavelengths of `opaque` reflect as conductors and let nothing
// through. `optical_depth`: sigma_a times the thickness, at least 0, along the normal.
struct ThinOptics {
  VF eta[4], kappa[4], optical_depth[4];
  MF opaque[4];
  MF schlick;
  MF companions;  // all four wavelengths are alive; else the hero alone decides
};

struct ThinShares {
  VF reflected, transmitted;
};
// What comes back and what goes through on one wavelength; cos_theta in [0, 1]. Largest error against double: 2e-5,
// near a critical angle as fresnel_dielectric.
HWY_INLINE ThinShares thin_shares(const ThinOptics& optics, int j, VF cos_theta) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const VF eta = optics.eta[j];
  const DielectricBoundary boundary = bsdf_detail::boundary({eta, hn::Div(one, eta)}, cos_theta, optics.schlick);
  const VF f = boundary.reflectance;
  const VF depth = hn::Div(optics.optical_depth[j], hn::Max(boundary.cos_theta_t, splat(1e-6f)));
  const VF t = hn::IfThenElse(hn::Gt(optics.optical_depth[j], zero), exp(hn::Neg(depth)), one);
  const VF entered = hn::Sub(one, f), ft = hn::Mul(f, t);
  // 1 - F^2 T^2 vanishes only with 1 - F.
  const VF series = hn::Div(hn::Mul(hn::Mul(entered, entered), t),
                            hn::Max(hn::Mul(hn::Sub(one, ft), hn::Add(one, ft)), splat(1e-30f)));
  const VF exact = fresnel_conductor(eta, optics.kappa[j], cos_theta);
  const VF approximate = schlick_conductor(eta, optics.kappa[j], cos_theta);
  const VF metal = hn::IfThenElse(optics.schlick, approximate, exact);
  return {hn::IfThenElse(optics.opaque[j], metal, hn::Min(hn::MulAdd(ft, series, f), one)),
          hn::IfThenZeroElse(optics.opaque[j], series)};
}

struct ThinSample {
  VF weight[4];    // R / probability or T' / probability
  VF probability;  // of the lobe that was drawn
  MF transmitted;  // straight on, else mirrored
};
// Draws one of the two lobes; u in [0, 1). All wavelengths go on together: by the mean of R against that of T'.
HWY_INLINE ThinSample sample_thin(VF cos_theta, const ThinOptics& optics, VF u) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  ThinShares shares[4];
  VF reflected = zero, transmitted = zero;
  for (int j = 0; j < 4; ++j) {
    shares[j] = thin_shares(optics, j, cos_theta);
    const MF counts = j == 0 ? hn::Eq(zero, zero) : optics.companions;
    reflected = hn::Add(reflected, hn::IfThenElseZero(counts, shares[j].reflected));
    transmitted = hn::Add(transmitted, hn::IfThenElseZero(counts, shares[j].transmitted));
  }
  const VF all = hn::Add(reflected, transmitted);
  const VF p_reflect = hn::IfThenElse(hn::Gt(all, zero), hn::Div(reflected, hn::Max(all, splat(1e-30f))), one);
  ThinSample sample;
  sample.transmitted = hn::Ge(u, p_reflect);
  sample.probability = hn::IfThenElse(sample.transmitted, hn::Sub(one, p_reflect), p_reflect);
  for (int j = 0; j < 4; ++j)
    sample.weight[j] =
        hn::Div(hn::IfThenElse(sample.transmitted, shares[j].transmitted, shares[j].reflected), sample.probability);
  return sample;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
