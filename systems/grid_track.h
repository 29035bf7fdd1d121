// Rays through volumes that vary in space. Part of `volumes` and `transmit`, see volumes.cpp.
#pragma once
#include "systems/systems.h"

namespace metamer {

// One kind of rays on their way, and what may happen to them.
struct VolumeRays {
  PathStream& paths;
  HitStream& hits;
  Slots* slots;     // where the glow goes; null: it does not count
  bool scatters;    // rays are scattered by chance; else what is scattered is lost
  uint32_t* order;  // rows of the streams, padded with dead_lane to whole vectors
  uint32_t count = 0;
  uint32_t key = 0;  // what tells these rays from others of the same paths: their random numbers differ
};

// The listed rays, which are in `volume`, from HitStream::passed to HitStream::distance. Where rays are scattered and
// the volume scatters that is by delta tracking, which may end them; else by ratio tracking. Writes throughput, share,
// distance, object and depth_left, and the slots.
void track_grid(const World& world, uint32_t volume, const VolumeRays& rays, const uint32_t* order, uint32_t count,
                GridWork& work);

// Light of points that the homogeneous volume around each of rays.order scatters into its ray, before what it meets:
// one place for each ray, by the angles that the light sees; what free paths find of the same counts the rest. As
// shadow rays. `dimension` is a 2D one of its own.
void scattered_light(const World& world, const VolumeRays& rays, uint32_t dimension, ShadowStream& shadow);

}  // namespace metamer
