// SIMD twins of hash.h: identical integers in every lane.
#if defined(METAMER_ENGINE_SAMPLING_HASH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_ENGINE_SAMPLING_HASH_INL_H_
#undef METAMER_ENGINE_SAMPLING_HASH_INL_H_
#else
#define METAMER_ENGINE_SAMPLING_HASH_INL_H_
#endif

#include "engine/simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

HWY_INLINE VU hash_u32(VU x) {
  x = hn::Xor(x, hn::ShiftRight<16>(x));
  x = hn::Mul(x, splat_u(0x21f0aaadu));
  x = hn::Xor(x, hn::ShiftRight<15>(x));
  x = hn::Mul(x, splat_u(0xd35a2d97u));
  return hn::Xor(x, hn::ShiftRight<15>(x));
}

HWY_INLINE VU hash_combine(VU a, VU b) { return hash_u32(hn::Xor(hash_u32(hn::Add(a, splat_u(0x9e3779b9u))), b)); }

// The top 24 bits as a number in [0, 1); never 1.
HWY_INLINE VF unit_float(VU x) {
  const VI top = hn::BitCast(IntTag(), hn::ShiftRight<8>(x));
  return hn::Mul(hn::ConvertTo(FloatTag(), top), splat(0x1p-24f));
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
