// The phase function of L. G. Henyey and J. L. Greenstein, "Diffuse radiation in the Galaxy", Astrophysical Journal 93,
// 1941. Directions are in a frame whose z axis is the direction in which the light's path goes on unscattered (away
// from wo), so z is the cosine of the scattering angle; g is its mean.
#if defined(METAMER_SYSTEMS_BSDF_PHASE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_PHASE_INL_H_
#undef METAMER_SYSTEMS_BSDF_PHASE_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_PHASE_INL_H_
#endif

#include "engine/sampling/warps-inl.h"
#include "engine/simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// A share of the second lobe in what is scattered, the rest goes by the first.
struct PhaseLobes {
  VF g, g2, g2_share;
};

// (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^1.5), sr^-1, for -1 < g < 1: the value and the pdf of sample_phase, per solid
// angle. Twin: reference::eval_phase(). Relative error below 2e-6 / (1 - |g|).
HWY_INLINE VF eval_phase(VF cos_theta, VF g) {
  const VF one = splat(1.0f), two = splat(2.0f), size = hn::Abs(g);
  // (1 - |g|)^2 + 2 |g| (1 -+ cos): no difference of nearly equal numbers where the lobe is narrow.
  const VF away = hn::Max(hn::NegMulAdd(cos_theta, hn::CopySign(one, g), one), hn::Zero(FloatTag()));
  const VF back = hn::Sub(one, size);
  const VF square = hn::MulAdd(hn::Mul(two, size), away, hn::Mul(back, back));
  const VF peak = hn::Mul(back, hn::Add(one, size));
  return hn::Div(hn::Mul(splat(0.25f * inverse_pi), peak), hn::Mul(square, hn::Sqrt(square)));
}

// Unit direction distributed by eval_phase; u and v in [0, 1). Twin: reference::sample_phase(). The usual inversion is
// (1 + g^2 - s^2) / 2g with s = (1 - g^2) / (1 + g x), x = 2u - 1; multiplied out nothing cancels for small g, and g =
// 0 is no special case.
HWY_INLINE Vec3 sample_phase(VF g, VF u, VF v) {
  const VF one = splat(1.0f), x = hn::MulSub(splat(2.0f), u, one);
  const VF x2 = hn::Mul(x, x), g2 = hn::Mul(g, g);
  const VF even = hn::MulAdd(g2, hn::Sub(x2, one), hn::Add(x2, splat(3.0f)));
  const VF sum = hn::MulAdd(g, even, hn::Mul(hn::Mul(splat(2.0f), x), hn::Add(one, g2)));
  const VF s = hn::MulAdd(g, x, one);
  const VF cos_theta = clamp(hn::Div(sum, hn::Mul(splat(2.0f), hn::Mul(s, s))), -1.0f, 1.0f);
  const VF sin_theta = safe_sqrt(hn::NegMulAdd(cos_theta, cos_theta, one));
  const SinCos phi = sincos_2pi(v);
  return {hn::Mul(sin_theta, phi.cos), hn::Mul(sin_theta, phi.sin), cos_theta};
}

// The same of both lobes: the value and the pdf, per solid angle. Twins: those of reference::PhaseLobes. Relative error
// below that of the narrower lobe.
HWY_INLINE VF eval_phase(VF cos_theta, const PhaseLobes& lobes) {
  const VF first = eval_phase(cos_theta, lobes.g), second = eval_phase(cos_theta, lobes.g2);
  return hn::MulAdd(lobes.g2_share, hn::Sub(second, first), first);
}
// `choice` in [0, 1): below g2_share by the second lobe.
HWY_INLINE Vec3 sample_phase(const PhaseLobes& lobes, VF choice, VF u, VF v) {
  return sample_phase(hn::IfThenElse(hn::Lt(choice, lobes.g2_share), lobes.g2, lobes.g), u, v);
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
