#include "tests/reference_media.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace metamer {

uint32_t fills(const World& world, const ReferenceMedia& media) {
  uint32_t top = 0;
  for (const uint32_t medium : media)
    if (world.media.priority[medium] >= world.media.priority[top]) top = medium;
  return top;
}

uint32_t medium_of(const World& world, uint32_t object) {
  const auto kind = static_cast<ShadeKind>(world.objects.shade_kind[object]);
  const bool enters = kind == ShadeKind::dielectric || kind == ShadeKind::rough_dielectric;
  return enters ? world.dielectric.medium[world.objects.material[object]] : 0;
}

ReferenceMedia crossed(const World& world, const ReferenceMedia& media, const ReferenceHit& hit,
                       const Vector& direction) {
  ReferenceMedia result = media;
  const uint32_t medium = medium_of(world, hit.object);
  if (medium == 0) return result;
  if (glm::dot(direction, hit.outside) < 0) {
    result.push_back(medium);
  } else {
    const auto last = std::find(result.rbegin(), result.rend(), medium);
    if (last != result.rend()) result.erase(std::next(last).base());
  }
  return result;
}

ReferenceMedia camera_media(const World& world) {
  ReferenceMedia media;
  for (const uint32_t pair : {world.camera_media[1], world.camera_media[0]})
    for (const uint32_t medium : {pair >> 16, pair & largest_medium})
      if (medium != 0) media.push_back(medium);
  return media;
}

void attenuate(const World& world, const ReferenceMedia& media, const reference::Spectrum4& lambda_nm, double distance,
               reference::Spectrum4& light) {
  const uint32_t medium = fills(world, media);
  for (size_t j = 0; j < 4; ++j) {
    const double kappa = world.spectra.value(world.media.kappa[medium], lambda_nm[j]);
    if (kappa > 0) light[j] *= std::exp(-4 * std::numbers::pi * kappa / (lambda_nm[j] * 1e-9) * distance);
  }
}

}  // namespace metamer
