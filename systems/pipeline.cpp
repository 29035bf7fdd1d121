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
  void charge(SystemId system) {
    const Clock::time_point now = Clock::now();
    counters_.seconds[static_cast<size_t>(system)] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  Counters& counters_;
  Clock::time_point last_;
};

void count_lanes(const ShadeStream& shade, uint32_t paths, Counters& counters) {
  counters.lanes += shade.size;
  counters.live_lanes += paths;
}

// One vertex of every path of the batch. `last` vertices only look for light.
void trace_vertices(const World& world, uint32_t depth, bool last, Batch& batch, Counters& counters) {
  StageClock clock(counters);
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
  sort_hits(world, paths.size, batch.hits, batch.order, shade.groups);
  shade.size = shade.groups.back().padded_end();
  count_lanes(shade, paths.size, counters);
  clock.charge(SystemId::sort);
  surface(world, paths, batch.hits, batch.order, shade);
  clock.charge(SystemId::surface);
  emission(world, shade, batch.slots);
  clock.charge(SystemId::emission);
  batch.next.size = 0;
  if (last) return;
  if (!world.lights.empty()) light_sample(world, depth, shade);
  clock.charge(SystemId::light_sample);
  batch.shadow.size = 0;
  shade_diffuse(world, depth, shade, batch.shadow);
  shade_rough(world, depth, shade, batch.shadow);
  shade_rough_conductor(world, depth, shade, batch.shadow);
  shade_smooth_conductor(world, shade);
  shade_dielectric(world, depth, shade);
  clock.charge(SystemId::shade);
  shadow(world, batch.shadow, batch.slots, &counters.embree_seconds);
  counters.shadow_rays += batch.shadow.size;
  clock.charge(SystemId::shadow);
  roulette(depth, shade, batch.next);
  clock.charge(SystemId::roulette);
}

void trace_batch(const World& world, std::span<const RayPacket> packets, const TileRect& tile, Batch& batch,
                 TileFilm& film, Counters& counters) {
  {
    StageClock clock(counters);
    camera_rays(world, packets, tile, batch.paths, batch.slots);
    clock.charge(SystemId::camera_rays);
  }
  const uint32_t max_depth = world.settings.max_depth;
  for (uint32_t depth = 0; depth <= max_depth && batch.paths.size > 0; ++depth) {
    trace_vertices(world, depth, depth == max_depth, batch, counters);
    std::swap(batch.paths, batch.next);
  }
  StageClock clock(counters);
  accumulate(world, batch.slots, film);
  clock.charge(SystemId::accumulate);
}

}  // namespace

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
}

void trace_tile(const World& world, const TileRect& tile, uint32_t sample_begin, uint32_t sample_end, Batch& batch,
                TileFilm& film, Counters& counters) {
  film.reset(tile.x0, tile.y0, tile.width(), tile.height(), sample_begin, sample_end);
  constexpr uint32_t packets_per_batch = batch_capacity / column_lanes;
  std::array<RayPacket, packets_per_batch> packets;
  uint32_t count = 0;
  const auto flush_batch = [&] {
    if (count > 0) trace_batch(world, {packets.data(), count}, tile, batch, film, counters);
    count = 0;
  };
  for (uint32_t sample = sample_begin; sample < sample_end; ++sample)
    for (uint32_t y = tile.y0 & ~3u; y < tile.y1; y += 4)
      for (uint32_t x = tile.x0 & ~3u; x < tile.x1; x += 4) {
        packets[count++] = {x, y, sample};
        if (count == packets_per_batch) flush_batch();
      }
  flush_batch();
  counters.samples += uint64_t{tile.width()} * tile.height() * (sample_end - sample_begin);
  counters.invalid_samples += film.invalid_samples();
}

}  // namespace metamer
