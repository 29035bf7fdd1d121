// The numbers of a render as JSON, see docs/commands.md.
#pragma once
#include <string>

#include "engine/files/atomic_file.h"
#include "engine/film/film.h"
#include "scenes/program/grid_report.h"
#include "systems/image_cache.h"
#include "systems/render.h"

namespace metamer {

struct FrameReport {
  std::string scene;  // as the user named it
  RenderSettings settings;
  RenderStats render;
  SampleTotals samples;
  uint64_t invalid_samples = 0;
  double load_seconds = 0, build_seconds = 0;
  // From the process's start until rays are traced, and until the first tile was in the film.
  double first_ray_seconds = 0, first_pixel_seconds = 0;
  size_t film_bytes = 0, world_bytes = 0;
  size_t texture_bytes = 0;  // in memory
  ImageCacheStats texture_cache;
  std::vector<GridReport> grids;  // of the scene
  uint32_t tile_size = 0;
  bool is_interrupted = false;
};

// The largest resident memory of this program so far. Not getrusage's: that begins with what the parent held.
size_t peak_rss_bytes();

// How long ago this process was started, to a hundredth of a second: what loaded its libraries counts, too.
double process_age_seconds();

FileError write_stats(const std::string& path, const FrameReport& report);

}  // namespace metamer
