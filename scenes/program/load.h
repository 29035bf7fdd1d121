// From a path to the world, with everything said about it printed.
#pragma once
#include <memory>
#include <string>

#include "engine/ecs/scene.h"
#include "engine/ecs/world.h"
#include "scenes/program/command_line.h"

namespace metamer {

struct LoadedScene {
  Scene scene;
  Diagnostics diagnostics;
  double seconds = 0;
};

// What is made of remarks. quiet: they are not printed; strict: they are errors, but for those it allows.
struct Remarks {
  bool quiet = false, strict = false;
};

// Reads a scene and applies the flags. Throws Failure (exit 2) where there are errors, after printing them.
LoadedScene load_scene(const std::string& path, const SceneOverrides& overrides, Remarks remarks);

struct BuiltWorld {
  std::unique_ptr<World> world;
  Diagnostics diagnostics;
  double seconds = 0;
};

// Freezes a scene that was read from `path`. Throws and prints as load_scene. What is not needed any more is best
// handed over: its meshes and images are given back on the way.
BuiltWorld build_world(const LoadedScene& loaded, const std::string& path, Remarks remarks);
BuiltWorld build_world(LoadedScene&& loaded, const std::string& path, Remarks remarks);

// Memory held by the columns of a world; Embree's trees are not among them.
size_t world_bytes(const World& world);

}  // namespace metamer
