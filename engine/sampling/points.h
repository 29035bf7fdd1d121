// Counter-based low-discrepancy points, scalar. The SIMD twins in points-inl.h give identical bits.
//
// Sample k of a pixel belongs to replicate k mod 4 and is point k / 4 of it. Every (pixel, replicate,
// dimension) has its own randomisation, so the replicates are independent estimates. Within one, a dimension
// is padded: its points are the first two Sobol dimensions (or van der Corput's, which is the first of them)
// under a nested uniform ("Owen") scramble, their order under another. Hence the first 2^m points of a
// replicate are a (0, m, 2)-net in every sample_2d, and one per stratum of 2^-m in every sample_1d, for any m up
// to 24.
//
// Laine and Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011 (scrambling by a hash whose
// low bits affect only higher ones, on reversed bits); Burley, "Practical Hash-based Owen Scrambling", JCGT
// 9(4), 2020 (padding and shuffling); the hash is N. Vegdahl's "Building a Better LK Hash", 2021.
#pragma once
#include <cstdint>

#include "engine/sampling/hash.h"

namespace metamer {

inline constexpr uint32_t replicate_count = 4;

constexpr uint32_t reverse_bits(uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  return (x >> 16) | (x << 16);
}

// A permutation of 32-bit integers in which bit b of the result depends on bits 0 to b of x only: on reversed
// bits, a nested uniform scramble. The seed should look random in all its bits.
constexpr uint32_t laine_karras_permutation(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  return x ^ (x * 0x53a22864u);
}

// The second Sobol dimension's generator matrix is Pascal's triangle modulo 2: output digit k (0: the most
// significant) is the sum over j of C(j, k) times index bit j, and C(j, k) is odd where the bits of k are a
// subset of those of j (Lucas). So the sum over supersets, in log2(32) steps; the result has digit k in bit k.
constexpr uint32_t pascal_digits(uint32_t x) {
  x ^= (x & 0xaaaaaaaau) >> 1;
  x ^= (x & 0xccccccccu) >> 2;
  x ^= (x & 0xf0f0f0f0u) >> 4;
  x ^= (x & 0xff00ff00u) >> 8;
  return x ^ (x >> 16);
}

// What of a sample is common to all its dimensions. Made by make_point_key only.
struct PointKeyScalar {
  uint32_t pixel_seed = 0;      // of (seed, pixel, replicate)
  uint32_t index_reversed = 0;  // point number within the replicate, bits reversed
};

// Pixels below 65536 in both coordinates have distinct seeds within one replicate; the replicates of one pixel
// have distinct seeds always.
constexpr PointKeyScalar make_point_key(uint32_t pixel_x, uint32_t pixel_y, uint32_t sample, uint32_t seed) {
  const uint32_t pixel = pixel_x ^ ((pixel_y << 16) | (pixel_y >> 16));
  const uint32_t replicate_seed = hash_u32(hash_u32(seed + 0x9e3779b9u) ^ (sample % replicate_count));
  return {hash_u32(hash_u32(pixel) ^ replicate_seed), reverse_bits(sample / replicate_count)};
}

struct Point2 {
  float u = 0, v = 0;
};

namespace points_detail {
// Bijective in each argument for the other fixed; seeds of order and value scrambles derive from it.
constexpr uint32_t dimension_seed(uint32_t pixel_seed, uint32_t dimension) {
  return hash_u32(pixel_seed ^ (dimension * 0x9e3779b9u));
}
inline constexpr uint32_t u_factor = 0x8d2f5a6du;  // odd: decorrelate the seeds of one dimension's scrambles
inline constexpr uint32_t v_factor = 0xe4a7c1b3u;
}  // namespace points_detail

// One number in [0, 1). Every call of a sample takes its own dimension number, any 32-bit integer, whether it
// draws one number or two.
constexpr float sample_1d(const PointKeyScalar& key, uint32_t dimension) {
  const uint32_t seed = points_detail::dimension_seed(key.pixel_seed, dimension);
  const uint32_t index = reverse_bits(laine_karras_permutation(key.index_reversed, seed));
  return unit_float(reverse_bits(laine_karras_permutation(index, seed * points_detail::u_factor)));
}

// A point of the unit square, [0, 1)^2.
constexpr Point2 sample_2d(const PointKeyScalar& key, uint32_t dimension) {
  const uint32_t seed = points_detail::dimension_seed(key.pixel_seed, dimension);
  const uint32_t index = reverse_bits(laine_karras_permutation(key.index_reversed, seed));
  const uint32_t u = laine_karras_permutation(index, seed * points_detail::u_factor);
  const uint32_t v = laine_karras_permutation(pascal_digits(index), seed * points_detail::v_factor);
  return {unit_float(reverse_bits(u)), unit_float(reverse_bits(v))};
}

}  // namespace metamer
