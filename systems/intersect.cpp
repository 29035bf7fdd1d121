#include <algorithm>
#include <chrono>
#include <numeric>

#include "systems/accelerator.h"
#include "systems/systems.h"

namespace metamer {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Rays go to Embree by the chunk, so that reading the clock costs nothing beside them.
constexpr uint32_t chunk = 64;

void start_ray(const World& world, const PathStream& paths, uint32_t i, RTCRayHit& ray) {
  ray.ray.org_x = paths.origin[0][i];
  ray.ray.org_y = paths.origin[1][i];
  ray.ray.org_z = paths.origin[2][i];
  ray.ray.tnear = 0;
  ray.ray.dir_x = paths.direction[0][i];
  ray.ray.dir_y = paths.direction[1][i];
  ray.ray.dir_z = paths.direction[2][i];
  ray.ray.time = world.has_motion ? paths.time[i] : 0;
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = visible_to_bounces;
  ray.ray.flags = 0;
  ray.ray.id = i;
  ray.hit.u = 0;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

// Away from the surface that the ray has passed by what its distance is rounded by.
float beyond(float passed) { return passed * (1 + 4 * std::numeric_limits<float>::epsilon()); }

}  // namespace

void intersect_camera(const World& world, const PathStream& paths, HitStream& hits, double* embree_seconds) {
  RayContext context(paths.origin, paths.direction, world.has_motion ? paths.time : nullptr);
  context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) int valid[16];
  std::fill(std::begin(valid), std::end(valid), -1);
  RTCRayHit16 packet = {};
  constexpr size_t column = 16 * sizeof(float);
  for (uint32_t i = 0; i < paths.size; i += 16) {
    std::memcpy(packet.ray.org_x, paths.origin[0] + i, column);
    std::memcpy(packet.ray.org_y, paths.origin[1] + i, column);
    std::memcpy(packet.ray.org_z, paths.origin[2] + i, column);
    std::memcpy(packet.ray.dir_x, paths.direction[0] + i, column);
    std::memcpy(packet.ray.dir_y, paths.direction[1] + i, column);
    std::memcpy(packet.ray.dir_z, paths.direction[2] + i, column);
    if (world.has_motion) std::memcpy(packet.ray.time, paths.time + i, column);
    std::fill(std::begin(packet.ray.tfar), std::end(packet.ray.tfar), std::numeric_limits<float>::infinity());
    std::fill(std::begin(packet.ray.mask), std::end(packet.ray.mask), visible_to_camera);
    std::iota(std::begin(packet.ray.id), std::end(packet.ray.id), i);
    std::fill(std::begin(packet.hit.geomID), std::end(packet.hit.geomID), RTC_INVALID_GEOMETRY_ID);
    std::fill(std::begin(packet.hit.instID[0]), std::end(packet.hit.instID[0]), RTC_INVALID_GEOMETRY_ID);
    const Clock::time_point start = Clock::now();
    rtcIntersect16(valid, world.accelerator->root, &context.embree, &packet);
    *embree_seconds += seconds_since(start);
    for (uint32_t lane = 0; lane < 16; ++lane) {
      hits.object[i + lane] = object_of(packet.hit.geomID[lane], packet.hit.instID[0][lane]);
      hits.primitive[i + lane] = packet.hit.primID[lane];
      hits.distance[i + lane] = packet.ray.tfar[lane];
      hits.u[i + lane] = packet.hit.u[lane];
    }
  }
}

void intersect_bounce(const World& world, const PathStream& paths, HitStream& hits, double* embree_seconds) {
  RayContext context(paths.origin, paths.direction, world.has_motion ? paths.time : nullptr);
  RTCRayHit rays[chunk];
  for (uint32_t begin = 0; begin < paths.size; begin += chunk) {
    const uint32_t count = std::min(chunk, paths.size - begin);
    for (uint32_t k = 0; k < count; ++k) start_ray(world, paths, begin + k, rays[k]);
    const Clock::time_point start = Clock::now();
    for (uint32_t k = 0; k < count; ++k) rtcIntersect1(world.accelerator->root, &context.embree, &rays[k]);
    *embree_seconds += seconds_since(start);
    for (uint32_t k = 0; k < count; ++k) {
      hits.object[begin + k] = object_of(rays[k].hit.geomID, rays[k].hit.instID[0]);
      hits.primitive[begin + k] = rays[k].hit.primID;
      hits.distance[begin + k] = rays[k].ray.tfar;
      hits.u[begin + k] = rays[k].hit.u;
    }
  }
}

void intersect_onward(const World& world, const PathStream& paths, const uint32_t* order, uint32_t count, uint32_t mask,
                      HitStream& hits, double* embree_seconds) {
  RayContext context(paths.origin, paths.direction, world.has_motion ? paths.time : nullptr);
  const Clock::time_point start = Clock::now();
  for (uint32_t k = 0; k < count; ++k) {
    const uint32_t i = order[k];
    RTCRayHit ray;
    start_ray(world, paths, i, ray);
    ray.ray.tnear = beyond(hits.passed[i]);
    ray.ray.tfar = hits.reach[i];
    ray.ray.mask = mask;
    if (ray.ray.tnear < ray.ray.tfar) rtcIntersect1(world.accelerator->root, &context.embree, &ray);
    hits.object[i] = object_of(ray.hit.geomID, ray.hit.instID[0]);
    hits.primitive[i] = ray.hit.primID;
    hits.distance[i] = ray.ray.tfar;
  }
  *embree_seconds += seconds_since(start);
}

}  // namespace metamer
