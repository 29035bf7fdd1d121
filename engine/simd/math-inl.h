// Elementary functions on full vectors, for pixels: nothing here calls the C library, so every machine with the
// same instruction set computes the same bits. The double twins are in portable_math.h; the errors stated here
// are asserted on every instruction set by tests/engine/simd/math_test.cpp. Polynomials are minimax fits (Remez)
// of our own; range reductions follow W. Cody and W. Waite, "Software Manual for the Elementary Functions", 1980.
//
// "relative e" bounds |computed - exact| / |exact|, "absolute e" the difference. Results below the smallest normal
// number are 0, and subnormal arguments count as 0, as flush-to-zero would have it.
#if defined(METAMER_ENGINE_SIMD_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_ENGINE_SIMD_MATH_INL_H_
#undef METAMER_ENGINE_SIMD_MATH_INL_H_
#else
#define METAMER_ENGINE_SIMD_MATH_INL_H_
#endif

#include <cfloat>
#include <limits>

#include "engine/simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

inline constexpr float pi = 3.14159265f;
inline constexpr float two_pi = 6.28318531f;
inline constexpr float inverse_pi = 0.318309886f;

// sqrt(max(x, 0)): for radicands that only rounding makes negative.
HWY_INLINE VF safe_sqrt(VF x) { return hn::Sqrt(hn::Max(x, hn::Zero(FloatTag()))); }
HWY_INLINE VF clamp(VF x, float low, float high) { return hn::Min(hn::Max(x, splat(low)), splat(high)); }
HWY_INLINE VF saturate(VF x) { return clamp(x, 0.0f, 1.0f); }
// Also true for -0.
HWY_INLINE MF sign_bit_set(VF x) {
  return hn::RebindMask(FloatTag(), hn::Lt(hn::BitCast(IntTag(), x), hn::Zero(IntTag())));
}
// 1 / x, where |x| below FLT_MIN counts as FLT_MIN with x's sign (also of -0): finite for every x but NaN.
HWY_INLINE VF safe_reciprocal(VF x) {
  return hn::Div(splat(1.0f), hn::CopySign(hn::Max(hn::Abs(x), splat(FLT_MIN)), x));
}

namespace math_detail {

// c[0] + c[1] x + ...
template <size_t N>
HWY_INLINE VF polynomial(VF x, const float (&c)[N]) {
  VF sum = splat(c[N - 1]);
  for (size_t i = N - 1; i-- > 0;) sum = hn::MulAdd(sum, x, splat(c[i]));
  return sum;
}

// Adding this rounds a |x| < 2^22 to an integer, which is then in the low bits of the sum.
inline constexpr float round_magic = 0x1.8p23f;

// m 2^n for m in [0.5, 2) and n = the low bits of `rounded`, where the product is a normal number.
HWY_INLINE VF scale_by_power_of_2(VF m, VF rounded) {
  const VU n = hn::ShiftLeft<23>(hn::BitCast(UintTag(), rounded));
  return hn::BitCast(FloatTag(), hn::Add(hn::BitCast(UintTag(), m), n));
}

// 2^f, |f| <= 1/2.
HWY_INLINE VF exp2_fraction(VF f) {
  return polynomial(f,
                    {1.0f, 0.693147206f, 0.240226469f, 0.0555032871f, 0.00961848924f, 0.00133999576f, 0.000153457888f});
}

// `value` where 2^x is a normal number, 0 below and infinity above.
HWY_INLINE VF saturate_exp2(VF x, VF value) {
  value = hn::IfThenZeroElse(hn::Lt(x, splat(-126.0f)), value);
  return hn::IfThenElse(hn::Ge(x, splat(128.0f)), hn::Inf(FloatTag()), value);
}

// x = m 2^e with m in [sqrt(1/2), sqrt(2)), for normal x > 0.
HWY_INLINE void split_exponent(VF x, VF* m, VF* e) {
  const VI bits = hn::BitCast(IntTag(), x);
  const VI sqrt_half = hn::Set(IntTag(), 0x3f3504f3);
  const VI n = hn::ShiftRight<23>(hn::Sub(bits, sqrt_half));
  *m = hn::BitCast(FloatTag(), hn::Sub(bits, hn::ShiftLeft<23>(n)));
  *e = hn::ConvertTo(FloatTag(), n);
}

// What a logarithm is where its argument is no positive finite number.
HWY_INLINE VF log_special_cases(VF x, VF value) {
  value = hn::IfThenElse(hn::Lt(x, splat(FLT_MIN)), hn::Neg(hn::Inf(FloatTag())), value);
  value = hn::IfThenElse(hn::Lt(x, hn::Zero(FloatTag())), hn::NaN(FloatTag()), value);
  return hn::IfThenElse(hn::Lt(x, hn::Inf(FloatTag())), value, x);  // infinity and NaN
}

}  // namespace math_detail

// 2^x, relative 1.5e-7, for every x; 0 for x < -126, infinity for x >= 128.
HWY_INLINE VF exp2(VF x) {
  const VF bounded = clamp(x, -200.0f, 200.0f);
  const VF rounded = hn::Add(bounded, splat(math_detail::round_magic));
  const VF f = hn::Sub(bounded, hn::Sub(rounded, splat(math_detail::round_magic)));
  const VF value = math_detail::scale_by_power_of_2(math_detail::exp2_fraction(f), rounded);
  return hn::IfThenElse(hn::IsNaN(x), x, math_detail::saturate_exp2(x, value));
}

// e^x, relative 1.5e-7, for every x; 0 for x < -87.336544, infinity for x > 88.722839.
HWY_INLINE VF exp(VF x) {
  const VF bounded = clamp(x, -150.0f, 150.0f);
  const VF rounded = hn::MulAdd(bounded, splat(1.44269504f), splat(math_detail::round_magic));
  const VF n = hn::Sub(rounded, splat(math_detail::round_magic));
  // ln 2 in two parts, the first short enough that its product with n is exact.
  VF r = hn::NegMulAdd(n, splat(0.693359375f), bounded);
  r = hn::NegMulAdd(n, splat(-2.12194440e-4f), r);
  const VF tail =
      math_detail::polynomial(r, {0.499999934f, 0.166665206f, 0.0416683880f, 0.00836871688f, 0.00138145985f});
  const VF power = hn::Add(hn::MulAdd(hn::Mul(r, r), tail, r), splat(1.0f));
  VF value = math_detail::scale_by_power_of_2(power, rounded);
  value = hn::IfThenZeroElse(hn::Lt(x, splat(-87.336544f)), value);
  value = hn::IfThenElse(hn::Gt(x, splat(88.722839f)), hn::Inf(FloatTag()), value);
  return hn::IfThenElse(hn::IsNaN(x), x, value);
}

// Natural logarithm, relative 2e-7 (absolute 1e-7 near 1 suffices for that too); -infinity at 0, NaN below.
HWY_INLINE VF log(VF x) {
  VF m, e;
  math_detail::split_exponent(x, &m, &e);
  const VF f = hn::Sub(m, splat(1.0f));
  const VF f2 = hn::Mul(f, f);
  const VF tail = math_detail::polynomial(f, {0.333333126f, -0.250000096f, 0.200021187f, -0.166679959f, 0.142195525f,
                                              -0.124055884f, 0.118881608f, -0.116756541f, 0.0674664687f});
  // f - f^2/2 + f^3 tail + e ln 2, small terms first.
  VF value = hn::Mul(hn::Mul(f, f2), tail);
  value = hn::MulAdd(e, splat(-2.12194440e-4f), value);
  value = hn::NegMulAdd(f2, splat(0.5f), value);
  value = hn::MulAdd(e, splat(0.693359375f), hn::Add(f, value));
  return math_detail::log_special_cases(x, value);
}

namespace math_detail {

// y log2(m 2^e) in double precision, and 2^ of that split into n + f.
template <class DoubleTag, class HalfVector>
HWY_INLINE void pow_exponent(DoubleTag d, HalfVector m, HalfVector e, HalfVector y, HalfVector* n, HalfVector* f) {
  const hn::Rebind<float, DoubleTag> half;
  const auto md = hn::PromoteTo(d, m);
  const auto one = hn::Set(d, 1.0);
  // log2((1 + s) / (1 - s)) as an odd polynomial of s, relative 2.7e-14.
  const auto s = hn::Div(hn::Sub(md, one), hn::Add(md, one));
  const auto s2 = hn::Mul(s, s);
  auto p = hn::Set(d, 0.282899282826831814);
  p = hn::MulAdd(p, s2, hn::Set(d, 0.319905755113721783));
  p = hn::MulAdd(p, s2, hn::Set(d, 0.412209251049698123));
  p = hn::MulAdd(p, s2, hn::Set(d, 0.577077942376893426));
  p = hn::MulAdd(p, s2, hn::Set(d, 0.961796694113305938));
  p = hn::MulAdd(p, s2, hn::Set(d, 2.88539008177785001));
  const auto log2_x = hn::MulAdd(s, p, hn::PromoteTo(d, e));
  const auto product = hn::Mul(hn::PromoteTo(d, y), log2_x);
  const auto t = hn::Min(hn::Max(product, hn::Set(d, -200.0)), hn::Set(d, 200.0));
  const auto whole = hn::Round(t);
  *n = hn::DemoteTo(half, whole);
  *f = hn::DemoteTo(half, hn::Sub(t, whole));
}

}  // namespace math_detail

// x^y for x >= 0, relative 2e-7; as IEEE 754 has it at 0, 1 and infinity (0^0 = 1), NaN for x < 0.
HWY_INLINE VF pow(VF x, VF y) {
  const hn::RepartitionToWide<FloatTag> d;
  const hn::Half<FloatTag> half;
  const FloatTag whole;
  VF m, e;
  math_detail::split_exponent(x, &m, &e);
  hn::Vec<decltype(half)> n0, f0, n1, f1;
  math_detail::pow_exponent(d, hn::LowerHalf(half, m), hn::LowerHalf(half, e), hn::LowerHalf(half, y), &n0, &f0);
  math_detail::pow_exponent(d, hn::UpperHalf(half, m), hn::UpperHalf(half, e), hn::UpperHalf(half, y), &n1, &f1);
  const VF n = hn::Combine(whole, n1, n0);
  const VF f = hn::Combine(whole, f1, f0);
  VF value =
      math_detail::scale_by_power_of_2(math_detail::exp2_fraction(f), hn::Add(n, splat(math_detail::round_magic)));
  value = math_detail::saturate_exp2(hn::Add(n, f), value);

  const VF zero = hn::Zero(whole), one = splat(1.0f), inf = hn::Inf(whole);
  const MF vanishing = hn::Lt(x, splat(FLT_MIN));
  const MF infinite = hn::Eq(x, inf);
  const MF negative_y = hn::Lt(y, zero);
  value = hn::IfThenElse(vanishing, hn::IfThenElse(negative_y, inf, zero), value);
  value = hn::IfThenElse(infinite, hn::IfThenElse(negative_y, zero, inf), value);
  value = hn::IfThenElse(hn::Or(hn::Lt(x, zero), hn::Or(hn::IsNaN(x), hn::IsNaN(y))), hn::NaN(whole), value);
  return hn::IfThenElse(hn::Or(hn::Eq(y, zero), hn::Eq(x, one)), one, value);
}

struct SinCos {
  VF sin, cos;
};

// Sine and cosine of x in radians, absolute 1.5e-7 for |x| <= 3000; beyond, the error grows with |x|.
HWY_INLINE SinCos sincos(VF x) {
  const VI q = hn::NearestInt(hn::Mul(x, splat(0.636619772f)));
  const VF n = hn::ConvertTo(FloatTag(), q);
  // pi / 2 in three parts, the first two short enough that their products with n are exact.
  VF r = hn::NegMulAdd(n, splat(1.5703125f), x);
  r = hn::NegMulAdd(n, splat(4.837512969970703125e-4f), r);
  r = hn::NegMulAdd(n, splat(7.54978995489188216e-8f), r);
  const VF z = hn::Mul(r, r);
  const VF sin_tail = math_detail::polynomial(z, {-0.166666549f, 0.00833217354f, -0.000195166557f});
  const VF cos_tail = math_detail::polynomial(z, {0.0416666467f, -0.00138873615f, 2.44377302e-5f});
  const VF sin_r = hn::MulAdd(hn::Mul(z, r), sin_tail, r);
  const VF cos_r = hn::MulAdd(hn::Mul(z, z), cos_tail, hn::NegMulAdd(z, splat(0.5f), splat(1.0f)));
  const VI one = hn::Set(IntTag(), 1);
  const MF odd = hn::RebindMask(FloatTag(), hn::Eq(hn::And(q, one), one));
  const VI sin_sign = hn::ShiftLeft<30>(hn::AndNot(one, q));
  const VI cos_sign = hn::ShiftLeft<30>(hn::AndNot(one, hn::Add(q, one)));
  return {hn::Xor(hn::IfThenElse(odd, cos_r, sin_r), hn::BitCast(FloatTag(), sin_sign)),
          hn::Xor(hn::IfThenElse(odd, sin_r, cos_r), hn::BitCast(FloatTag(), cos_sign))};
}

// Sine and cosine of 2 pi u, absolute 1.2e-7 for |u| <= 1; the reduction is exact, and so are the zeros.
HWY_INLINE SinCos sincos_2pi(VF u) {
  const VI q = hn::NearestInt(hn::Mul(u, splat(4.0f)));
  const VF f = hn::NegMulAdd(hn::ConvertTo(FloatTag(), q), splat(0.25f), u);
  const VF z = hn::Mul(f, f);
  const VF sin_f = hn::Mul(f, math_detail::polynomial(z, {6.28318529f, -41.3416626f, 81.5925535f, -75.4020680f}));
  const VF cos_f = math_detail::polynomial(z, {1.0f, -19.7392087f, 64.9393162f, -85.4428521f, 59.2204073f});
  const VI one = hn::Set(IntTag(), 1);
  const MF odd = hn::RebindMask(FloatTag(), hn::Eq(hn::And(q, one), one));
  const VI sin_sign = hn::ShiftLeft<30>(hn::AndNot(one, q));
  const VI cos_sign = hn::ShiftLeft<30>(hn::AndNot(one, hn::Add(q, one)));
  return {hn::Xor(hn::IfThenElse(odd, cos_f, sin_f), hn::BitCast(FloatTag(), sin_sign)),
          hn::Xor(hn::IfThenElse(odd, sin_f, cos_f), hn::BitCast(FloatTag(), cos_sign))};
}

// The angle of (x, y) in [-pi, pi], absolute 5e-7; signed zeros as in C, atan2(0, 0) = 0. Finite arguments.
HWY_INLINE VF atan2(VF y, VF x) {
  const VF ax = hn::Abs(x), ay = hn::Abs(y);
  const VF t = hn::Div(hn::Min(ax, ay), hn::Max(hn::Max(ax, ay), splat(FLT_MIN)));
  const VF angle = hn::Mul(
      t, math_detail::polynomial(hn::Mul(t, t), {0.999999985f, -0.333330733f, 0.199926194f, -0.142036446f, 0.106409343f,
                                                 -0.0750429473f, 0.0426915183f, -0.0160686267f, 0.00284988883f}));
  const VF octant = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(splat(pi * 0.5f), angle), angle);
  const MF left = sign_bit_set(x);
  return hn::CopySign(hn::IfThenElse(left, hn::Sub(splat(pi), octant), octant), y);
}

// Arc cosine, absolute 4e-7 (relative 3e-7 for x > 0.5, down to the smallest angles); |x| beyond 1 counts as 1.
HWY_INLINE VF acos(VF x) {
  const VF a = hn::Abs(x);
  const MF steep = hn::Gt(a, splat(0.5f));
  // asin(s) for s <= 1/2; steep angles by acos(a) = 2 asin(sqrt((1 - a) / 2)).
  const VF z =
      hn::IfThenElse(steep, hn::Max(hn::NegMulAdd(a, splat(0.5f), splat(0.5f)), hn::Zero(FloatTag())), hn::Mul(a, a));
  const VF s = hn::IfThenElse(steep, hn::Sqrt(z), a);
  const VF tail =
      math_detail::polynomial(z, {0.166667539f, 0.0749524178f, 0.0454770974f, 0.0241476079f, 0.0422185560f});
  const VF arc_sine = hn::MulAdd(hn::Mul(s, z), tail, s);
  const VF doubled = hn::Add(arc_sine, arc_sine);
  const MF negative = sign_bit_set(x);
  return hn::IfThenElse(steep, hn::IfThenElse(negative, hn::Sub(splat(pi), doubled), doubled),
                        hn::Sub(splat(pi * 0.5f), hn::CopySign(arc_sine, x)));
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
