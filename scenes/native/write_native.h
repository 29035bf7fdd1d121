// The native format as a file: what read_native reads, to the last bit.
#pragma once
#include <string>

#include "engine/ecs/scene.h"
#include "engine/files/atomic_file.h"
#include "engine/schedule/workers.h"

namespace metamer {

// What was written.
struct NativeFiles {
  std::string folder;  // of the side files; empty if there are none
  size_t meshes = 0, images = 0, grids = 0;
  uint64_t bytes = 0;   // of all files together
  Diagnostics remarks;  // what the format cannot say: it is written as it is rendered
};

// Writes the scene to `path` and its meshes (PLY), images and grids (OpenVDB) beside it, to the folder "NAME-files" for
// "NAME.json", which the scene names by relative paths: both can be moved together. Equal scenes give equal bytes, and
// a scene that was read from the result gives the same result again. Files of these names are replaced, others in the
// folder stay. Everything is written to a temporary folder first; after an error or a cancellation what was there is as
// it was.
FileError write_native(const Scene& scene, const std::string& path, const Cancellation& cancellation,
                       NativeFiles& files);

// What would prevent it, found without a scene.
FileError check_native_target(const std::string& path);

}  // namespace metamer
