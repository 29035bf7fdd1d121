// A frozen world and the streams of a real batch at some depth, for benchmarks of the systems.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "systems/pipeline.h"

namespace metamer::bench {

// The world of METAMER_BENCH_SCENE, else of the default scene, at 512 pixels on the shorter side; loaded once. Stops
// the program with the reader's messages if it cannot be read.
const World& bench_world();

// A scene that comes with metamer, for frames: 256 pixels on the shorter side, 16 samples per pixel. Stops the program
// if it cannot be read, and frozen() if it cannot be built.
Scene shipped_scene_for_frames(const char* name);
std::unique_ptr<World> frozen(const Scene& scene);

// A batch whose streams are as the pipeline leaves them when `depth` is about to be shaded: rays traced, hits sorted,
// surfaces and light samples there. Columns are at their usual size.
std::unique_ptr<Batch> batch_at_depth(const World& world, uint32_t depth);

}  // namespace metamer::bench
