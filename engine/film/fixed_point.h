// The film's numbers: 128-bit two's-complement fixed point with a quantum of 2^-64 cd/m^2. Integer addition
// is associative and commutative, so a sum does not depend on the order in which threads arrive.
#pragma once
#include <bit>
#include <cstdint>

namespace metamer {

using FixedSum = __int128;

inline constexpr float fixed_quantum = 0x1p-64f;  // cd/m^2
inline constexpr float sample_limit = 0x1p40f;    // cd/m^2; the largest magnitude a film accepts

// Whether a film can hold `value`: a number, finite, |value| <= sample_limit. As integers, the magnitudes of
// infinity and of every NaN lie above all numbers, so one comparison decides.
inline bool is_recordable(float value) {
  return (std::bit_cast<uint32_t>(value) & 0x7fffffffu) <= std::bit_cast<uint32_t>(sample_limit);
}

// `value` in quanta, for a recordable value. Exact where |value| >= 2^-41; below that rounded to the nearest
// quantum, ties away from zero, an error of at most 2^-65 cd/m^2. Reads the bits alone: neither the rounding
// mode nor flush-to-zero has a say.
inline FixedSum to_fixed(float value) {
  const uint32_t bits = std::bit_cast<uint32_t>(value);
  // A subnormal gets a hidden bit it does not have; like everything below 2^-65 it then rounds to nothing.
  const uint32_t mantissa = (bits & 0x7fffffu) | 0x800000u;
  const int shift = static_cast<int>(bits >> 23 & 0xffu) - 86;  // value = mantissa 2^shift quanta
  const int left = shift > 0 ? shift : 0;
  const int right = shift < 0 ? (shift < -31 ? 31 : -shift) : 0;
  const uint32_t half = (1u << right) >> 1;
  const auto magnitude = static_cast<unsigned __int128>((mantissa + half) >> right) << left;
  const auto sign = static_cast<unsigned __int128>(static_cast<__int128>(static_cast<int32_t>(bits) >> 31));
  return static_cast<FixedSum>((magnitude ^ sign) - sign);
}

// The nearest double, cd/m^2.
inline double to_double(FixedSum sum) { return static_cast<double>(sum) * 0x1p-64; }

}  // namespace metamer
