#include <chrono>

#include "systems/accelerator.h"
#include "systems/systems.h"

namespace metamer {
namespace {

constexpr uint32_t chunk = 64;

void start_ray(const World& world, const ShadowStream& shadow, uint32_t i, RTCRay& ray) {
  ray.org_x = shadow.origin[0][i];
  ray.org_y = shadow.origin[1][i];
  ray.org_z = shadow.origin[2][i];
  ray.tnear = 0;
  ray.dir_x = shadow.direction[0][i];
  ray.dir_y = shadow.direction[1][i];
  ray.dir_z = shadow.direction[2][i];
  ray.time = world.has_motion ? shadow.time[i] : 0;
  ray.tfar = shadow.t_far[i];
  ray.mask = visible_to_shadows;
  ray.flags = 0;
  ray.id = i;
}

void add_contribution(const ShadowStream& shadow, uint32_t i, Slots& slots) {
  const uint32_t slot = shadow.slot[i];
  const auto& light = shadow.contribution;
  const float mean = 0.25f * ((light[0][i] + light[1][i]) + (light[2][i] + light[3][i]));
  const float kept = mean > slots.limit ? slots.limit / mean : 1;
  for (size_t j = 0; j < 4; ++j) slots.radiance[j][slot] += light[j][i] * kept;
}

// Calls done(ray, is_occluded) for every ray.
template <class Done>
void test_occlusion(const World& world, const ShadowStream& shadow, double* embree_seconds, const Done& done) {
  using Clock = std::chrono::steady_clock;
  RayContext context(shadow.origin, shadow.direction, world.has_motion ? shadow.time : nullptr);
  RTCRay rays[chunk];
  for (uint32_t begin = 0; begin < shadow.size; begin += chunk) {
    const uint32_t count = std::min(chunk, shadow.size - begin);
    for (uint32_t k = 0; k < count; ++k) start_ray(world, shadow, begin + k, rays[k]);
    const Clock::time_point start = Clock::now();
    for (uint32_t k = 0; k < count; ++k) rtcOccluded1(world.accelerator->root, &context.embree, &rays[k]);
    *embree_seconds += std::chrono::duration<double>(Clock::now() - start).count();
    for (uint32_t k = 0; k < count; ++k) done(begin + k, rays[k].tfar < 0);  // Embree's word for occluded
  }
}

}  // namespace

void shadow(const World& world, const ShadowStream& shadow, Slots& slots, double* embree_seconds) {
  if (!world.settings.shadows) {
    for (uint32_t i = 0; i < shadow.size; ++i) add_contribution(shadow, i, slots);
    return;
  }
  test_occlusion(world, shadow, embree_seconds, [&](uint32_t i, bool is_occluded) {
    if (!is_occluded) add_contribution(shadow, i, slots);
  });
}

void occlude(const World& world, ShadowStream& shadow, double* embree_seconds) {
  if (!world.settings.shadows) return;
  test_occlusion(world, shadow, embree_seconds, [&](uint32_t i, bool is_occluded) {
    if (is_occluded) shadow.slot[i] = dead_lane;
  });
}

void add_light(const ShadowStream& shadow, Slots& slots) {
  for (uint32_t i = 0; i < shadow.size; ++i)
    if (shadow.slot[i] != dead_lane) add_contribution(shadow, i, slots);
}

}  // namespace metamer
