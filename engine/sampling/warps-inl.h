// SIMD twins of warps.h, which describes them. Each agrees with it to 5e-7 absolute in every coordinate, and
// pdfs to 3e-7 relative, asserted on every instruction set by tests/engine/sampling/warps_test.cpp.
#if defined(METAMER_ENGINE_SAMPLING_WARPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_ENGINE_SAMPLING_WARPS_INL_H_
#undef METAMER_ENGINE_SAMPLING_WARPS_INL_H_
#else
#define METAMER_ENGINE_SAMPLING_WARPS_INL_H_
#endif

#include "engine/simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

struct Point2V {
  VF x, y;
};
struct BarycentricV {
  VF b0, b1, b2;
};

namespace warps_detail {
// The concentric map; also the signed distance r from the centre, whose square x^2 + y^2 would round.
HWY_INLINE Point2V concentric_disk(VF u, VF v, VF* r) {
  const VF a = hn::MulSub(u, splat(2.0f), splat(1.0f));
  const VF b = hn::MulSub(v, splat(2.0f), splat(1.0f));
  const MF wide = hn::Gt(hn::Abs(a), hn::Abs(b));
  *r = hn::IfThenElse(wide, a, b);
  const VF other = hn::IfThenElse(wide, b, a);
  const VF ratio = hn::IfThenElse(hn::Eq(*r, hn::Zero(FloatTag())), *r, hn::Div(other, *r));
  const SinCos angle = sincos_2pi(hn::Mul(ratio, splat(0.125f)));
  const VF c = hn::Mul(*r, angle.cos), s = hn::Mul(*r, angle.sin);
  return {hn::IfThenElse(wide, c, s), hn::IfThenElse(wide, s, c)};
}
}  // namespace warps_detail

HWY_INLINE Point2V sample_concentric_disk(VF u, VF v) {
  VF r;
  return warps_detail::concentric_disk(u, v, &r);
}

HWY_INLINE Vec3 sample_cosine_hemisphere(VF u, VF v) {
  VF r;
  const Point2V p = warps_detail::concentric_disk(u, v, &r);
  const VF one = splat(1.0f), a = hn::Abs(r);
  return {p.x, p.y, hn::Sqrt(hn::Mul(hn::Sub(one, a), hn::Add(one, a)))};
}
HWY_INLINE VF cosine_hemisphere_pdf(VF cos_theta) {
  return hn::Mul(hn::Max(cos_theta, hn::Zero(FloatTag())), splat(inverse_pi));
}

HWY_INLINE BarycentricV sample_uniform_triangle(VF u, VF v) {
  const MF low = hn::Lt(v, u);
  const VF half_u = hn::Mul(u, splat(0.5f)), half_v = hn::Mul(v, splat(0.5f));
  const VF b0 = hn::IfThenElse(low, hn::Sub(u, half_v), half_u);
  const VF b1 = hn::IfThenElse(low, half_v, hn::Sub(v, half_u));
  return {b0, b1, hn::Sub(hn::Sub(splat(1.0f), b0), b1)};
}

HWY_INLINE Vec3 sample_uniform_sphere(VF u, VF v) {
  const VF one = splat(1.0f);
  const VF half_r = hn::Sqrt(hn::Mul(u, hn::Sub(one, u)));
  const VF r = hn::Add(half_r, half_r);
  const SinCos phi = sincos_2pi(v);
  return {hn::Mul(r, phi.cos), hn::Mul(r, phi.sin), hn::NegMulAdd(u, splat(2.0f), one)};
}
inline constexpr float uniform_sphere_pdf = 0.0795774715f;

// Relative error 3e-7, however small the angle.
HWY_INLINE VF one_minus_cos(VF sin2_theta) {
  const VF one = splat(1.0f);
  return hn::Div(sin2_theta, hn::Add(one, safe_sqrt(hn::Sub(one, sin2_theta))));
}

// x and y to 5e-7 of the cone's own radius.
HWY_INLINE Vec3 sample_uniform_cone(VF u, VF v, VF one_minus_cos_max) {
  const VF t = hn::Mul(u, one_minus_cos_max);
  const VF r = hn::Sqrt(hn::Mul(t, hn::Sub(splat(2.0f), t)));
  const SinCos phi = sincos_2pi(v);
  return {hn::Mul(r, phi.cos), hn::Mul(r, phi.sin), hn::Sub(splat(1.0f), t)};
}
// About the frame's normal.
HWY_INLINE Vec3 sample_uniform_cone(const Frame& axis, VF u, VF v, VF one_minus_cos_max) {
  return to_world(axis, sample_uniform_cone(u, v, one_minus_cos_max));
}
HWY_INLINE VF uniform_cone_pdf(VF one_minus_cos_max) { return hn::Div(splat(0.5f * inverse_pi), one_minus_cos_max); }

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
