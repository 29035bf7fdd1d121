// The vector vocabulary: three columns' worth of lanes as one value. Included once per instruction set
// (Highway's foreach_target), hence the toggling guard.
#if defined(METAMER_ENGINE_SIMD_VEC3_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_ENGINE_SIMD_VEC3_INL_H_
#undef METAMER_ENGINE_SIMD_VEC3_INL_H_
#else
#define METAMER_ENGINE_SIMD_VEC3_INL_H_
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Every kernel works on full vectors of these: 4 lanes on SSE4 and NEON, 8 on AVX2, 16 on AVX-512.
using FloatTag = hn::ScalableTag<float>;
using UintTag = hn::RebindToUnsigned<FloatTag>;
using IntTag = hn::RebindToSigned<FloatTag>;
using VF = hn::Vec<FloatTag>;
using VU = hn::Vec<UintTag>;
using VI = hn::Vec<IntTag>;
using MF = hn::Mask<FloatTag>;

struct Vec3 {
  VF x, y, z;
};

HWY_INLINE VF splat(float value) { return hn::Set(FloatTag(), value); }
HWY_INLINE VU splat_u(uint32_t value) { return hn::Set(UintTag(), value); }

HWY_INLINE Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vec3 operator*(const Vec3& a, VF s) { return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)}; }
HWY_INLINE Vec3 operator-(const Vec3& a) { return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)}; }

// a * s + b, fused where the machine has it.
HWY_INLINE Vec3 mul_add(const Vec3& a, VF s, const Vec3& b) {
  return {hn::MulAdd(a.x, s, b.x), hn::MulAdd(a.y, s, b.y), hn::MulAdd(a.z, s, b.z)};
}
HWY_INLINE VF dot(const Vec3& a, const Vec3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
HWY_INLINE Vec3 normalize(const Vec3& a) { return a * hn::Div(splat(1.0f), hn::Sqrt(dot(a, a))); }
HWY_INLINE Vec3 if_then_else(MF mask, const Vec3& yes, const Vec3& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}

// An orthonormal frame around a unit normal: local z is the normal.
// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
struct Frame {
  Vec3 s, t, n;
};
HWY_INLINE Frame make_frame(const Vec3& n) {
  const VF sign = hn::CopySign(splat(1.0f), n.z);
  const VF a = hn::Div(splat(-1.0f), hn::Add(sign, n.z));
  const VF b = hn::Mul(hn::Mul(n.x, n.y), a);
  return {{hn::MulAdd(hn::Mul(sign, n.x), hn::Mul(n.x, a), splat(1.0f)), hn::Mul(sign, b), hn::Neg(hn::Mul(sign, n.x))},
          {b, hn::MulAdd(hn::Mul(n.y, n.y), a, sign), hn::Neg(n.y)},
          n};
}
HWY_INLINE Vec3 to_local(const Frame& f, const Vec3& v) { return {dot(v, f.s), dot(v, f.t), dot(v, f.n)}; }
HWY_INLINE Vec3 to_world(const Frame& f, const Vec3& v) { return mul_add(f.s, v.x, mul_add(f.t, v.y, f.n * v.z)); }

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
