#include "tests/reference_media.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/reference_grids.h"

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

namespace {

uint32_t declared_volume(const World& world, const ReferenceHit& hit, const Vector& direction) {
  const bool outwards = glm::dot(direction, hit.outside) > 0;
  return outwards ? world.objects.volume_outside[hit.object] : world.objects.volume_inside[hit.object];
}

}  // namespace

ReferenceMedia crossed(const World& world, const ReferenceMedia& media, const ReferenceHit& hit,
                       const Vector& direction) {
  ReferenceMedia result = media;
  const uint32_t medium = medium_of(world, hit.object);
  if (medium == 0) {
    result.volume = volume_towards(world, media, hit, direction);
    return result;
  }
  if (glm::dot(direction, hit.outside) < 0) {
    result.push_back(medium);
  } else {
    const auto last = std::find(result.rbegin(), result.rend(), medium);
    if (last != result.rend()) result.erase(std::next(last).base());
  }
  // Sides count where the space gets filled by another solid, and where that has no medium of its own.
  const uint32_t top = fills(world, result), left = fills(world, media);
  if (top == left) return result;
  const bool has_sides = world.objects.volume_inside[hit.object] != keeps_volume;
  if (world.media.volume[top] != keeps_volume)
    result.volume = world.media.volume[top];
  else if (has_sides)
    result.volume = declared_volume(world, hit, direction);
  else if (top == medium && world.media.volume[left] != keeps_volume)
    result.volume = 0;
  return result;
}

uint32_t volume_towards(const World& world, const ReferenceMedia& media, const ReferenceHit& hit,
                        const Vector& direction) {
  if (hit.object == no_index || world.objects.volume_inside[hit.object] == keeps_volume) return media.volume;
  if (medium_of(world, hit.object) != 0) return media.volume;  // without crossing it
  return declared_volume(world, hit, direction);
}

ReferenceVolume volume_at(const World& world, uint32_t volume, const Vector& position, double lambda_nm) {
  const VolumeColumns& table = world.volumes;
  const double scale = table.scale[volume];
  ReferenceVolume there{scale * world.spectra.value(table.sigma_a[volume], lambda_nm),
                        scale * world.spectra.value(table.sigma_s[volume], lambda_nm),
                        double{table.emission_scale[volume]} * world.spectra.value(table.emission[volume], lambda_nm)};
  if (table.grid[volume] != no_index) vary(world, volume, position, lambda_nm, there);
  return there;
}

void attenuate_and_glow(const World& world, uint32_t row, const Vector& origin, const Vector& direction,
                        const reference::Spectrum4& lambda_nm, double distance, ReferenceRandom& random,
                        reference::Spectrum4& light) {
  for (size_t j = 0; j < 4; ++j) {
    if (world.volumes.grid[row] != no_index) {
      const double t = reference_free_path(world, row, origin, direction, distance, lambda_nm[j], random);
      if (std::isinf(t)) continue;
      const ReferenceVolume volume = volume_at(world, row, origin + t * direction, lambda_nm[j]);
      light[j] = volume.glow * volume.absorption / volume.extinction();
      continue;
    }
    const ReferenceVolume volume = volume_at(world, row, origin, lambda_nm[j]);
    if (!(volume.extinction() > 0)) continue;
    const double passes = std::exp(-volume.extinction() * distance);
    light[j] = light[j] * passes + volume.glow * volume.absorption / volume.extinction() * (1 - passes);
  }
}

ReferenceHit place_in_volume(const Vector& position, const Vector& direction) {
  ReferenceHit place;
  place.position = position;
  place.outside = place.shading = direction;
  place.tangent = Vector(0);
  return place;
}

reference::Spectrum4 volume_transmittance(const ReferenceScene& scene, uint32_t volume, const Vector& origin,
                                          const Vector& direction, double distance,
                                          const reference::Spectrum4& lambda_nm, ReferenceRandom& random) {
  reference::Spectrum4 passes{1, 1, 1, 1};
  ReferenceMedia media;
  media.volume = volume;
  Vector from = origin;
  for (double left = distance; left > 0;) {
    const ReferenceHit hit = scene.intersect(from, direction, visible_to_crossings, left);
    const double stretch = hit.object == no_index ? left : hit.t;
    for (size_t j = 0; j < 4; ++j) {
      if (scene.world.volumes.grid[media.volume] != no_index) {
        passes[j] *= reference_ratio(scene.world, media.volume, from, direction, stretch, lambda_nm[j], random);
        continue;
      }
      const double extinction = volume_at(scene.world, media.volume, from, lambda_nm[j]).extinction();
      if (extinction > 0) passes[j] *= std::exp(-extinction * stretch);
    }
    if (hit.object == no_index) break;
    media.volume = volume_towards(scene.world, media, hit, direction);
    from = hit.position;
    left -= hit.t;
  }
  return passes;
}

ReferenceMedia camera_media(const World& world) {
  ReferenceMedia media;
  media.volume = world.camera_volume;
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
