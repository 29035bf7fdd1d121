// The commands of the program. They return an exit code or throw Failure.
#pragma once
#include <chrono>

#include "scenes/program/command_line.h"

namespace metamer {

// `program_start` is when main began.
int run_render(const RenderArguments& arguments, std::chrono::steady_clock::time_point program_start);
int run_info(const InfoArguments& arguments);
int run_version();

}  // namespace metamer
