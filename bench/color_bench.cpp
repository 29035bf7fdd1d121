// What wavelengths cost against three coefficients: whole frames of three scenes, in turns within one run, so that
// whatever else the machine does falls on both. Samples are camera samples; seconds are processor time of all threads.
#include <benchmark/benchmark.h>

#include <array>
#include <string>

#include "bench/scene_fixture.h"
#include "systems/render.h"

namespace metamer::bench {
namespace {

struct ColorScene {
  const char* name;
  const char* shipped;
  bool only_diffuse;  // every material replaced: nothing but evaluating spectra and tracing rays
};
constexpr std::array<ColorScene, 3> scenes = {{{"cornell-diffuse", "cornell-spectral", true},
                                               {"cornell-spectral", "cornell-spectral", false},
                                               {"metals", "metals", false}}};

std::unique_ptr<World> world_in(const ColorScene& chosen, ColorMode color) {
  Scene scene = shipped_scene_for_frames(chosen.shipped);
  scene.settings.color = color;
  if (chosen.only_diffuse) {
    const SpectrumId grey = scene.spectra.add_constant(0.7).id;
    scene.registry.each<Material>([&](Entity entity, uint32_t) {
      Material material = scene.registry.get<Material>(entity);
      if (material.kind != MaterialKind::diffuse) material.reflectance = grey;
      material.kind = MaterialKind::diffuse;
      scene.registry.set(entity, material);
    });
  }
  return frozen(scene);
}

double frame_seconds(const World& world, uint64_t* samples) {
  Film film(world.settings.width, world.settings.height);
  RenderProgress progress;
  const RenderStats stats = render(world, {}, Cancellation(), progress, film);
  *samples = stats.counters.samples;
  return stats.cpu_seconds;
}

void bench_color(benchmark::State& state, const ColorScene& scene, ColorMode mode) {
  const std::unique_ptr<World> spectral = world_in(scene, ColorMode::spectral), other = world_in(scene, mode);
  double spectral_seconds = 0, other_seconds = 0;
  uint64_t samples = 0, all = 0;
  for (auto _ : state) {
    spectral_seconds += frame_seconds(*spectral, &samples);
    other_seconds += frame_seconds(*other, &samples);
    all += samples;
  }
  state.counters["spectral_samples_per_cpu_second"] = static_cast<double>(all) / spectral_seconds;
  state.counters["rgb_samples_per_cpu_second"] = static_cast<double>(all) / other_seconds;
  state.counters["spectral_over_rgb"] = spectral_seconds / other_seconds;
}

const bool registered = [] {
  for (const ColorScene& scene : scenes)
    for (const ColorMode mode : {ColorMode::rgb, ColorMode::lamps})
      benchmark::RegisterBenchmark(
          std::string("Color/").append(scene.name).append("/").append(color_mode_name(mode)).c_str(),
          [&scene, mode](benchmark::State& state) { bench_color(state, scene, mode); })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime()
          ->MinTime(3);
  return true;
}();

}  // namespace
}  // namespace metamer::bench
