// What the oracle knows of lights: their spectra, the sky, and a plain way to choose a point of them.
#pragma once
#include <limits>
#include <random>

#include "systems/bsdf/reference.h"
#include "tests/reference_scene.h"

namespace metamer {

class ReferenceRandom {
 public:
  explicit ReferenceRandom(uint32_t seed) : generator_(seed) {}
  double operator()() { return uniform_(generator_); }  // in [0, 1)

 private:
  std::mt19937_64 generator_;
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

using reference::Spectrum4;

Spectrum4 reference_spectrum(const World& world, uint32_t id, const Spectrum4& lambda_nm);
// Of a light that is no image, W m^-2 sr^-1 nm^-1 (or what its kind is measured in).
Spectrum4 reference_radiance(const World& world, const LightRow& row, const Spectrum4& lambda_nm);
// What an area light's row emits at an angle of this cosine to its normal.
Spectrum4 reference_emission(const World& world, const LightRow& row, double cos_light, const Spectrum4& lambda_nm);
// From the discs at infinity, along a direction away from the scene.
Spectrum4 reference_disks(const World& world, const Vector& direction, const Spectrum4& lambda_nm);
// From all environments likewise, as far as they are seen from `origin`.
Spectrum4 reference_environment(const World& world, const Vector& origin, const Vector& direction,
                                const Spectrum4& lambda_nm);
// The image of a goniometric light or a projection, as it is sent along a direction; 1 of other lights.
Spectrum4 reference_light_image(const World& world, uint32_t light, const Vector& direction,
                                const Spectrum4& lambda_nm);

struct ReferenceLightPoint {
  Vector direction;
  double distance = std::numeric_limits<double>::infinity();
  double factor = 0;  // on the light's spectrum: what of it arrives, divided by the density
};

// A point of a light that is no environment, uniformly by area (of the unit sphere it is the image of).
ReferenceLightPoint reference_light_point(const LightRow& row, const Vector& from, ReferenceRandom& random);
// Uniform over all directions, for environments.
Vector reference_direction(ReferenceRandom& random);

}  // namespace metamer
