// The tone curves on vectors, see tone_curve.h for their formulas. Additions, products, quotients, conversions and bit
// operations only, none of them fused: every instruction set gives the same bits.
#if defined(METAMER_SYSTEMS_TONE_CURVE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_TONE_CURVE_INL_H_
#undef METAMER_SYSTEMS_TONE_CURVE_INL_H_
#else
#define METAMER_SYSTEMS_TONE_CURVE_INL_H_
#endif

#include "engine/simd/vec3-inl.h"
#include "systems/tone_curve.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// c[0] + c[1] x + ..., each step rounded.
template <size_t N>
HWY_INLINE VF rounded_polynomial(VF x, const float (&c)[N]) {
  VF sum = splat(c[N - 1]);
  for (size_t i = N - 1; i-- > 0;) sum = hn::Add(hn::Mul(sum, x), splat(c[i]));
  return sum;
}

// Base-2 logarithm of a normal x > 0, absolute error at most 3e-7 + 1.2e-7 |log2 x|. x = m 2^e with m in
// [sqrt(1/2), sqrt(2)); log m = 2 artanh(s), s = (m - 1) / (m + 1), by its series.
HWY_INLINE VF rounded_log2(VF x) {
  const VI bits = hn::BitCast(IntTag(), x);
  const VI exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(IntTag(), 0x3f3504f3)));
  const VF m = hn::BitCast(FloatTag(), hn::Sub(bits, hn::ShiftLeft<23>(exponent)));
  const VF s = hn::Div(hn::Sub(m, splat(1.0f)), hn::Add(m, splat(1.0f)));
  constexpr float two_over_ln2 = 2.88539008f;
  const VF series = rounded_polynomial(
      hn::Mul(s, s), {two_over_ln2, two_over_ln2 / 3, two_over_ln2 / 5, two_over_ln2 / 7, two_over_ln2 / 9});
  return hn::Add(hn::ConvertTo(FloatTag(), exponent), hn::Mul(s, series));
}

// 2^x for x in [-126, 126], relative error at most 3e-7.
HWY_INLINE VF rounded_exp2(VF x) {
  const VI whole = hn::NearestInt(x);
  const VF f = hn::Mul(hn::Sub(x, hn::ConvertTo(FloatTag(), whole)), splat(0.693147181f));  // |f| <= ln(2) / 2
  const VF power =
      rounded_polynomial(f, {1.0f, 1.0f, 1.0f / 2, 1.0f / 6, 1.0f / 24, 1.0f / 120, 1.0f / 720, 1.0f / 5040});
  const VI scaled = hn::Add(hn::BitCast(IntTag(), power), hn::ShiftLeft<23>(whole));
  return hn::BitCast(FloatTag(), scaled);
}

// x^2.2 for x in [0, 1e10]; 0 below 1e-15. Relative error at most 6e-6, for x in [1e-3, 2] 2e-6.
HWY_INLINE VF power_2_2(VF x) {
  const VF least = splat(1e-15f);
  const VF power = rounded_exp2(hn::Mul(rounded_log2(hn::Max(x, least)), splat(2.2f)));
  return hn::IfThenElseZero(hn::Gt(x, least), power);
}

// Not-a-number becomes 0, and what is beyond brightest_exposed in magnitude becomes that: nothing overflows after.
HWY_INLINE VF tamed(VF x) {
  const VF high = splat(brightest_exposed), low = splat(-brightest_exposed);
  x = hn::IfThenZeroElse(hn::IsNaN(x), x);
  x = hn::IfThenElse(hn::Lt(x, high), x, high);
  return hn::IfThenElse(hn::Gt(x, low), x, low);
}

HWY_INLINE VF positive(VF x) { return hn::IfThenElseZero(hn::Gt(x, hn::Zero(FloatTag())), x); }

HWY_INLINE Vec3 times(const float (&m)[9], const Vec3& v) {
  const auto row = [&](size_t i) {
    return hn::Add(hn::Add(hn::Mul(splat(m[i]), v.x), hn::Mul(splat(m[i + 1]), v.y)), hn::Mul(splat(m[i + 2]), v.z));
  };
  return {row(0), row(3), row(6)};
}

// f(2 x) / f(11.2) with both fractions of f on one denominator, so that nothing cancels near 0.
HWY_INLINE VF hable_component(VF x, const ToneConstants& c) {
  const VF y = hn::Mul(positive(x), splat(c.hable_bias));
  const VF ay = hn::Mul(y, splat(c.hable_a));
  const VF over = hn::Mul(y, hn::Add(hn::Mul(ay, splat(c.hable_square)), splat(c.hable_linear)));
  const VF under = hn::Add(hn::Mul(y, hn::Add(ay, splat(c.hable_b))), splat(c.hable_df));
  return hn::Div(over, under);
}

HWY_INLINE VF filmic_component(VF x) {
  const VF y = positive(hn::Sub(x, splat(0.004f)));
  const VF over = hn::Mul(y, hn::Add(hn::Mul(y, splat(6.2f)), splat(0.5f)));
  const VF under = hn::Add(hn::Mul(y, hn::Add(hn::Mul(y, splat(6.2f)), splat(1.7f))), splat(0.06f));
  return power_2_2(hn::Div(over, under));
}

HWY_INLINE VF agx_contrast(VF x, const ToneConstants& c) {
  const VF log2 = rounded_log2(hn::Max(x, splat(1e-30f)));
  const VF above = hn::Sub(hn::Min(hn::Max(log2, splat(c.agx_least)), splat(c.agx_most)), splat(c.agx_least));
  return rounded_polynomial(hn::Mul(above, splat(c.agx_scale)), c.agx_polynomial);
}

// Luminance, 0 where it is negative.
HWY_INLINE VF luminance_of(const Vec3& rgb, const ToneConstants& c) {
  const VF rg = hn::Add(hn::Mul(splat(c.luminance[0]), rgb.x), hn::Mul(splat(c.luminance[1]), rgb.y));
  return positive(hn::Add(rg, hn::Mul(splat(c.luminance[2]), rgb.z)));
}

// What is negative goes towards the grey of the same luminance until nothing is, see into_gamut; all of it is black
// where luminance is not above 0. Relative to the largest component within 1e-6 of into_gamut.
HWY_INLINE Vec3 desaturated(const Vec3& rgb, const ToneConstants& c) {
  const VF least = hn::Min(hn::Min(rgb.x, rgb.y), hn::Min(rgb.z, hn::Zero(FloatTag())));
  const VF luminance = luminance_of(rgb, c);
  const VF below = hn::Sub(luminance, least);  // 0 only where all is black
  const VF keep = hn::Div(luminance, hn::Max(below, splat(1e-37f)));
  const auto outside = hn::Lt(least, hn::Zero(FloatTag()));
  const auto moved = [&](VF v) {
    const VF mixed = hn::Add(luminance, hn::Mul(keep, hn::Sub(v, luminance)));
    return hn::IfThenElse(outside, positive(mixed), v);
  };
  return {moved(rgb.x), moved(rgb.y), moved(rgb.z)};
}

// The curve of exposed colour. Components up to 2^60 in magnitude. Against tone_curve_scalar, with M the largest
// magnitude of the three components there and at least 1: linear exact; reinhard 3e-7 M, reinhard-extended and hable
// 5e-7 M, filmic 3e-6 M, agx 2e-5 M.
template <ToneCurve curve>
HWY_INLINE Vec3 tone_curve(const Vec3& rgb, const ToneConstants& c) {
  if constexpr (curve == ToneCurve::reinhard) {
    return rgb * hn::Div(splat(1.0f), hn::Add(splat(1.0f), luminance_of(rgb, c)));
  } else if constexpr (curve == ToneCurve::reinhard_extended) {
    const VF luminance = luminance_of(rgb, c);
    const VF bright = hn::Add(splat(1.0f), hn::Mul(luminance, splat(c.reinhard_inverse_white_squared)));
    return rgb * hn::Div(bright, hn::Add(splat(1.0f), luminance));
  } else if constexpr (curve == ToneCurve::hable) {
    return {hable_component(rgb.x, c), hable_component(rgb.y, c), hable_component(rgb.z, c)};
  } else if constexpr (curve == ToneCurve::filmic) {
    return {filmic_component(rgb.x), filmic_component(rgb.y), filmic_component(rgb.z)};
  } else if constexpr (curve == ToneCurve::agx) {
    const Vec3 srgb = times(c.to_srgb, rgb);
    const Vec3 in = times(c.agx_inset, {positive(srgb.x), positive(srgb.y), positive(srgb.z)});
    const Vec3 out = times(c.agx_outset, {agx_contrast(in.x, c), agx_contrast(in.y, c), agx_contrast(in.z, c)});
    return times(c.from_srgb, {power_2_2(positive(out.x)), power_2_2(positive(out.y)), power_2_2(positive(out.z))});
  } else {
    return rgb;
  }
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
