// Counter-based low-discrepancy points: SIMD twins of points.h, which says what they are; identical bits in
// every lane, and every lane may be of another pixel, sample and dimension.
#if defined(METAMER_ENGINE_SAMPLING_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_ENGINE_SAMPLING_POINTS_INL_H_
#undef METAMER_ENGINE_SAMPLING_POINTS_INL_H_
#else
#define METAMER_ENGINE_SAMPLING_POINTS_INL_H_
#endif

#include "engine/sampling/hash-inl.h"
#include "engine/sampling/points.h"
#include "engine/simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// Bytes and then the bits of each byte are reversed, the latter by looking up nibbles.
HWY_INLINE VU reverse_bits(VU x) {
  const hn::Repartition<uint8_t, UintTag> bytes;
  alignas(16) static constexpr uint8_t reversed_low[16] = {0x00, 0x80, 0x40, 0xc0, 0x20, 0xa0, 0x60, 0xe0,
                                                           0x10, 0x90, 0x50, 0xd0, 0x30, 0xb0, 0x70, 0xf0};
  alignas(16) static constexpr uint8_t reversed_high[16] = {0x00, 0x08, 0x04, 0x0c, 0x02, 0x0a, 0x06, 0x0e,
                                                            0x01, 0x09, 0x05, 0x0d, 0x03, 0x0b, 0x07, 0x0f};
  alignas(16) static constexpr uint8_t byte_order[16] = {3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12};
  const VU nibble = splat_u(0x0f0f0f0fu);
  const auto swapped = hn::TableLookupBytes(hn::BitCast(bytes, x), hn::LoadDup128(bytes, byte_order));
  const auto low = hn::And(swapped, hn::BitCast(bytes, nibble));
  const auto high = hn::BitCast(bytes, hn::And(hn::ShiftRight<4>(hn::BitCast(UintTag(), swapped)), nibble));
  return hn::BitCast(UintTag(), hn::Or(hn::TableLookupBytes(hn::LoadDup128(bytes, reversed_low), low),
                                       hn::TableLookupBytes(hn::LoadDup128(bytes, reversed_high), high)));
}

HWY_INLINE VU laine_karras_permutation(VU x, VU seed) {
  x = hn::Xor(x, hn::Mul(x, splat_u(0x3d20adeau)));
  x = hn::Add(x, seed);
  x = hn::Mul(x, hn::Or(hn::ShiftRight<16>(seed), splat_u(1)));
  x = hn::Xor(x, hn::Mul(x, splat_u(0x05526c56u)));
  return hn::Xor(x, hn::Mul(x, splat_u(0x53a22864u)));
}

HWY_INLINE VU pascal_digits(VU x) {
  x = hn::Xor(x, hn::And(hn::ShiftRight<1>(x), splat_u(0x55555555u)));
  x = hn::Xor(x, hn::And(hn::ShiftRight<2>(x), splat_u(0x33333333u)));
  x = hn::Xor(x, hn::And(hn::ShiftRight<4>(x), splat_u(0x0f0f0f0fu)));
  x = hn::Xor(x, hn::And(hn::ShiftRight<8>(x), splat_u(0x00ff00ffu)));
  return hn::Xor(x, hn::ShiftRight<16>(x));
}

// What of a sample is common to all its dimensions. Made by make_point_key only.
struct PointKey {
  VU pixel_seed;
  VU index_reversed;
};

HWY_INLINE PointKey make_point_key(VU pixel_x, VU pixel_y, VU sample, uint32_t seed) {
  const VU pixel = hn::Xor(pixel_x, hn::Or(hn::ShiftLeft<16>(pixel_y), hn::ShiftRight<16>(pixel_y)));
  const VU replicate = hn::And(sample, splat_u(replicate_count - 1));
  const VU replicate_seed = hash_u32(hn::Xor(splat_u(metamer::hash_u32(seed + 0x9e3779b9u)), replicate));
  return {hash_u32(hn::Xor(hash_u32(pixel), replicate_seed)), reverse_bits(hn::ShiftRight<2>(sample))};
}

HWY_INLINE VU dimension_seed(VU pixel_seed, VU dimension) {
  return hash_u32(hn::Xor(pixel_seed, hn::Mul(dimension, splat_u(0x9e3779b9u))));
}

// One number in [0, 1) per lane. About 45 vector instructions.
HWY_INLINE VF sample_1d(const PointKey& key, VU dimension) {
  const VU seed = dimension_seed(key.pixel_seed, dimension);
  const VU index = reverse_bits(laine_karras_permutation(key.index_reversed, seed));
  const VU seed_u = hn::Mul(seed, splat_u(points_detail::u_factor));
  return unit_float(reverse_bits(laine_karras_permutation(index, seed_u)));
}

// A point of the unit square, [0, 1)^2, per lane. About 80 vector instructions.
HWY_INLINE void sample_2d(const PointKey& key, VU dimension, VF* u, VF* v) {
  const VU seed = dimension_seed(key.pixel_seed, dimension);
  const VU index = reverse_bits(laine_karras_permutation(key.index_reversed, seed));
  const VU seed_u = hn::Mul(seed, splat_u(points_detail::u_factor));
  const VU seed_v = hn::Mul(seed, splat_u(points_detail::v_factor));
  *u = unit_float(reverse_bits(laine_karras_permutation(index, seed_u)));
  *v = unit_float(reverse_bits(laine_karras_permutation(pascal_digits(index), seed_v)));
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
