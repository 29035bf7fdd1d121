#include "scenes/program/compare_arguments.h"

#include <fmt/format.h>

#include <array>

#include "engine/files/output_kind.h"
#include "engine/film/film.h"

namespace metamer {
namespace {

constexpr const char* compare_footer =
    R"(Prints the mean, median, 95 % quantile and maximum of CIEDE2000 over all pixels; 1 is about what can just be seen
side by side. Both pictures are taken at one exposure: that of A's render if neither is said otherwise. Colours brighter
than display white count as white is bright.

A scene is rendered spectral and with three coefficients, same seed and samples: what RGB rendering gets wrong. Written
are NAME-spectral.png, NAME-rgb.png (or -lamps) and the map, NAME-difference.png if -o does not name it.

Examples:
  metamer compare cornell-box.json --spp 256
  metamer compare cornell-box.json --spp 256 --color lamps -o error.png --map-scale 20
  metamer compare before.exr after.exr -o difference.png)";

constexpr std::array<const char*, 5> scene_flags = {"--color", "--size", "--spp", "--seed", "--strict"};

void check_inputs(const CLI::App& compare, const CompareArguments& arguments, Mistakes& mistakes) {
  const std::vector<std::string>& inputs = arguments.inputs;
  if (inputs.empty() || inputs.size() > 2) {
    mistakes.push_back(fmt::format(
        "two EXR files or one scene were expected, not {}: metamer compare A.exr B.exr, metamer compare SCENE",
        inputs.empty() ? "nothing" : fmt::format("{} names", inputs.size())));
    return;
  }
  for (const std::string& input : inputs)
    if ((output_kind(input) == OutputKind::exr) == arguments.is_scene())
      mistakes.push_back(input + (arguments.is_scene() ? ": a second EXR file to compare with was expected"
                                                       : ": an EXR file was expected"));
  if (arguments.is_scene()) return;
  for (const char* flag : scene_flags)
    if (compare.count(flag) > 0)
      mistakes.push_back(fmt::format("{}: says how to render, but files are compared", flag));
}

}  // namespace

void add_compare(CLI::App& app, CompareArguments& arguments, CompareTexts& texts) {
  CLI::App* compare = app.add_subcommand("compare", "Say and show how different two pictures look");
  compare->footer(compare_footer);
  compare->add_option("INPUT", arguments.inputs, "Two EXR files, or one scene: spectral against RGB")->type_name("");
  const auto option = [&](const std::string& name, std::string& value, const char* type, const std::string& text) {
    compare->add_option(name, value, text)->type_name(type)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  };
  option("-o,--output", arguments.output, "MAP.png", "The difference of every pixel: black is none");
  option("--map-scale", texts.scale, "DELTA_E",
         fmt::format("The difference that is white in the map; {} if not given", default_map_scale));
  option("--exposure", texts.exposure, "STOPS|auto", "At which the pictures are compared; that of A if not given");
  option("--color", texts.color, "MODE", "Of a scene, what spectral is compared with: rgb, lamps; rgb if not given");
  option("--size", texts.size, "WxH", "Of a scene: width and height in pixels");
  option("--spp", texts.samples_per_pixel, "N", "Of a scene: samples per pixel");
  option("--seed", texts.seed, "N", "Of a scene: another seed, another noise");
  option("--threads", texts.threads, "N", "Threads; all that there are if not given; changes no pixel");
  compare->add_flag("--strict", arguments.strict,
                    "Of a scene: warnings and notes are errors, as long as the picture depends on them");
  compare->add_flag("-q,--quiet", arguments.quiet, "Print the numbers only");
}

void parse_compare(const CLI::App& compare, const CompareTexts& texts, CompareArguments& arguments,
                   Mistakes& mistakes) {
  const auto given = [&](const char* flag) { return compare.count(flag) > 0; };
  check_inputs(compare, arguments, mistakes);
  if (given("--output") && arguments.output.empty()) mistakes.push_back("--output: the file's name is empty");
  if (given("--map-scale"))
    arguments.map_scale = parse_real("--map-scale", texts.scale, 0.01f, 1000, mistakes).value_or(default_map_scale);
  if (given("--exposure")) {
    arguments.automatic_exposure = in_lower_case(texts.exposure) == "auto";
    if (!arguments.automatic_exposure)
      arguments.exposure_stops = parse_real("--exposure", texts.exposure, -100, 100, mistakes, " or auto");
  }
  if (given("--color"))
    if (const auto index = parse_name("--color", texts.color, color_mode_names().subspan(1), mistakes))
      arguments.color = static_cast<ColorMode>(*index + 1);
  if (given("--size"))
    if (const auto size = parse_size("--size", texts.size, mistakes)) {
      arguments.width = size->first;
      arguments.height = size->second;
    }
  if (given("--spp"))
    arguments.samples_per_pixel = parse_count("--spp", texts.samples_per_pixel, 1, max_samples_per_pixel, mistakes);
  if (given("--seed")) arguments.seed = parse_count("--seed", texts.seed, 0, 0xffffffffu, mistakes);
  if (given("--threads")) arguments.threads = parse_count("--threads", texts.threads, 1, 1024, mistakes).value_or(0);
}

}  // namespace metamer
