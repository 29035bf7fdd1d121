// Camera samples per second of each integrator on three of our scenes, on all threads: one frame of 256 pixels on the
// shorter side. An item is a camera sample.
#include <benchmark/benchmark.h>

#include <array>
#include <string>

#include "bench/scene_fixture.h"
#include "systems/render.h"

namespace metamer::bench {
namespace {

constexpr std::array<const char*, 3> scenes = {"cornell-spectral", "three-levels", "still-life"};

void bench_integrator(benchmark::State& state, const char* scene, Integrator integrator) {
  Scene changed = shipped_scene_for_frames(scene);
  changed.settings.integrator = integrator;
  const std::unique_ptr<World> world = frozen(changed);
  RenderStats stats;
  int64_t samples = 0;
  for (auto _ : state) {
    Film film(world->settings.width, world->settings.height);
    RenderProgress progress;
    stats = render(*world, {}, Cancellation(), progress, film);
    samples += static_cast<int64_t>(stats.counters.samples);
  }
  state.SetItemsProcessed(samples);
  const Counters& c = stats.counters;
  const auto per_sample = [&](uint64_t rays) { return static_cast<double>(rays) / static_cast<double>(c.samples); };
  state.counters["rays_per_sample"] = per_sample(c.camera_rays + c.bounce_rays + c.shadow_rays);
}

const bool registered = [] {
  for (const char* scene : scenes)
    for (const Integrator integrator : {Integrator::local, Integrator::recursive, Integrator::path}) {
      const std::string name = std::string("Integrator/").append(scene).append("/").append(integrator_name(integrator));
      benchmark::RegisterBenchmark(name.c_str(),
                                   [=](benchmark::State& state) { bench_integrator(state, scene, integrator); })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    }
  return true;
}();

}  // namespace
}  // namespace metamer::bench
