// The one door for scene files of every format.
#pragma once
#include <string>

#include "engine/ecs/scene.h"

namespace metamer {

// Reads a file into an empty scene: .json in our own format, .pbrt in pbrt-v4's; other extensions by content. False
// after reporting every mistake; the scene is then not to be used.
bool read_scene(const std::string& path, Scene& scene, Diagnostics& diagnostics);

}  // namespace metamer
