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

// `value` in units of 2^unit_log2. Exact where |value| >= 2^(unit_log2 + 23); below that rounded to the nearest unit,
// ties away from zero, an error of at most half of it. |value| < 2^(unit_log2 + 127). Reads the bits alone: neither the
// rounding mode nor flush-to-zero has a say.
template <int unit_log2>
inline FixedSum to_units(float value) {
  static_assert(unit_log2 >= -64 && unit_log2 <= 0);
  const uint32_t bits = std::bit_cast<uint32_t>(value);
  // A subnormal gets a hidden bit it does not have; like everything below half a unit it then rounds to nothing.
  const uint32_t mantissa = (bits & 0x7fffffu) | 0x800000u;
  const int shift = static_cast<int>(bits >> 23 & 0xffu) - 150 - unit_log2;  // value = mantissa 2^shift units
  const int left = shift > 0 ? shift : 0;
  const int right = shift < 0 ? (shift < -31 ? 31 : -shift) : 0;
  const uint32_t half = (1u << right) >> 1;
  const auto magnitude = static_cast<unsigned __int128>((mantissa + half) >> right) << left;
  const auto sign = static_cast<unsigned __int128>(static_cast<__int128>(static_cast<int32_t>(bits) >> 31));
  return static_cast<FixedSum>((magnitude ^ sign) - sign);
}

// A recordable value in quanta: exact where |value| >= 2^-41, else at most 2^-65 cd/m^2 off.
inline FixedSum to_fixed(float value) { return to_units<-64>(value); }

// The nearest double, cd/m^2.
inline double to_double(FixedSum sum) { return static_cast<double>(sum) * 0x1p-64; }

}  // namespace metamer
