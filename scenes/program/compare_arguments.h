// The arguments of `metamer compare`.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/spectrum/color_mode.h"
#include "scenes/program/values.h"

namespace metamer {

inline constexpr float default_map_scale = 10;  // CIEDE2000 that is white in the map

struct CompareArguments {
  std::vector<std::string> inputs;  // two .exr files, or one scene
  std::string output;               // .png of the map; empty: none for files, beside the others for a scene
  std::optional<float> exposure_stops;
  bool automatic_exposure = false;
  float map_scale = default_map_scale;
  uint32_t threads = 0;  // 0: all
  bool quiet = false;
  // Of a scene only.
  ColorMode color = ColorMode::rgb;  // what spectral is compared with
  std::optional<uint32_t> width, height, samples_per_pixel, seed;
  bool strict = false;  // what is not supported is an error
  bool is_scene() const { return inputs.size() == 1; }
};

struct CompareTexts {
  std::string exposure, scale, threads, color, size, samples_per_pixel, seed;
};

void add_compare(CLI::App& app, CompareArguments& arguments, CompareTexts& texts);
void parse_compare(const CLI::App& compare, const CompareTexts& texts, CompareArguments& arguments, Mistakes& mistakes);

}  // namespace metamer
