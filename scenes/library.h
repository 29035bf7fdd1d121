// The scenes that come with metamer.
#pragma once
#include <string>
#include <string_view>

namespace metamer {

inline constexpr std::string_view default_scene_name = "cornell-spectral.json";

// The path of a shipped scene, wherever this program lives: in an installation <prefix>/share/metamer/scenes beside
// <prefix>/bin, else the source tree it was built from. Where neither has the file, the path in the source tree, so
// that the reader's message names it.
std::string shipped_scene(std::string_view name);

// What METAMER_DEFAULT_SCENE names, if set and not empty; else the shipped default scene.
std::string default_scene();

}  // namespace metamer
