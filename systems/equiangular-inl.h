// Where along a ray light of a point is scattered: C. Kulla, M. Fajardo, "Importance Sampling Techniques for Path
// Tracing in Participating Media", CGF 31(4), 2012, section 3. Equal angles seen from the light are equally likely, so
// the inverse square of the distance to it is no noise.
#if defined(METAMER_SYSTEMS_EQUIANGULAR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_EQUIANGULAR_INL_H_
#undef METAMER_SYSTEMS_EQUIANGULAR_INL_H_
#else
#define METAMER_SYSTEMS_EQUIANGULAR_INL_H_
#endif

#include "engine/simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// Along a ray from its origin to infinity, of unit direction; metres.
struct Equiangular {
  VF nearest;   // where the ray is nearest to the light; may lie before its origin
  VF distance;  // there, to the light
  VF first;     // the angle from there to the ray's origin, as the light sees it
};
// `to_light`: from the ray's origin.
HWY_INLINE Equiangular equiangular(const Vec3& to_light, const Vec3& direction) {
  const VF nearest = dot(to_light, direction);
  const Vec3 off = to_light - direction * nearest;
  const VF far = hn::Sqrt(dot(to_light, to_light));
  const VF distance = hn::Max(hn::Sqrt(dot(off, off)), hn::Max(hn::Mul(far, splat(1e-6f)), splat(1e-30f)));
  return {nearest, distance, atan2(hn::Neg(nearest), distance)};
}
// Per metre, at `t` metres from the origin. Twin: in tests/systems/equiangular_test.cpp. Relative error below 1e-5 but
// for what single precision leaves uncertain about the distance from the light.
HWY_INLINE VF equiangular_pdf(const Equiangular& e, VF t) {
  const VF along = hn::Sub(t, e.nearest);
  const VF square = hn::MulAdd(e.distance, e.distance, hn::Mul(along, along));
  return hn::Div(e.distance, hn::Mul(hn::Sub(splat(0.5f * pi), e.first), square));
}
// Metres from the origin for u in [0, 1).
HWY_INLINE VF sample_equiangular(const Equiangular& e, VF u) {
  const VF angle = hn::MulAdd(u, hn::Sub(splat(0.5f * pi), e.first), e.first);
  const SinCos at = sincos(angle);
  return hn::MulAdd(e.distance, hn::Div(at.sin, hn::Max(at.cos, splat(1e-7f))), e.nearest);
}

// How much light that is scattered at `t` counts where a free path led there and the light was chosen with
// `probability`, light being also sought there by its angles, after a choice with the probability `chosen`; the other
// way counts the rest. The power heuristic, by free paths of the mean of the wavelengths' extinctions, so that it does
// not matter which of them leads, and as if the medium began with the ray. Lights that are many free paths away from
// the ray are left to free paths; then, and where `chosen` is 0, the result is 1.
HWY_INLINE VF free_path_share(const Equiangular& e, VF t, const VF extinction[4], uint32_t wavelengths, VF probability,
                              VF chosen) {
  const VF one = splat(1.0f);
  VF mean = hn::Zero(FloatTag());
  for (size_t j = 0; j < wavelengths; ++j) mean = hn::Add(mean, extinction[j]);
  mean = hn::Mul(mean, splat(1 / static_cast<float>(wavelengths)));
  const VF free_path = hn::Mul(mean, exp(hn::Neg(hn::Mul(mean, t))));
  const VF ratio =
      hn::Div(hn::Mul(equiangular_pdf(e, t), chosen), hn::Max(hn::Mul(free_path, probability), splat(1e-30f)));
  const VF share = hn::Div(one, hn::MulAdd(ratio, ratio, one));
  return hn::IfThenElse(hn::Lt(hn::Mul(mean, e.distance), splat(4.0f)), share, one);
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
