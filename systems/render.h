// A frame: every tile and sample of a world into a film, on all threads.
#pragma once
#include "engine/schedule/workers.h"
#include "systems/pipeline.h"

namespace metamer {

struct RenderOptions {
  uint32_t threads = 0;  // 0: all
  uint32_t tile_size = 32;
};

// Read by another thread while rendering.
struct RenderProgress {
  std::atomic<uint64_t> samples_done{0};  // camera samples
  std::atomic<uint64_t> samples_total{0};
};

struct RenderStats {
  Counters counters;
  double render_seconds = 0, cpu_seconds = 0, first_pixel_seconds = 0;
  size_t batch_bytes = 0;  // of one worker
  uint32_t threads = 0;
};

// Adds settings.samples_per_pixel samples to every pixel of `film`, which has the size of the world's settings and is
// empty. After a cancellation the film holds whole units only, each pixel a first part of its samples.
RenderStats render(const World& world, const RenderOptions& options, const Cancellation& cancellation,
                   RenderProgress& progress, Film& film);

}  // namespace metamer
