// The stages of the pipeline in their order; each is one free function in the file of its name. A signature is a
// contract: const columns in, mutable columns out, nothing else is touched. pipeline.cpp knows the order.
#pragma once
#include <span>

#include "engine/ecs/world.h"
#include "engine/film/film.h"
#include "engine/schedule/tiles.h"
#include "engine/streams.h"

namespace metamer {

// An aligned 4x4 block of pixels at one sample index: sixteen camera rays that are always traced together, whatever
// the tile or the crop, because Embree's packets are not independent of their lanes to the last bit.
struct RayPacket {
  uint32_t x, y;  // of the upper left pixel; multiples of 4
  uint32_t sample;
};

// Seconds a worker spent, by system and inside Embree (intersect and shadow include Embree's), and rays by kind.
enum class SystemId : uint32_t {
  camera_rays,
  intersect,
  volumes,
  sort,
  surface,
  media,
  emission,
  light_sample,
  shade,
  shadow,
  roulette,
  nodes,
  accumulate
};
inline constexpr size_t system_count = 13;
// What rays through volumes of grids came to. One that collides more often with what is there, or might be, is given
// up.
inline constexpr uint32_t most_collisions = 1u << 20;
struct GridWork {
  uint64_t lookups = 0;     // collisions, real or not: places where the grids were asked
  uint64_t steps = 0;       // cells of majorants
  uint64_t unfinished = 0;  // rays that collided most_collisions times and were given up
};
struct Counters {
  double seconds[system_count] = {};
  double embree_seconds = 0;
  uint64_t samples = 0, camera_rays = 0, bounce_rays = 0, shadow_rays = 0;
  uint64_t lanes = 0, live_lanes = 0;  // of the shading streams
  uint64_t invalid_samples = 0;
  uint64_t lost_media = 0;  // times that a path was inside of more than it can remember
  uint64_t lost_rays = 0;   // rays that met more interfaces than they may
  GridWork grids;
  void add(const Counters& other);
};

// Starts a path per pixel and sample: place on the film by the pixel filter, wavelengths, lens. Sixteen lanes per
// packet; pixels outside the tile get slots without a pixel.
void camera_rays(const World& world, std::span<const RayPacket> packets, const TileRect& tile, PathStream& paths,
                 Slots& slots);

// The first object each ray meets. Camera rays go as packets of sixteen, others one by one.
void intersect_camera(const World& world, const PathStream& paths, HitStream& hits, double* embree_seconds);
void intersect_bounce(const World& world, const PathStream& paths, HitStream& hits, double* embree_seconds);

// The same of rays order[0..count) that passed a surface: from `passed` to `reach`, of objects that `mask` sees.
void intersect_onward(const World& world, const PathStream& paths, const uint32_t* order, uint32_t count, uint32_t mask,
                      HitStream& hits, double* embree_seconds);

// Where the world has volumes: what happens to rays before they meet a surface. They are absorbed and gather what
// glows; for `path` they are scattered, which turns the hit into a vertex of ShadeKind::phase, else what is scattered
// is lost. Interfaces are passed. Reads and writes the batch's paths (throughput, volume and share) and hits, adds to
// its slots; its order, shade, shadow and crossings are scratch. Counts rays that met more than most_interfaces and
// end.
inline constexpr uint32_t most_interfaces = 1024;
inline constexpr float light_is_counted = -1;  // HitStream::depth_left: `emission` has seen the shape that was hit
void volumes(const World& world, uint32_t depth, Batch& batch, Counters& counters);

// Chooses the material of hits on mixed ones and sorts by kind: order[lane] is the path, dead_lane in the padding
// between groups. Writes the hits' material.
void sort_hits(const World& world, uint32_t depth, const PathStream& paths, HitStream& hits, uint32_t* order,
               Groups& groups);

// Position, normals and how far new rays must keep off the surface; carries the paths' columns along in sorted order.
void surface(const World& world, const PathStream& paths, const HitStream& hits, const uint32_t* order,
             ShadeStream& shade);

// A ray and what it met: enough to compute the point again.
struct RayHit {
  float origin[3] = {}, direction[3] = {};
  uint32_t object = 0, primitive = 0;
  float distance = 0;  // of quadrics and curves
  float u = 0;         // of curves
  float time = 0;      // where the world has motion
};
// What textures may ask about it.
struct SurfacePoint {
  float uv[2], position[3], normal[3];
  float footprint[4];  // ShadeStream's
};
SurfacePoint surface_point(const World& world, const RayHit& hit);
// The value there of a program for numbers: alpha, or the amount of a mixture. The same whatever else is computed.
float number_at_hit(const World& world, uint32_t program, const RayHit& hit);

// Bends shading normals (and tangents) by displacements and normal maps. Nothing where the world has no bumps.
void bump(const World& world, ShadeStream& shade);

// Values of materials that vary over their surface, computed in order of the textures. Nothing without textures.
void textures(const World& world, uint32_t depth, ShadeStream& shade);

// Where the world has interiors: what a path turns out to have been inside of all the time, and what that absorbed on
// the way from the vertex before.
void media(const World& world, ShadeStream& shade);

// Light that the rays ran into, weighted against having been sampled (power heuristic).
void emission(const World& world, const ShadeStream& shade, Slots& slots);

// Chooses a light for each lane of a rough kind, and a direction towards it.
void light_sample(const World& world, uint32_t depth, ShadeStream& shade);

// The direction to one abstract light, chosen by nobody: for sums over all of them.
void light_towards(const World& world, uint32_t row, ShadeStream& shade);

// BSDF kernels of rough kinds: weigh the light sample (appended to `shadow` unless 0) and draw the next direction, or
// only one of the two, where a vertex has many light samples or nothing follows it.
struct ShadeWork {
  uint32_t depth = 0;
  bool weigh_light = true, draw_next = true;
  bool draw_mirror = true;  // the next direction may be a smooth coat's mirror image; else it comes from the body alone
};
void shade_diffuse(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow);
void shade_diffuse_transmission(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow);
void shade_rough(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow);
void shade_smooth_coated(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow);
void shade_rough_coated(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow);
void shade_layered(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow);
void shade_hair(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow);
void shade_rough_conductor(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow);
void shade_rough_dielectric(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow);
// The phase function of volumes stands for the BSDF.
void shade_phase(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow);
// All of them, one after the other.
void shade_rough_kinds(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow);

// BSDF kernels of smooth kinds: one of the few directions that light takes there. `drawn` chooses it by chance and
// divides its weight by the probability. The others take no chance and divide by nothing, the weight is 0 in lanes
// without that direction: `refracted` where all wavelengths go together, `refracted_j` where they part, wavelength j
// alone. A kind that only reflects has no weight in the last five, and need not be called for them.
enum class Branch : uint32_t { drawn, reflected, refracted, refracted_0, refracted_1, refracted_2, refracted_3 };
void shade_smooth_conductor(const World& world, ShadeStream& shade);
// The mirror image in the surface of smooth coats, `reflected`.
void shade_coat_mirror(const World& world, ShadeStream& shade);
void shade_layered_mirror(const World& world, ShadeStream& shade);
void shade_dielectric(const World& world, uint32_t depth, Branch branch, ShadeStream& shade);
void shade_thin_dielectric(const World& world, uint32_t depth, Branch branch, ShadeStream& shade);

// For ambient_occlusion: of every first surface a direction over it, by the cosine, to be tested for what is in the
// way.
void ambient_occlusion(const World& world, const ShadeStream& shade, ShadowStream& shadow);

// Shadow rays end short of the light by as much as float leaves uncertain about where it is.
inline constexpr float shadow_ray_share = 0.9999f;

// Adds the contributions whose light is in sight; all of them where the scene casts no shadows.
void shadow(const World& world, const ShadowStream& shadow, Slots& slots, double* embree_seconds);
// The same where the world has volumes, in two parts with `transmit` between them: occluded rays get dead_lane for
// their slot, then the contributions of the others are added.
void occlude(const World& world, ShadowStream& shadow, double* embree_seconds);
void add_light(const ShadowStream& shadow, Slots& slots);
// What volumes between a vertex and its light let through, interface by interface. `depth` and `light` tell the light
// samples of a path from each other. `crossings` is scratch. Returns the number of rays that met more than
// most_interfaces and bring nothing.
uint32_t transmit(const World& world, uint32_t depth, uint32_t light, ShadowStream& shadow, Batch& crossings,
                  GridWork& work, double* embree_seconds);

// Ends paths that carry little, without bias, and makes the rays of the others.
void roulette(uint32_t depth, const ShadeStream& shade, PathStream& next);

// The next directions of rough kinds as rays that only look for light (local, recursive).
void probe_rays(const ShadeStream& shade, PathStream& next);

// Keeps what was shaded for `branch` as nodes of `depth` that wait, and takes the last up to `most` of them out, all of
// one depth, into the slots 0, 1, ...; false where none is left. Stops the program where more than a batch would wait
// for each depth. A node's pixel_seed is a hash of its parent's and the branch: numbers belong to places in the tree.
void push_nodes(const ShadeStream& shade, const Slots& slots, uint32_t depth, ShadeKind kind, Branch branch,
                NodeStack& nodes);
bool pop_nodes(uint32_t most, NodeStack& nodes, uint32_t* depth, PathStream& paths, Slots& slots);

// Radiances to XYZ and to bands, into the tile's exact sums. Of a sample whose light comes in several parts, each with
// slots of its own, one part brings the weights of its wavelengths, once.
enum class SampleWeights : uint32_t { added, added_by_another_part };
void accumulate(const World& world, const Slots& slots, TileFilm& film, SampleWeights weights = SampleWeights::added);

}  // namespace metamer
