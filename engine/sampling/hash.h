// Integer hashes, scalar. The SIMD twins in hash-inl.h give identical integers.
#pragma once
#include <cstdint>

namespace metamer {

// A bijection of 32-bit integers with low bias: every input bit flips every output bit with probability close
// to 1/2. Constants found by C. Wellons' "hash-prospector" search (two rounds, bias 0.107 of the ideal).
constexpr uint32_t hash_u32(uint32_t x) {
  x ^= x >> 16;
  x *= 0x21f0aaadu;
  x ^= x >> 15;
  x *= 0xd35a2d97u;
  return x ^ (x >> 15);
}

// Hash of an ordered pair; for either argument fixed a bijection of the other.
constexpr uint32_t hash_combine(uint32_t a, uint32_t b) { return hash_u32(hash_u32(a + 0x9e3779b9u) ^ b); }

// The top 24 bits as a number in [0, 1); never 1.
constexpr float unit_float(uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }

}  // namespace metamer
