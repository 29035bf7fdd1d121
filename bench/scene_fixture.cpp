#include "bench/scene_fixture.h"

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "scenes/library.h"
#include "scenes/read_scene.h"
#include "systems/freeze.h"

namespace metamer::bench {
namespace {

std::unique_ptr<World> load_world() {
  const char* chosen = std::getenv("METAMER_BENCH_SCENE");
  const std::string path = chosen != nullptr && *chosen != '\0' ? chosen : default_scene();
  Scene scene;
  Diagnostics diagnostics;
  std::unique_ptr<World> world;
  if (read_scene(path, scene, diagnostics)) {
    const uint32_t shorter = std::min(scene.settings.width, scene.settings.height);
    scene.settings.width = scene.settings.width * 512 / shorter;
    scene.settings.height = scene.settings.height * 512 / shorter;
    world = freeze(scene, diagnostics);
  }
  if (world == nullptr) {
    std::fputs(format_diagnostics(diagnostics).c_str(), stderr);
    std::exit(2);
  }
  return world;
}

void trace(const World& world, uint32_t depth, Batch& batch) {
  double embree_seconds = 0;
  if (depth == 0)
    intersect_camera(world, batch.paths, batch.hits, &embree_seconds);
  else
    intersect_bounce(world, batch.paths, batch.hits, &embree_seconds);
  sort_hits(world, batch.paths.size, batch.hits, batch.order, batch.shade.groups);
  batch.shade.size = batch.shade.groups.back().padded_end();
  surface(world, batch.paths, batch.hits, batch.order, batch.shade);
  if (!world.lights.empty()) light_sample(world, depth, batch.shade);
}

}  // namespace

const World& bench_world() {
  static const std::unique_ptr<World> world = load_world();
  return *world;
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
