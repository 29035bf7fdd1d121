#include "bench/scene_fixture.h"

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "scenes/library.h"
#include "scenes/read_scene.h"
#include "systems/freeze.h"

namespace metamer::bench {
namespace {

[[noreturn]] void stop(const Diagnostics& diagnostics) {
  std::fputs(format_diagnostics(diagnostics).c_str(), stderr);
  std::exit(2);
}

void set_shorter_side(uint32_t pixels, RenderSettings& settings) {
  const uint32_t shorter = std::min(settings.width, settings.height);
  settings.width = settings.width * pixels / shorter;
  settings.height = settings.height * pixels / shorter;
}

std::unique_ptr<World> load_world() {
  const char* chosen = std::getenv("METAMER_BENCH_SCENE");
  const std::string path = chosen != nullptr && *chosen != '\0' ? chosen : default_scene();
  Scene scene;
  Diagnostics diagnostics;
  if (!read_scene(path, scene, diagnostics)) stop(diagnostics);
  set_shorter_side(512, scene.settings);
  return frozen(scene);
}

void trace(const World& world, uint32_t depth, Batch& batch) {
  double embree_seconds = 0;
  if (depth == 0)
    intersect_camera(world, batch.paths, batch.hits, &embree_seconds);
  else
    intersect_bounce(world, batch.paths, batch.hits, &embree_seconds);
  sort_hits(world, 0, batch.paths, batch.hits, batch.order, batch.shade.groups);
  batch.shade.size = batch.shade.groups.back().padded_end();
  surface(world, batch.paths, batch.hits, batch.order, batch.shade);
  if (!world.lights.empty()) light_sample(world, depth, batch.shade);
}

}  // namespace

const World& bench_world() {
  static const std::unique_ptr<World> world = load_world();
  return *world;
}

Scene shipped_scene_for_frames(const char* name) {
  Scene scene;
  Diagnostics diagnostics;
  if (!read_scene(shipped_scene(std::string(name) + ".json"), scene, diagnostics)) stop(diagnostics);
  set_shorter_side(256, scene.settings);
  scene.settings.samples_per_pixel = 16;
  return scene;
}

std::unique_ptr<World> frozen(const Scene& scene) {
  Diagnostics diagnostics;
  std::unique_ptr<World> world = freeze(scene, diagnostics);
  if (world == nullptr) stop(diagnostics);
  return world;
}

std::unique_ptr<Batch> batch_at_depth(const World& world, uint32_t depth) {
  auto batch = std::make_unique<Batch>();
  const TileRect tile{192, 192, 256, 256};
  std::vector<RayPacket> packets;
  for (uint32_t i = 0; i < batch_capacity / column_lanes; ++i)
    packets.push_back({tile.x0 + 4 * (i % 16), tile.y0 + 4 * (i / 16 % 16), i / 256});
  camera_rays(world, packets, tile, batch->paths, batch->slots);
  trace(world, 0, *batch);
  for (uint32_t d = 0; d < depth; ++d) {
    batch->shadow.size = 0;
    shade_rough_kinds(world, {d}, batch->shade, batch->shadow);
    shade_smooth_conductor(world, batch->shade);
    shade_dielectric(world, d, Branch::drawn, batch->shade);
    roulette(d, batch->shade, batch->next);
    std::swap(batch->paths, batch->next);
    trace(world, d + 1, *batch);
  }
  return batch;
}

}  // namespace metamer::bench
