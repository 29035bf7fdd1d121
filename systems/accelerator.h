// Embree's side of the world. Included by build_accelerator, intersect and shadow only.
#pragma once
#include <embree3/rtcore.h>

#include <deque>
#include <vector>

#include "engine/ecs/world.h"
#include "systems/systems.h"

namespace metamer {

// The geometry id of an object in the root scene is its row in World::objects, of instances too.
struct Accelerator {
  RTCDevice device = nullptr;
  RTCScene root = nullptr;
  std::vector<RTCScene> shared_meshes;
  // What the callbacks of a quadric get; a deque, so that their addresses stay.
  struct Quadric {
    const World* world;
    uint32_t object;
  };
  std::deque<Quadric> quadrics;
};

// What callbacks and filters know of the rays beside Embree's copies, which within an instance are in its own space:
// the columns they come from. The id of a ray is its row there.
struct RayContext {
  RTCIntersectContext embree;
  const Columns<float, 3>* origin;
  const Columns<float, 3>* direction;
  const float* time;  // null where nothing moves

  RayContext(const Columns<float, 3>& origin_, const Columns<float, 3>& direction_, const float* time_)
      : origin(&origin_), direction(&direction_), time(time_) {
    rtcInitIntersectContext(&embree);
  }
};

// Whether a ray meets what it hits: by chance where the object's alpha is below 1. `nth`: which of several points of
// one primitive. The rest of `hit` is taken from the ray.
bool is_there(const World& world, const RayContext& rays, uint32_t ray, RayHit hit, uint32_t nth);
// The same as a filter for intersection and occlusion; its user data is the World.
void filter_masked(const RTCFilterFunctionNArguments* args);

// The object a hit belongs to: in an instance the mesh has id 0, the instance the object's.
inline uint32_t object_of(unsigned geometry_id, unsigned instance_id) {
  return instance_id != RTC_INVALID_GEOMETRY_ID ? instance_id : geometry_id;
}

}  // namespace metamer
