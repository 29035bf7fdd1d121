// What a registry holds, as lines of text that a test can compare: a line per shape, light and camera, in the order of
// the file, with its place in the file in front.
#pragma once
#include <string>
#include <vector>

#include "engine/ecs/scene.h"

namespace metamer {

std::vector<std::string> registry_text(const Scene& scene);

// What differs from the settings of a file that says nothing.
std::string settings_text(const RenderSettings& settings);

}  // namespace metamer
