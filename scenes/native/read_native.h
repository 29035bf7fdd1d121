// metamer's own scene format, see docs/scene-format.md.
#pragma once
#include <string>

#include "engine/ecs/scene.h"
#include "scenes/file_bytes.h"

namespace metamer {

// Adds what the file describes to an empty scene. False after reporting all mistakes of the file and of the files it
// names; the scene is then not to be used.
bool read_native(const std::string& path, Scene& scene, Diagnostics& diagnostics);

// The same of a file that is in memory already.
bool read_native(const std::string& path, FileBytes bytes, Scene& scene, Diagnostics& diagnostics);

}  // namespace metamer
