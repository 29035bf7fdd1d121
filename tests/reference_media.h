// What the oracle knows of being inside: a list of media as entered, of any length.
#pragma once
#include <vector>

#include "systems/bsdf/reference.h"
#include "tests/reference_scene.h"

namespace metamer {

// Rows of World::media in the order of entering.
using ReferenceMedia = std::vector<uint32_t>;

// Which of them fills the space; 0 is vacuum.
uint32_t fills(const World& world, const ReferenceMedia& media);
// The medium of the object, or 0.
uint32_t medium_of(const World& world, uint32_t object);
// Behind the surface, for a ray along `direction`.
ReferenceMedia crossed(const World& world, const ReferenceMedia& media, const ReferenceHit& hit,
                       const Vector& direction);
// What rays start in at the camera.
ReferenceMedia camera_media(const World& world);
// Light that went that far, in metres, through what fills the space.
void attenuate(const World& world, const ReferenceMedia& media, const reference::Spectrum4& lambda_nm, double distance,
               reference::Spectrum4& light);

}  // namespace metamer
