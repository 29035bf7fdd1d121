#include "scenes/program/convert_arguments.h"

#include <fmt/format.h>

#include <filesystem>

namespace metamer {
namespace {

constexpr const char* footer =
    R"(Rendering OUT.json gives the same pixels as rendering SCENE, to the last bit. Meshes (binary PLY) and images go to the
folder OUT-files beside it, which OUT.json names by relative paths: move the two together. Files that exist are
replaced. Everything is in it that metamer renders; what it does not, and warns of, is lost.

Examples:
  metamer convert kitchen/scene.pbrt kitchen.json
  metamer convert kitchen.json edited/kitchen.json)";

}  // namespace

void add_convert(CLI::App& app, ConvertArguments& arguments) {
  CLI::App* convert = app.add_subcommand("convert", "Write a scene as metamer JSON");
  convert->footer(footer);
  convert->add_option("PATHS", arguments.paths, "The scene, pbrt-v4 or metamer JSON, and the .json file to write")
      ->type_name("");
  convert->add_flag("--strict", arguments.strict,
                    "Warnings and notes are errors, as long as the picture depends on them");
  convert->add_flag("-q,--quiet", arguments.quiet, "Print nothing but errors");
}

void parse_convert(const ConvertArguments& arguments, Mistakes& mistakes) {
  const std::vector<std::string>& paths = arguments.paths;
  if (paths.size() != 2) {
    mistakes.push_back(
        fmt::format("a scene and the file to write were expected, not {}: metamer convert SCENE OUT.json",
                    paths.empty() ? "nothing" : fmt::format("{} name{}", paths.size(), paths.size() == 1 ? "" : "s")));
  } else if (in_lower_case(std::filesystem::path(paths[1]).extension().string()) != ".json") {
    mistakes.push_back(paths[1] + ": expected a name ending in .json");
  }
}

}  // namespace metamer
