// Which low-discrepancy dimension decides what. A 1D and a 2D draw take one number each.
#pragma once
#include <cstdint>

namespace metamer {

inline constexpr uint32_t film_dimension = 0;        // 2D: where in the pixel's filter
inline constexpr uint32_t wavelength_dimension = 1;  // 2D: position within the strata, and their rotation
inline constexpr uint32_t lens_dimension = 2;        // 2D
inline constexpr uint32_t time_dimension = 3;        // 1D: when, while the shutter is open

// At each vertex, from first_bounce_dimension + depth * dimensions_per_bounce on:
inline constexpr uint32_t first_bounce_dimension = 4;
inline constexpr uint32_t dimensions_per_bounce = 8;
enum BounceDimension : uint32_t {
  light_choice_dimension,  // 1D
  light_point_dimension,   // 2D
  lobe_dimension,          // 1D: which lobe of the BSDF
  direction_dimension,     // 2D: where in the lobe
  roulette_dimension,      // 1D
  texture_dimension,       // 2D, of the first image of a texture; others have dimensions of their own
  free_path_dimension,     // 1D: how far the ray goes through volumes before it is scattered
  mix_dimension = 7,       // 1D: which of two materials; mixes within mixes have dimensions of their own
};

constexpr uint32_t bounce_dimension(uint32_t depth, BounceDimension dimension) {
  return first_bounce_dimension + depth * dimensions_per_bounce + dimension;
}

constexpr uint32_t nested_mix_dimension(uint32_t depth, uint32_t level) {
  return bounce_dimension(depth, mix_dimension) + level * 0x10000;
}

// Every image that a texture looks up has a point of its own: products of two would be biased by a common one.
constexpr uint32_t texture_image_dimension(uint32_t depth, uint32_t nth) {
  return bounce_dimension(depth, texture_dimension) + nth * 0x10000;
}

// And a number that chooses its level.
constexpr uint32_t texture_level_dimension(uint32_t depth, uint32_t nth) {
  return texture_image_dimension(depth, nth) ^ 0x80000000u;
}

}  // namespace metamer
