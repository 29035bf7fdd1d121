#include "systems/render.h"

#include <sys/resource.h>

#include <chrono>
#include <memory>

#include "engine/schedule/tiles.h"

namespace metamer {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double process_cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// What a worker owns for the whole frame: nothing is allocated while paths are traced.
struct Worker {
  Batch batch;
  TileFilm film;
  Counters counters;
};

struct Frame {
  const World& world;
  Film& film;
  RenderProgress& progress;
  std::vector<TileRect> tiles;
  std::vector<SampleRange> passes;
  std::vector<std::unique_ptr<Worker>> workers;
  Clock::time_point start;
  std::atomic<bool> has_pixels{false};
  double first_pixel_seconds = 0;
};

void render_unit(void* context, uint32_t worker_index, size_t unit) {
  Frame& frame = *static_cast<Frame*>(context);
  Worker& worker = *frame.workers[worker_index];
  const TileRect& tile = frame.tiles[unit % frame.tiles.size()];
  const SampleRange& pass = frame.passes[unit / frame.tiles.size()];
  trace_tile(frame.world, tile, pass.begin, pass.end, worker.batch, worker.film, worker.counters);
  flush(frame.film, worker.film);
  if (!frame.has_pixels.exchange(true)) frame.first_pixel_seconds = seconds_since(frame.start);
  const uint64_t samples = uint64_t{tile.width()} * tile.height() * (pass.end - pass.begin);
  frame.progress.samples_done.fetch_add(samples, std::memory_order_relaxed);
}

std::vector<TileRect> tiles_of(const TileRect& rendered, uint32_t tile_size) {
  std::vector<TileRect> tiles = make_tiles(rendered.width(), rendered.height(), tile_size);
  for (TileRect& tile : tiles)
    tile = {tile.x0 + rendered.x0, tile.y0 + rendered.y0, tile.x1 + rendered.x0, tile.y1 + rendered.y0};
  return tiles;
}

// The systems' clocks tell the wall's time. On a machine that others use, too, a worker is kept waiting in the midst of
// any system: their seconds are shares of the processor time that the workers really had.
void to_processor_time(RenderStats& stats) {
  double wall = 0;
  for (const double seconds : stats.counters.seconds) wall += seconds;
  if (!(wall > stats.cpu_seconds)) return;
  const double share = stats.cpu_seconds / wall;
  for (double& seconds : stats.counters.seconds) seconds *= share;
  stats.counters.embree_seconds *= share;
}

}  // namespace

RenderStats render(const World& world, const RenderOptions& options, const Cancellation& cancellation,
                   RenderProgress& progress, Film& film) {
  const RenderSettings& settings = world.settings;
  RenderStats stats;
  stats.threads = options.threads == 0 ? available_threads() : options.threads;
  Frame frame{world,
              film,
              progress,
              tiles_of(rendered_pixels(settings), options.tile_size),
              make_passes(settings.samples_per_pixel),
              {},
              Clock::now()};
  progress.samples_total = uint64_t{film.width()} * film.height() * settings.samples_per_pixel;
  for (uint32_t i = 0; i < stats.threads; ++i) frame.workers.push_back(std::make_unique<Worker>());
  const double cpu_before = process_cpu_seconds();
  run_units(stats.threads, frame.tiles.size() * frame.passes.size(), cancellation, render_unit, &frame);
  stats.render_seconds = seconds_since(frame.start);
  stats.cpu_seconds = process_cpu_seconds() - cpu_before;
  stats.first_pixel_seconds = frame.first_pixel_seconds;
  stats.batch_bytes = frame.workers.front()->batch.bytes();
  for (const auto& worker : frame.workers) stats.counters.add(worker->counters);
  to_processor_time(stats);
  return stats;
}

}  // namespace metamer
