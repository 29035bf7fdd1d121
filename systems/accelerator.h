// Embree's side of the world. Included by build_accelerator, intersect and shadow only.
#pragma once
#include <embree3/rtcore.h>

#include <deque>
#include <vector>

#include "engine/ecs/world.h"

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

// The object a hit belongs to: in an instance the mesh has id 0, the instance the object's.
inline uint32_t object_of(unsigned geometry_id, unsigned instance_id) {
  return instance_id != RTC_INVALID_GEOMETRY_ID ? instance_id : geometry_id;
}

}  // namespace metamer
