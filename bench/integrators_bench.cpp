// Camera samples per second of each integrator on three of our scenes, on all threads: one frame of 256 pixels on the
// shorter side. An item is a camera sample.
#include <benchmark/benchmark.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "scenes/library.h"
#include "scenes/read_scene.h"
#include "systems/freeze.h"
#include "systems/render.h"

namespace metamer::bench {
namespace {

constexpr std::array<const char*, 3> scenes = {"cornell-spectral", "three-levels", "still-life"};
constexpr uint32_t shorter_side = 256, samples_per_pixel = 16;

std::unique_ptr<World> load_world(const std::string& name, Integrator integrator) {
  Scene scene;
  Diagnostics diagnostics;
  std::unique_ptr<World> world;
  if (read_scene(shipped_scene(name + ".json"), scene, diagnostics)) {
    RenderSettings& settings = scene.settings;
    const uint32_t shorter = std::min(settings.width, settings.height);
    settings.width = settings.width * shorter_side / shorter;
    settings.height = settings.height * shorter_side / shorter;
    settings.samples_per_pixel = samples_per_pixel;
    settings.integrator = integrator;
    world = freeze(scene, diagnostics);
  }
  if (world == nullptr) {
    std::fputs(format_diagnostics(diagnostics).c_str(), stderr);
    std::exit(2);
  }
  return world;
}

void bench_integrator(benchmark::State& state, const char* scene, Integrator integrator) {
  const std::unique_ptr<World> world = load_world(scene, integrator);
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
