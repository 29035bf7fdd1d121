// What the user asked for: the arguments, checked as far as they can be without a scene.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "engine/ecs/scene.h"
#include "scenes/program/compare_arguments.h"
#include "scenes/program/convert_arguments.h"
#include "scenes/program/match_arguments.h"
#include "scenes/program/sky_arguments.h"
#include "systems/write_frame.h"

namespace metamer {

// Flags that replace what the scene says.
struct SceneOverrides {
  std::optional<uint32_t> width, height;  // pixels; both or neither
  std::optional<uint32_t> samples_per_pixel, max_depth, seed, band_count;
  std::optional<float> exposure_stops, clamp_indirect;
  std::optional<Integrator> integrator;
  bool no_shadows = false;  // false: what the scene says
  std::optional<ColorMode> color;
  std::optional<uint64_t> texture_memory;  // bytes
};

struct RenderArguments {
  std::string scene;            // empty: the default scene
  std::string exr, png, stats;  // as given; empty: not given
  SceneOverrides overrides;
  uint32_t threads = 0;             // 0: all
  uint32_t tile_size = 32;          // pixels
  Look look;                        // of the PNG; all but its exposure and threads
  bool automatic_exposure = false;  // of the PNG, instead of the scene's
  bool preview_only = false;
  bool strict = false;  // what is not supported is an error
  bool quiet = false;
};

struct DevelopArguments {
  std::string input;   // an EXR with a film
  std::string output;  // .png or .exr
  Look look;           // all but its exposure and threads
  std::optional<float> exposure_stops;
  bool automatic_exposure = false;
  uint32_t threads = 0;  // 0: all
  bool quiet = false;
};

struct InfoArguments {
  std::string scene;
  bool strict = false;
  bool json = false;
};

struct ShowVersion {};

// Help that was asked for.
struct ShowText {
  std::string text;
};

using Command = std::variant<RenderArguments, DevelopArguments, MatchArguments, MetamersArguments, CompareArguments,
                             SkyArguments, ConvertArguments, InfoArguments, ShowVersion, ShowText>;

// Throws Failure (exit 2) with a line for each mistake.
Command parse_command_line(int argc, char** argv);

}  // namespace metamer
