// SIMD gradient noise. Twin: systems/noise.h. Within 4e-6 of it for |p| up to 100, and of the sums for eight octaves
// (rounding of 1.99^i p) within 2e-5 for |p| up to 10; tested in noise_test.
#if defined(METAMER_SYSTEMS_NOISE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_NOISE_INL_H_
#undef METAMER_SYSTEMS_NOISE_INL_H_
#else
#define METAMER_SYSTEMS_NOISE_INL_H_
#endif

#include "engine/simd/vec3-inl.h"
#include "systems/noise.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// A coordinate's place in its cell, and the cell's number from 0 to 255. Floats: the differences are exact.
struct NoiseCell {
  VF at, fade;
  VI cell;
};
HWY_INLINE NoiseCell noise_cell(VF x) {
  const VF floor = hn::Floor(x);
  const VF wrapped = hn::NegMulAdd(hn::Floor(hn::Mul(floor, splat(1.0f / 256))), splat(256.0f), floor);
  const VF t = hn::Sub(x, floor);
  const VF quintic = hn::MulAdd(t, hn::MulAdd(t, splat(6.0f), splat(-15.0f)), splat(10.0f));
  return {t, hn::Mul(hn::Mul(hn::Mul(t, t), t), quintic),
          hn::And(hn::ConvertTo(IntTag(), wrapped), hn::Set(IntTag(), 255))};
}

HWY_INLINE VI permuted(VI index) {
  return hn::BitCast(IntTag(), hn::GatherIndex(UintTag(), noise_permutation().data(), index));
}

HWY_INLINE VF along_gradient(VI hash, VF x, VF y, VF z) {
  const VI h = hn::And(hash, hn::Set(IntTag(), 15));
  const auto less_than = [&](int32_t bound) { return hn::RebindMask(FloatTag(), hn::Lt(h, hn::Set(IntTag(), bound))); };
  const MF is_extra = hn::AndNot(less_than(12), less_than(14));
  const VF u = hn::IfThenElse(hn::Or(less_than(8), is_extra), x, y);
  const VF v = hn::IfThenElse(hn::Or(less_than(4), is_extra), y, z);
  // The lowest two bits are the signs.
  const VF u_sign = hn::BitCast(FloatTag(), hn::ShiftLeft<31>(h));
  const VF v_sign = hn::BitCast(FloatTag(), hn::ShiftLeft<31>(hn::ShiftRight<1>(h)));
  return hn::Add(hn::Xor(u, u_sign), hn::Xor(v, v_sign));
}

HWY_INLINE VF noise(const Vec3& p) {
  const NoiseCell x = noise_cell(p.x), y = noise_cell(p.y), z = noise_cell(p.z);
  const VI one = hn::Set(IntTag(), 1);
  const VF unit = splat(1.0f);
  const auto lerp = [](VF t, VF a, VF b) { return hn::MulAdd(t, hn::Sub(b, a), a); };
  VF row[2], plane[2];
  VI by_x[2] = {permuted(x.cell), permuted(hn::Add(x.cell, one))};
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 2; ++j) {
      VF corner[2];
      for (int i = 0; i < 2; ++i) {
        const VI by_y = permuted(hn::Add(by_x[i], j == 0 ? y.cell : hn::Add(y.cell, one)));
        const VI hash = permuted(hn::Add(by_y, k == 0 ? z.cell : hn::Add(z.cell, one)));
        corner[i] = along_gradient(hash, i == 0 ? x.at : hn::Sub(x.at, unit), j == 0 ? y.at : hn::Sub(y.at, unit),
                                   k == 0 ? z.at : hn::Sub(z.at, unit));
      }
      row[j] = lerp(x.fade, corner[0], corner[1]);
    }
    plane[k] = lerp(y.fade, row[0], row[1]);
  }
  return lerp(z.fade, plane[0], plane[1]);
}

// Sums of noise, or of its magnitude, at frequencies 1.99^i with weights roughness^i.
template <bool magnitude>
HWY_INLINE VF sum_octaves(const Vec3& p, float roughness, uint32_t octaves) {
  VF sum = hn::Zero(FloatTag());
  float frequency = 1, weight = 1;
  for (uint32_t i = 0; i < octaves; ++i, frequency *= 1.99f, weight *= roughness) {
    const VF value = noise(p * splat(frequency));
    sum = hn::MulAdd(splat(weight), magnitude ? hn::Abs(value) : value, sum);
  }
  return sum;
}
HWY_INLINE VF fbm(const Vec3& p, float roughness, uint32_t octaves) {
  return sum_octaves<false>(p, roughness, octaves);
}
HWY_INLINE VF turbulence(const Vec3& p, float roughness, uint32_t octaves) {
  return sum_octaves<true>(p, roughness, octaves);
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
