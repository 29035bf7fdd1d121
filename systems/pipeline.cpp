#include "systems/pipeline.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace metamer {
namespace {

using Clock = std::chrono::steady_clock;

// Charges the time since the last call to a system.
class StageClock {
 public:
  explicit StageClock(Counters& counters) : counters_(counters), last_(Clock::now()) {}
  void restart() { last_ = Clock::now(); }
  void charge(SystemId system) {
    const Clock::time_point now = Clock::now();
    counters_.seconds[static_cast<size_t>(system)] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  Counters& counters_;
  Clock::time_point last_;
};

// Contributions of light that was scattered so often on its way from the source to the camera.
void limit_light(const World& world, uint32_t scatterings, Slots& slots) {
  slots.limit = scatterings > 1 ? world.indirect_limit : std::numeric_limits<float>::infinity();
}

void count_lanes(const ShadeStream& shade, uint32_t paths, Counters& counters) {
  counters.lanes += shade.size;
  counters.live_lanes += paths;
}

// What the rays of the batch meet.
void find_surfaces(const World& world, uint32_t depth, Batch& batch, StageClock& clock, Counters& counters) {
  limit_light(world, depth, batch.slots);
  PathStream& paths = batch.paths;
  if (depth == 0) {
    intersect_camera(world, paths, batch.hits, &counters.embree_seconds);
    counters.camera_rays += paths.size;
  } else {
    intersect_bounce(world, paths, batch.hits, &counters.embree_seconds);
    counters.bounce_rays += paths.size;
  }
  clock.charge(SystemId::intersect);
  ShadeStream& shade = batch.shade;
  if (world.has_volumes) volumes(world, depth, batch, counters);
  clock.charge(SystemId::volumes);
  sort_hits(world, depth, paths, batch.hits, batch.order, shade.groups);
  shade.size = shade.groups.back().padded_end();
  count_lanes(shade, paths.size, counters);
  clock.charge(SystemId::sort);
  surface(world, paths, batch.hits, batch.order, shade);
  bump(world, shade);
  textures(world, depth, shade);
  clock.charge(SystemId::surface);
}

// And the light they ran into.
void meet(const World& world, uint32_t depth, Batch& batch, StageClock& clock, Counters& counters) {
  find_surfaces(world, depth, batch, clock, counters);
  ShadeStream& shade = batch.shade;
  if (world.has_interiors) media(world, shade);
  clock.charge(SystemId::media);
  emission(world, shade, batch.slots);
  clock.charge(SystemId::emission);
}

// Light on rough surfaces by the light samples that are in the stream: the n-th ones of each vertex.
void weigh_lights(const World& world, const ShadeWork& work, uint32_t n, Batch& batch, StageClock& clock,
                  Counters& counters) {
  batch.shadow.size = 0;
  limit_light(world, work.depth + 1, batch.slots);
  shade_rough_kinds(world, work, batch.shade, batch.shadow);
  clock.charge(SystemId::shade);
  if (world.has_volumes) {
    if (!batch.crossings) batch.crossings = std::make_unique<Batch>();
    occlude(world, batch.shadow, &counters.embree_seconds);
    counters.lost_rays +=
        transmit(world, work.depth, n, batch.shadow, *batch.crossings, counters.grids, &counters.embree_seconds);
    add_light(batch.shadow, batch.slots);
  } else {
    shadow(world, batch.shadow, batch.slots, &counters.embree_seconds);
  }
  if (world.settings.shadows) counters.shadow_rays += batch.shadow.size;
  clock.charge(SystemId::shadow);
}

// Light that comes straight from the light sources: the abstract ones one by one, which need no integration; of the
// others one by chance, found by a sample of the light or by a ray in a direction of the surface's choice.
void gather_direct_light(const World& world, uint32_t depth, Batch& batch, StageClock& clock, Counters& counters) {
  for (const uint32_t row : world.summed_lights) {
    light_towards(world, row, batch.shade);
    clock.charge(SystemId::light_sample);
    weigh_lights(world, {depth, true, false, false}, row + 1, batch, clock, counters);
  }
  if (world.light_choice.size() == 0) return;
  light_sample(world, depth, batch.shade);
  clock.charge(SystemId::light_sample);
  const bool probes = world.settings.shadows;
  weigh_lights(world, {depth, true, probes, false}, 0, batch, clock, counters);
  if (!probes) return;
  probe_rays(batch.shade, batch.next);
  std::swap(batch.paths, batch.next);
  clock.charge(SystemId::nodes);
  meet(world, depth + 1, batch, clock, counters);
}

// Directions of the smooth surfaces, all of them, become nodes.
void branch_out(const World& world, uint32_t depth, Batch& batch, StageClock& clock) {
  const auto push = [&](ShadeKind kind, Branch branch) {
    clock.charge(SystemId::shade);
    push_nodes(batch.shade, batch.slots, depth + 1, kind, branch, batch.nodes);
    clock.charge(SystemId::nodes);
  };
  shade_smooth_conductor(world, batch.shade);
  push(ShadeKind::smooth_conductor, Branch::reflected);
  shade_coat_mirror(world, batch.shade);
  push(ShadeKind::smooth_coated, Branch::reflected);
  shade_layered_mirror(world, batch.shade);
  push(ShadeKind::layered, Branch::reflected);
  const uint32_t last = static_cast<uint32_t>(world.branches > 2 ? Branch::refracted_3 : Branch::refracted);
  for (uint32_t branch = static_cast<uint32_t>(Branch::reflected); branch <= last; ++branch) {
    shade_dielectric(world, depth, static_cast<Branch>(branch), batch.shade);
    push(ShadeKind::dielectric, static_cast<Branch>(branch));
  }
  for (const Branch branch : {Branch::reflected, Branch::refracted}) {
    shade_thin_dielectric(world, depth, branch, batch.shade);
    push(ShadeKind::thin_dielectric, branch);
  }
}

// One vertex of every path of the batch. `last` vertices only look for light.
void trace_vertices(const World& world, uint32_t depth, bool last, Batch& batch, Counters& counters) {
  StageClock clock(counters);
  meet(world, depth, batch, clock, counters);
  batch.next.size = 0;
  if (last) return;
  ShadeStream& shade = batch.shade;
  const bool has_lights = world.light_choice.size() > 0;
  if (has_lights) light_sample(world, depth, shade);
  clock.charge(SystemId::light_sample);
  weigh_lights(world, {depth, has_lights, true}, 0, batch, clock, counters);
  shade_smooth_conductor(world, shade);
  shade_dielectric(world, depth, Branch::drawn, shade);
  shade_thin_dielectric(world, depth, Branch::drawn, shade);
  clock.charge(SystemId::shade);
  roulette(depth, shade, batch.next);
  clock.charge(SystemId::roulette);
}

void trace_batch(const World& world, std::span<const RayPacket> packets, const TileRect& tile, Batch& batch,
                 TileFilm& film, Counters& counters) {
  StageClock clock(counters);
  camera_rays(world, packets, tile, batch.paths, batch.slots);
  clock.charge(SystemId::camera_rays);
  uint32_t depth = 0;
  do {
    trace_rays(world, depth, batch, counters);
    clock.restart();
    accumulate(world, batch.slots, film, depth == 0 ? SampleWeights::added : SampleWeights::added_by_another_part);
    clock.charge(SystemId::accumulate);
  } while (pop_nodes(rays_per_batch(world), batch.nodes, &depth, batch.paths, batch.slots));
}

}  // namespace

void shade_rough_kinds(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  shade_diffuse(world, work, shade, shadow);
  shade_diffuse_transmission(world, work, shade, shadow);
  shade_rough(world, work, shade, shadow);
  shade_smooth_coated(world, work, shade, shadow);
  shade_rough_coated(world, work, shade, shadow);
  shade_layered(world, work, shade, shadow);
  shade_hair(world, work, shade, shadow);
  shade_rough_conductor(world, work, shade, shadow);
  shade_rough_dielectric(world, work, shade, shadow);
  shade_phase(world, work, shade, shadow);
}

void trace_path(const World& world, Batch& batch, Counters& counters) {
  const uint32_t max_depth = world.settings.max_depth;
  for (uint32_t depth = 0; depth <= max_depth && batch.paths.size > 0; ++depth) {
    trace_vertices(world, depth, depth == max_depth, batch, counters);
    std::swap(batch.paths, batch.next);
  }
}

void trace_local(const World& world, Batch& batch, Counters& counters) {
  StageClock clock(counters);
  meet(world, 0, batch, clock, counters);
  if (world.settings.max_depth > 0) gather_direct_light(world, 0, batch, clock, counters);
}

void trace_ambient_occlusion(const World& world, Batch& batch, Counters& counters) {
  StageClock clock(counters);
  find_surfaces(world, 0, batch, clock, counters);
  batch.shadow.size = 0;
  ambient_occlusion(world, batch.shade, batch.shadow);
  clock.charge(SystemId::shade);
  shadow(world, batch.shadow, batch.slots, &counters.embree_seconds);
  counters.shadow_rays += batch.shadow.size;
  clock.charge(SystemId::shadow);
}

void trace_recursive(const World& world, uint32_t depth, Batch& batch, Counters& counters) {
  StageClock clock(counters);
  meet(world, depth, batch, clock, counters);
  if (depth == world.settings.max_depth) return;
  branch_out(world, depth, batch, clock);
  gather_direct_light(world, depth, batch, clock, counters);
}

void trace_rays(const World& world, uint32_t depth, Batch& batch, Counters& counters) {
  switch (world.settings.integrator) {
    case Integrator::local: trace_local(world, batch, counters); break;
    case Integrator::recursive: trace_recursive(world, depth, batch, counters); break;
    case Integrator::path: trace_path(world, batch, counters); break;
    case Integrator::ambient_occlusion: trace_ambient_occlusion(world, batch, counters); break;
  }
  counters.lost_media += std::exchange(batch.shade.lost_media, 0);
}

uint32_t rays_per_batch(const World& world) {
  const uint32_t branches = world.settings.integrator == Integrator::recursive ? world.branches : 1;
  constexpr uint32_t packet = column_lanes;
  return batch_capacity / branches / packet * packet;
}

void Counters::add(const Counters& other) {
  for (size_t i = 0; i < system_count; ++i) seconds[i] += other.seconds[i];
  embree_seconds += other.embree_seconds;
  samples += other.samples;
  camera_rays += other.camera_rays;
  bounce_rays += other.bounce_rays;
  shadow_rays += other.shadow_rays;
  lanes += other.lanes;
  live_lanes += other.live_lanes;
  invalid_samples += other.invalid_samples;
  lost_media += other.lost_media;
  lost_rays += other.lost_rays;
  grids.lookups += other.grids.lookups;
  grids.steps += other.grids.steps;
  grids.unfinished += other.grids.unfinished;
}

void trace_tile(const World& world, const TileRect& tile, uint32_t sample_begin, uint32_t sample_end, Batch& batch,
                TileFilm& film, Counters& counters) {
  const TileRect rendered = rendered_pixels(world.settings);
  film.reset(tile.x0 - rendered.x0, tile.y0 - rendered.y0, tile.width(), tile.height(), sample_begin, sample_end,
             world.settings.band_count);
  constexpr uint32_t packets_per_batch = batch_capacity / column_lanes;
  std::array<RayPacket, packets_per_batch> packets;
  const uint32_t most = rays_per_batch(world) / column_lanes;
  uint32_t count = 0;
  const auto flush_batch = [&] {
    if (count > 0) trace_batch(world, {packets.data(), count}, tile, batch, film, counters);
    count = 0;
  };
  for (uint32_t sample = sample_begin; sample < sample_end; ++sample)
    for (uint32_t y = tile.y0 & ~3u; y < tile.y1; y += 4)
      for (uint32_t x = tile.x0 & ~3u; x < tile.x1; x += 4) {
        packets[count++] = {x, y, sample};
        if (count == most) flush_batch();
      }
  flush_batch();
  counters.samples += uint64_t{tile.width()} * tile.height() * (sample_end - sample_begin);
  counters.invalid_samples += film.invalid_samples();
}

}  // namespace metamer
