// The numbers of a render as JSON, see docs/commands.md.
#pragma once
#include <string>

#include "engine/files/atomic_file.h"
#include "engine/film/film.h"
#include "systems/render.h"

namespace metamer {

struct FrameReport {
  std::string scene;  // as the user named it
  RenderSettings settings;
  RenderStats render;
  SampleTotals samples;
  uint64_t invalid_samples = 0;
  double load_seconds = 0, build_seconds = 0;
  double first_pixel_seconds = 0;  // from the program's start until the first tile was in the film
  size_t film_bytes = 0, world_bytes = 0;
  uint32_t tile_size = 0;
  bool is_interrupted = false;
};

// The largest resident memory of this program so far. Not getrusage's: that begins with what the parent held.
size_t peak_rss_bytes();

FileError write_stats(const std::string& path, const FrameReport& report);

}  // namespace metamer
