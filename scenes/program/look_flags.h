// The flags that say how a picture should look: the same words for every command.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "scenes/program/values.h"
#include "systems/write_frame.h"

namespace metamer {

// Flags as text, the way they were written; where they are not given, the look's defaults.
struct LookTexts {
  std::string observer, display, white, adaptation, tone_map, tone_map_white;
  std::string ocio, ocio_display, ocio_view;
};

void add_look_flags(CLI::App& command, LookTexts& texts);

// The look without its exposure, which the commands read themselves. Reads the configuration that --ocio names.
Look parse_look(const CLI::App& command, const LookTexts& texts, Mistakes& mistakes);

}  // namespace metamer
