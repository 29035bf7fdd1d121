// Gradient noise and its sums: the double-precision twin of noise-inl.h, and the table that both use.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

namespace metamer {

// K. Perlin, "Improving Noise" (SIGGRAPH 2002): his permutation of 0..255, twice in a row.
std::span<const uint32_t, 512> noise_permutation();

namespace reference {

// Perlin's noise of 2002 with pbrt-v4's numbering of the twelve gradients (pbrt.org, util/noise.cpp): 0 on all lattice
// points, within -1..1, of period 256. Any finite point.
double noise(const glm::dvec3& p);

// roughness^i noise(1.99^i p), i below `octaves`.
double fbm(const glm::dvec3& p, double roughness, uint32_t octaves);

// The same of |noise|.
double turbulence(const glm::dvec3& p, double roughness, uint32_t octaves);

}  // namespace reference
}  // namespace metamer
