// `metamer convert`: its arguments.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "scenes/program/values.h"

namespace metamer {

struct ConvertArguments {
  std::vector<std::string> paths;  // SCENE and OUT.json
  bool strict = false;             // what is not supported is an error
  bool quiet = false;
};

void add_convert(CLI::App& app, ConvertArguments& arguments);
void parse_convert(const ConvertArguments& arguments, Mistakes& mistakes);

}  // namespace metamer
