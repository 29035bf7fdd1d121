// The commands of the program. They return an exit code or throw Failure.
#pragma once
#include "scenes/program/command_line.h"

namespace metamer {

// The name under which an EXR remembers the exposure of its PNG, in stops.
inline constexpr const char* exposure_setting = "exposure_stops";

int run_render(const RenderArguments& arguments);
int run_develop(const DevelopArguments& arguments);
int run_match(const MatchArguments& arguments);
int run_metamers(const MetamersArguments& arguments);
int run_compare(const CompareArguments& arguments);
int run_sky(const SkyArguments& arguments);
int run_convert(const ConvertArguments& arguments);
int run_info(const InfoArguments& arguments);
int run_version();

}  // namespace metamer
