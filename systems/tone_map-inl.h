// The display's encoding on vectors. Additions, products, quotients and square roots only, none of them fused:
// IEEE 754 rounds each of them the same way everywhere, so every instruction set gives the same bits.
#if defined(METAMER_SYSTEMS_TONE_MAP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_TONE_MAP_INL_H_
#undef METAMER_SYSTEMS_TONE_MAP_INL_H_
#else
#define METAMER_SYSTEMS_TONE_MAP_INL_H_
#endif

#include "engine/simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// Cube root for x in [1e-3, 1]; relative error at most 2e-7. A first guess divides the exponent by three (the
// bits of a float are nearly its logarithm), then two of Halley's steps cube its error of 4 % each time.
HWY_INLINE VF cube_root(VF x) {
  const FloatTag tag;
  const VF third = hn::Mul(hn::ConvertTo(tag, hn::BitCast(IntTag(), x)), splat(1.0f / 3.0f));
  const VI guess = hn::Add(hn::ConvertTo(IntTag(), third), hn::Set(IntTag(), 0x2a5119f2));
  VF y = hn::BitCast(tag, guess);
  for (int step = 0; step < 2; ++step) {
    const VF cube = hn::Mul(hn::Mul(y, y), y);
    y = hn::Mul(y, hn::Div(hn::Add(cube, hn::Add(x, x)), hn::Add(hn::Add(cube, cube), x)));
  }
  return y;
}

// The sRGB curve of IEC 61966-2-1, linear to encoded, [0, 1] to [0, 1]. Below 0 and not-a-number give 0, above
// 1 gives 1. Absolute error at most 4e-7, against srgb_encode_scalar.
HWY_INLINE VF srgb_encode(VF linear) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f), knee = splat(0.0031308f);
  VF x = hn::IfThenElse(hn::Gt(linear, zero), linear, zero);  // false for not-a-number
  x = hn::IfThenElse(hn::Lt(x, one), x, one);
  const VF above = hn::IfThenElse(hn::Gt(x, knee), x, knee);
  // x^(1/2.4) = x^(5/12) = x^(1/4) x^(1/6), the latter the cube root of the square root.
  const VF root = hn::Sqrt(above);
  const VF power = hn::Mul(hn::Sqrt(root), cube_root(root));
  const VF curve = hn::Sub(hn::Mul(splat(1.055f), power), splat(0.055f));
  const VF encoded = hn::IfThenElse(hn::Gt(x, knee), curve, hn::Mul(splat(12.92f), x));
  return hn::IfThenElse(hn::Lt(encoded, one), encoded, one);
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
