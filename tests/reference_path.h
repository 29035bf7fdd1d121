// The oracle: a plain scalar depth-first ray tracer in double precision over the same frozen world, by the integrator
// of its settings, for the stream pipeline to agree with. It shares with the pipeline the world's columns, the
// spectra's double-precision twins and the scalar BSDFs of systems/bsdf/reference.h, and nothing else: brute-force
// intersection, its own random numbers, uniform choice of lights, uniform areas, no multiple importance sampling (area
// lights by sampling them alone, the environment by running into it alone, without shadows by a uniform direction), no
// roulette, no bound on what a branch carries, uniform wavelengths, and a branch per wavelength where a path disperses.
#pragma once
#include <array>
#include <vector>

#include "engine/ecs/world.h"

namespace metamer {

struct ReferencePixel {
  std::array<double, 3> mean_xyz{};          // cd/m^2
  std::array<double, 3> variance_of_mean{};  // (cd/m^2)^2
};

// Row by row from the top left; independent random samples, `seed` chooses them.
std::vector<ReferencePixel> reference_path(const World& world, uint32_t samples_per_pixel, uint32_t seed);

// Of one random camera ray of a pixel on four wavelengths of one's own, W m^-2 sr^-1 nm^-1.
std::array<double, 4> reference_pixel_radiance(const World& world, uint32_t x, uint32_t y,
                                               const std::array<double, 4>& lambda_nm, uint32_t seed);

}  // namespace metamer
