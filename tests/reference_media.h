// What the oracle knows of being inside: a list of media as entered, of any length.
#pragma once
#include <vector>

#include "systems/bsdf/reference.h"
#include "tests/reference_lights.h"
#include "tests/reference_scene.h"

namespace metamer {

// Rows of World::media in the order of entering, and the row of World::volumes beside them.
struct ReferenceMedia : std::vector<uint32_t> {
  uint32_t volume = 0;
};

// Which of them fills the space; 0 is vacuum.
uint32_t fills(const World& world, const ReferenceMedia& media);
// The medium of the object, or 0.
uint32_t medium_of(const World& world, uint32_t object);
// Behind the surface, for a ray along `direction`.
ReferenceMedia crossed(const World& world, const ReferenceMedia& media, const ReferenceHit& hit,
                       const Vector& direction);
// What a ray is in that leaves the surface along `direction`, on whichever side.
uint32_t volume_towards(const World& world, const ReferenceMedia& media, const ReferenceHit& hit,
                        const Vector& direction);
// Per metre, at one wavelength.
struct ReferenceVolume {
  double absorption = 0, scattering = 0, glow = 0;
  double extinction() const { return absorption + scattering; }
};
ReferenceVolume volume_at(const World& world, uint32_t volume, const Vector& position, double lambda_nm);
// Light that comes against `direction` from so far away: less what is absorbed and scattered, more what glows. In a
// volume of grids by chance.
void attenuate_and_glow(const World& world, uint32_t volume, const Vector& origin, const Vector& direction,
                        const reference::Spectrum4& lambda_nm, double distance, ReferenceRandom& random,
                        reference::Spectrum4& light);
// What grids make of `there`, the volume without them; see reference_grids.h.
void vary(const World& world, uint32_t volume, const Vector& position, double lambda_nm, ReferenceVolume& there);
// A point without a surface; its local z axis is the direction of going on unscattered.
ReferenceHit place_in_volume(const Vector& position, const Vector& direction);
// What volumes let through between a point and another so many metres away, through all interfaces.
reference::Spectrum4 volume_transmittance(const ReferenceScene& scene, uint32_t volume, const Vector& origin,
                                          const Vector& direction, double distance,
                                          const reference::Spectrum4& lambda_nm, ReferenceRandom& random);
// What rays start in at the camera.
ReferenceMedia camera_media(const World& world);
// Light that went that far, in metres, through what fills the space.
void attenuate(const World& world, const ReferenceMedia& media, const reference::Spectrum4& lambda_nm, double distance,
               reference::Spectrum4& light);

}  // namespace metamer
