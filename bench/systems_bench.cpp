// Each system on a real batch of the default scene (or METAMER_BENCH_SCENE), raw Embree on the same rays, and whole
// frames, on every instruction set this machine has. An item is a path (or a shadow ray, or a camera sample).
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <limits>
#include <string>

#include "bench/scene_fixture.h"
#include "engine/simd/instruction_set.h"
#include "systems/accelerator.h"
#include "systems/render.h"

namespace metamer::bench {
namespace {

constexpr uint32_t bounce = 1;  // the depth at which incoherent batches are measured

struct Stage {
  const char* name;
  uint32_t depth;
  uint32_t (*run)(const World& world, uint32_t depth, Batch& batch);  // returns the items done
};

uint32_t shade_all(const World& world, uint32_t depth, Batch& batch) {
  batch.shadow.size = 0;
  shade_rough_kinds(world, {depth}, batch.shade, batch.shadow);
  shade_smooth_conductor(world, batch.shade);
  shade_dielectric(world, depth, Branch::drawn, batch.shade);
  return batch.paths.size;
}

uint32_t run_camera_rays(const World& world, uint32_t, Batch& batch) {
  static std::vector<RayPacket> packets(batch_capacity / column_lanes, RayPacket{256, 256, 0});
  camera_rays(world, packets, {256, 256, 288, 288}, batch.next, batch.slots);
  return batch.next.size;
}
uint32_t run_intersect_camera(const World& world, uint32_t, Batch& batch) {
  double seconds = 0;
  intersect_camera(world, batch.paths, batch.hits, &seconds);
  return batch.paths.size;
}
uint32_t run_intersect_bounce(const World& world, uint32_t, Batch& batch) {
  double seconds = 0;
  intersect_bounce(world, batch.paths, batch.hits, &seconds);
  return batch.paths.size;
}
uint32_t run_sort(const World& world, uint32_t, Batch& batch) {
  sort_hits(world, 0, batch.paths, batch.hits, batch.order, batch.shade.groups);
  return batch.paths.size;
}
uint32_t run_surface(const World& world, uint32_t, Batch& batch) {
  surface(world, batch.paths, batch.hits, batch.order, batch.shade);
  return batch.paths.size;
}
uint32_t run_emission(const World& world, uint32_t, Batch& batch) {
  emission(world, batch.shade, batch.slots);
  return batch.paths.size;
}
uint32_t run_light_sample(const World& world, uint32_t depth, Batch& batch) {
  light_sample(world, depth, batch.shade);
  return batch.paths.size;
}
uint32_t run_shadow(const World& world, uint32_t, Batch& batch) {
  double seconds = 0;
  shadow(world, batch.shadow, batch.slots, &seconds);
  return batch.shadow.size;
}
uint32_t run_roulette(const World&, uint32_t depth, Batch& batch) {
  roulette(depth, batch.shade, batch.next);
  return batch.paths.size;
}
uint32_t run_accumulate(const World& world, uint32_t, Batch& batch) {
  static TileFilm film;
  film.reset(192, 192, 64, 64, 0, 1u << 16);
  accumulate(world, batch.slots, film);
  return batch.slots.size;
}

constexpr Stage stages[] = {
    {"camera_rays", 0, run_camera_rays},
    {"intersect_camera", 0, run_intersect_camera},
    {"intersect_bounce", bounce, run_intersect_bounce},
    {"sort", bounce, run_sort},
    {"surface", bounce, run_surface},
    {"emission", bounce, run_emission},
    {"light_sample", bounce, run_light_sample},
    {"shade", bounce, shade_all},
    {"shadow", bounce, run_shadow},
    {"roulette", bounce, run_roulette},
    {"accumulate", bounce, run_accumulate},
};

void bench_stage(benchmark::State& state, const Stage& stage, std::string_view isa) {
  apply_isa(isa);
  const World& world = bench_world();
  const auto batch = batch_at_depth(world, stage.depth);
  shade_all(world, stage.depth, *batch);
  int64_t items = 0;
  for (auto _ : state) items += stage.run(world, stage.depth, *batch);
  state.SetItemsProcessed(items);
  apply_isa("native");
}

// The rays of intersect_bounce, made ready beforehand: what Embree alone costs.
void bench_raw_embree(benchmark::State& state, bool occlusion) {
  const World& world = bench_world();
  const auto batch = batch_at_depth(world, bounce);
  const PathStream& paths = batch->paths;
  std::vector<RTCRayHit> rays(paths.size);
  for (uint32_t i = 0; i < paths.size; ++i) {
    RTCRay& ray = rays[i].ray;
    ray = {};
    ray.org_x = paths.origin[0][i], ray.org_y = paths.origin[1][i], ray.org_z = paths.origin[2][i];
    ray.dir_x = paths.direction[0][i], ray.dir_y = paths.direction[1][i], ray.dir_z = paths.direction[2][i];
    ray.mask = visible_to_all;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (auto _ : state)
    for (RTCRayHit& ray : rays) {
      ray.ray.tfar = std::numeric_limits<float>::infinity();
      ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      if (occlusion)
        rtcOccluded1(world.accelerator->root, &context, &ray.ray);
      else
        rtcIntersect1(world.accelerator->root, &context, &ray);
      benchmark::DoNotOptimize(ray);
    }
  state.SetItemsProcessed(state.iterations() * paths.size);
}

void bench_frame(benchmark::State& state, std::string_view isa, uint32_t threads) {
  apply_isa(isa);
  const World& world = bench_world();
  RenderStats stats;
  int64_t samples = 0;
  for (auto _ : state) {
    Film film(world.settings.width, world.settings.height);
    RenderProgress progress;
    stats = render(world, {.threads = threads}, Cancellation(), progress, film);
    samples += static_cast<int64_t>(stats.counters.samples);
  }
  state.SetItemsProcessed(samples);
  const auto ratio = [&](double value, uint64_t of) { return value / static_cast<double>(of); };
  const Counters& c = stats.counters;
  state.counters["cpu_us_per_sample"] = 1e6 * ratio(stats.cpu_seconds, c.samples);
  state.counters["embree_share"] = c.embree_seconds / stats.cpu_seconds;
  state.counters["vertices_per_sample"] = ratio(static_cast<double>(c.camera_rays + c.bounce_rays), c.samples);
  apply_isa("native");
}

const bool registered = [] {
  for (const std::string_view isa : available_isa_names()) {
    const std::string suffix = std::string("/").append(isa);
    for (const Stage& stage : stages)
      benchmark::RegisterBenchmark(std::string("System/").append(stage.name).append(suffix).c_str(),
                                   [&stage, isa](benchmark::State& state) { bench_stage(state, stage, isa); });
    benchmark::RegisterBenchmark(("Frame/one_thread" + suffix).c_str(),
                                 [isa](benchmark::State& state) { bench_frame(state, isa, 1); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
  benchmark::RegisterBenchmark("Frame/all_threads",
                               [](benchmark::State& state) { bench_frame(state, "native", available_threads()); })
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
  benchmark::RegisterBenchmark("RawEmbree/closest", [](benchmark::State& state) { bench_raw_embree(state, false); });
  benchmark::RegisterBenchmark("RawEmbree/occluded", [](benchmark::State& state) { bench_raw_embree(state, true); });
  return true;
}();

}  // namespace
}  // namespace metamer::bench
