// The arguments of `metamer sky`.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "scenes/program/values.h"
#include "scenes/sky/sky.h"

namespace metamer {

struct SkyArguments {
  SkySettings settings;
  std::string output;  // .json or .exr; empty: nothing is written
};

struct SkyTexts {
  std::string turbidity, elevation, azimuth, albedo, resolution;
  bool no_sun = false;
};

void add_sky(CLI::App& app, SkyArguments& arguments, SkyTexts& texts);
void parse_sky(const CLI::App& sky, const SkyTexts& texts, SkyArguments& arguments, Mistakes& mistakes);

}  // namespace metamer
