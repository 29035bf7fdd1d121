// Scenes in the file format of pbrt-v4. What is understood, and what happens instead of the rest, is in docs/pbrt.md.
#pragma once
#include <string>

#include "engine/ecs/scene.h"

namespace metamer {

// Adds the scene of the file to `scene` and overwrites its settings. Every mistake and every statement that is not
// supported goes to `diagnostics` with its file and line; false if any of them is an error (the scene then holds what
// could be understood). Never throws for what a file contains.
//
// World and camera space are pbrt's own. A light's spectrum S is divided by 683 times the integral of S ybar (for rgb
// and images: of the colour space's white alone) before `scale`, `power` and `illuminance` apply, as in pbrt-v4.
bool read_pbrt(const std::string& path, Scene& scene, Diagnostics& diagnostics);

}  // namespace metamer
