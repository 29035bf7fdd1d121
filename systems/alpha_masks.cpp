#include <bit>

#include "engine/sampling/hash.h"
#include "systems/accelerator.h"
#include "systems/systems.h"

namespace metamer {
namespace {

// A number from 0 to below 1 that belongs to the ray and to the place on the surface, not to how rays are traced.
float mask_number(const RayHit& hit, uint32_t nth) {
  uint32_t hash = hash_combine(hit.object, hit.primitive);
  hash = hash_combine(hash, nth);
  for (const float x : hit.origin) hash = hash_combine(hash, std::bit_cast<uint32_t>(x));
  for (const float x : hit.direction) hash = hash_combine(hash, std::bit_cast<uint32_t>(x));
  return unit_float(hash);
}

}  // namespace

bool is_there(const World& world, const RayContext& rays, uint32_t ray, RayHit hit, uint32_t nth) {
  const uint32_t program = world.objects.alpha[hit.object];
  if (program == no_index) return true;
  for (size_t i = 0; i < 3; ++i) {
    hit.origin[i] = (*rays.origin)[i][ray];
    hit.direction[i] = (*rays.direction)[i][ray];
  }
  if (rays.time != nullptr) hit.time = rays.time[ray];
  return mask_number(hit, nth) < number_at_hit(world, program, hit);
}

void filter_masked(const RTCFilterFunctionNArguments* args) {
  const World& world = *static_cast<const World*>(args->geometryUserPtr);
  const auto& rays = *reinterpret_cast<const RayContext*>(args->context);
  for (unsigned lane = 0; lane < args->N; ++lane) {
    if (args->valid[lane] == 0) continue;
    RayHit hit;
    hit.object = object_of(RTCHitN_geomID(args->hit, args->N, lane), RTCHitN_instID(args->hit, args->N, lane, 0));
    hit.primitive = RTCHitN_primID(args->hit, args->N, lane);
    hit.distance = RTCRayN_tfar(args->ray, args->N, lane);
    hit.u = RTCHitN_u(args->hit, args->N, lane);
    if (!is_there(world, rays, RTCRayN_id(args->ray, args->N, lane), hit, 0)) args->valid[lane] = 0;
  }
}

}  // namespace metamer
