// Moving lanes between vectors and columns. Streams are padded, so whole vectors are read and written.
#if defined(METAMER_SYSTEMS_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_LANES_INL_H_
#undef METAMER_SYSTEMS_LANES_INL_H_
#else
#define METAMER_SYSTEMS_LANES_INL_H_
#endif

#include "engine/simd/vec3-inl.h"
#include "engine/streams.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

HWY_INLINE size_t lane_count() { return hn::Lanes(FloatTag()); }

HWY_INLINE VF load(const float* column, size_t i) { return hn::LoadU(FloatTag(), column + i); }
HWY_INLINE VU load(const uint32_t* column, size_t i) { return hn::LoadU(UintTag(), column + i); }
HWY_INLINE Vec3 load(const Columns<float, 3>& c, size_t i) { return {load(c[0], i), load(c[1], i), load(c[2], i)}; }
HWY_INLINE void load(const Columns<float, 4>& c, size_t i, VF out[4]) {
  for (size_t j = 0; j < 4; ++j) out[j] = load(c[j], i);
}

HWY_INLINE void store(VF v, float* column, size_t i) { hn::StoreU(v, FloatTag(), column + i); }
HWY_INLINE void store(VU v, uint32_t* column, size_t i) { hn::StoreU(v, UintTag(), column + i); }
HWY_INLINE void store(const Vec3& v, const Columns<float, 3>& c, size_t i) {
  store(v.x, c[0], i);
  store(v.y, c[1], i);
  store(v.z, c[2], i);
}
HWY_INLINE void store(const VF v[4], const Columns<float, 4>& c, size_t i) {
  for (size_t j = 0; j < 4; ++j) store(v[j], c[j], i);
}

HWY_INLINE VI as_index(VU index) { return hn::BitCast(IntTag(), index); }
HWY_INLINE VF gather(const float* column, VI index) { return hn::GatherIndex(FloatTag(), column, index); }
HWY_INLINE VU gather(const uint32_t* column, VI index) { return hn::GatherIndex(UintTag(), column, index); }
HWY_INLINE Vec3 gather(const Columns<float, 3>& c, VI index) {
  return {gather(c[0], index), gather(c[1], index), gather(c[2], index)};
}
// Three floats in a row: an array of structures, whose lanes share cache lines.
HWY_INLINE Vec3 gather_vec3(const float* base, VI index) {
  return {gather(base, index), gather(base + 1, index), gather(base + 2, index)};
}

HWY_INLINE MF float_mask(hn::Mask<UintTag> mask) { return hn::RebindMask(FloatTag(), mask); }
HWY_INLINE hn::Mask<UintTag> uint_mask(MF mask) { return hn::RebindMask(UintTag(), mask); }
HWY_INLINE MF is_live(VU slot) { return float_mask(hn::Ne(slot, splat_u(dead_lane))); }

// column[slot] += v where the mask is set. Slots of live lanes differ from each other.
HWY_INLINE void add_to_slots(MF mask, VF v, float* column, VU slot) {
  HWY_ALIGN float values[hn::MaxLanes(FloatTag())];
  HWY_ALIGN uint32_t rows[hn::MaxLanes(FloatTag())];
  uint8_t bits[8] = {};
  hn::Store(v, FloatTag(), values);
  hn::Store(slot, UintTag(), rows);
  hn::StoreMaskBits(FloatTag(), mask, bits);
  const uint32_t live = bits[0] | uint32_t{bits[1]} << 8;
  for (uint32_t left = live; left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    column[rows[lane]] += values[lane];
  }
}

// Writes the lanes of the mask one after another from column + at on (and rubbish behind them, up to a vector).
HWY_INLINE void append(MF mask, VF v, float* column, size_t at) {
  hn::StoreU(hn::Compress(v, mask), FloatTag(), column + at);
}
HWY_INLINE void append(MF mask, VU v, uint32_t* column, size_t at) {
  hn::StoreU(hn::Compress(v, uint_mask(mask)), UintTag(), column + at);
}
HWY_INLINE void append(MF mask, const Vec3& v, const Columns<float, 3>& c, size_t at) {
  append(mask, v.x, c[0], at);
  append(mask, v.y, c[1], at);
  append(mask, v.z, c[2], at);
}
HWY_INLINE void append(MF mask, const VF v[4], const Columns<float, 4>& c, size_t at) {
  for (size_t j = 0; j < 4; ++j) append(mask, v[j], c[j], at);
}

// What Embree takes: with assertions on, as Debian builds it, a coordinate beyond 1.8e18 or a NaN stops the program.
HWY_INLINE MF is_traceable(const Vec3& origin, const Vec3& direction) {
  const auto size = [](const Vec3& v) { return hn::Add(hn::Add(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z)); };
  return hn::And(hn::Le(size(origin), splat(1e18f)), hn::Le(size(direction), splat(4.0f)));
}

HWY_INLINE VF max_of(const VF v[4]) { return hn::Max(hn::Max(v[0], v[1]), hn::Max(v[2], v[3])); }

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
