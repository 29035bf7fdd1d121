#include "scenes/program/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>

#include "engine/diagnostics.h"
#include "engine/film/film.h"
#include "scenes/program/failure.h"
#include "scenes/program/look_flags.h"
#include "scenes/program/values.h"

namespace metamer {
namespace {

constexpr uint32_t most_threads = 1024;
constexpr uint32_t largest_tile = 1024;   // pixels: beyond, a thread's own sums would no longer be small
constexpr uint32_t deepest_path = 65535;  // scattering events
constexpr uint64_t least_texture_memory = uint64_t{32} << 20;  // what the cache needs, and as much again
constexpr float largest_exposure = 100.0f;                     // stops: what tone mapping takes

constexpr const char* strict_help = "Warnings and notes are errors, as long as the picture depends on them";

constexpr const char* main_footer = R"(Examples:
  metamer render                                   the default scene
  metamer render cornell-box/scene.pbrt --spp 64   writes cornell-box.exr and cornell-box.png here
  metamer develop cornell-box.exr -o look.png --tonemap agx --exposure auto
  metamer match 500 -o match.png                   the amounts of three lamps that look like 500 nm
  metamer compare cornell-box.json                 what RGB rendering gets wrong
  metamer convert kitchen/scene.pbrt kitchen.json
  metamer info kitchen.json
  metamer render --help                            all flags of a command

METAMER_ISA=sse4, avx2 or avx512 chooses another instruction set than the best.
Exit codes: 0 done, 1 could not do it or was interrupted, 2 wrong usage or wrong scene.)";

constexpr const char* render_footer =
    R"(Flags override what the scene says. Without -o and --png the pictures are named after the scene and
written to the current folder; with one of the two the other picture is written beside it. Ctrl-C writes
what was rendered so far (exit code 1), a second one stops at once.

Examples:
  metamer render cornell-box/scene.pbrt
  metamer render prism.json -o /tmp/prism.exr --size 1920x1080 --spp 1024
  metamer render prism.json --size 320x180 --spp 16 --exposure +1.5 --stats prism-stats.json --quiet
  metamer render prism.json --spectral             with 36 bands, for other observers)";

constexpr const char* develop_footer =
    R"(IN.exr is what metamer render wrote, or a spectral OpenEXR file of others (channels such as S0.550,000nm). The
observer of 1931 takes the picture of a file of metamer render, else bands; other observers need bands. A PNG
is encoded for the display, with an ICC profile for all but srgb; an EXR stays linear and takes exposure and tone curve
too. Without --exposure a PNG takes that of the render, an EXR none.

Examples:
  metamer develop cornell-box.exr -o cornell-box.png
  metamer develop prism.exr -o prism.png --observer cie2015-10
  metamer develop lamp.exr -o lamp.png --white a --exposure auto --tonemap hable
  metamer develop lamp.exr -o lamp-2020.exr --display rec2020 --white 3200 --adaptation bradford)";

constexpr const char* info_footer = R"(Examples:
  metamer info kitchen/scene.pbrt
  metamer info prism.json --json)";

// Flags as text, the way they were written.
struct RenderTexts {
  std::string samples_per_pixel, size, threads, tile, seed, max_depth, spectral, exposure, integrator, color,
      clamp_indirect, texture_memory;
  bool no_shadows = false;
  LookTexts look;
};
struct DevelopTexts {
  std::string exposure, threads;
  LookTexts look;
};

void add_render(CLI::App& app, RenderArguments& arguments, RenderTexts& texts) {
  CLI::App* render = app.add_subcommand("render", "Render a scene to an EXR and a PNG");
  render->footer(render_footer);
  render->add_option("SCENE", arguments.scene, "pbrt-v4 or metamer JSON file; without one, the default scene")
      ->type_name("");
  const auto option = [&](const std::string& name, std::string& value, const char* type, const std::string& text) {
    render->add_option(name, value, text)->type_name(type)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  };
  option("-o,--output", arguments.exr, "OUT.exr", "Linear EXR, sRGB primaries, 1 = white of 1 cd/m^2");
  option("--png", arguments.png, "OUT.png", "PNG, 8 bit");
  option("--spp", texts.samples_per_pixel, "N", "Samples per pixel");
  option("--size", texts.size, "WxH", "Width and height in pixels");
  option("--threads", texts.threads, "N", "Threads; all that there are if not given");
  option("--tile", texts.tile, "N", "Side of a tile in pixels, 32 if not given; changes no pixel");
  option("--seed", texts.seed, "N", "Another seed, another noise");
  option("--max-depth", texts.max_depth, "N", "Scattering events on a path; 0 shows only what emits");
  option("--integrator", texts.integrator, "NAME",
         "Which light is followed: local (straight from the light sources to rough surfaces), recursive (also by "
         "ideal reflection and refraction), path (all of it); or ambient_occlusion (how open surfaces are)");
  option("--clamp-indirect", texts.clamp_indirect, "L",
         "The most, in cd/m^2, that light scattered more than once may add to a sample at a time: no fireflies, but "
         "biased");
  render->add_flag("--no-shadows", texts.no_shadows, "Light sources shine through everything");
  option("--spectral", texts.spectral, "[N]",
         "Record the mean radiance of N bands from 380 to 740 nm too, 36 if N is not given; 0: none");
  option("--color", texts.color, "MODE",
         fmt::format("{}: light on sampled wavelengths, or as three coefficients, faster and less true; spectral if "
                     "not given",
                     fmt::join(color_mode_names(), ", ")));
  option("--exposure", texts.exposure, "STOPS|auto", "Brightens the PNG by powers of 2, as in develop; not the EXR");
  add_look_flags(*render, texts.look);
  option(
      "--texture-memory", texts.texture_memory, "SIZE",
      "Memory for the texels of textures, such as 512M or 2G; what exceeds it stays in files and is read in tiles as "
      "it is needed; no limit if not given; changes no pixel");
  option("--stats", arguments.stats, "STATS.json", "Write times, rays and memory there");
  render->add_flag("--preview-only", arguments.preview_only, "Leave the film's exact sums out of the EXR");
  render->add_flag("--strict", arguments.strict, strict_help);
  render->add_flag("-q,--quiet", arguments.quiet, "Print nothing but errors");
}

void add_develop(CLI::App& app, DevelopArguments& arguments, DevelopTexts& texts) {
  CLI::App* develop = app.add_subcommand("develop", "Turn a rendered film into a picture again");
  develop->footer(develop_footer);
  develop->add_option("IN.exr", arguments.input, "EXR with a film, as metamer render writes it, or with bands")
      ->type_name("");
  const auto option = [&](const std::string& name, std::string& value, const char* type, const std::string& text) {
    develop->add_option(name, value, text)->type_name(type)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  };
  option("-o,--output", arguments.output, "OUT", "The picture, .png or .exr");
  option("--exposure", texts.exposure, "STOPS|auto",
         "Brightens by powers of 2; auto: the geometric mean of luminance becomes 0.18");
  add_look_flags(*develop, texts.look);
  option("--threads", texts.threads, "N", "Threads; all that there are if not given; changes no pixel");
  develop->add_flag("-q,--quiet", arguments.quiet, "Print nothing but errors");
}

void add_info(CLI::App& app, InfoArguments& arguments) {
  CLI::App* info = app.add_subcommand("info", "Say what is in a scene");
  info->footer(info_footer);
  info->add_option("SCENE", arguments.scene, "pbrt-v4 or metamer JSON file; without one, the default scene")
      ->type_name("");
  info->add_flag("--strict", arguments.strict, strict_help);
  info->add_flag("--json", arguments.json, "Print JSON");
}

std::vector<std::string> flags_of(const CLI::App& app) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_snames()) flags.push_back(fmt::format("-{}", name));
    for (const std::string& name : option->get_lnames()) flags.push_back(fmt::format("--{}", name));
  }
  return flags;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& candidates) {
  return did_you_mean(word, std::vector<std::string_view>(candidates.begin(), candidates.end()));
}

std::string unknown_command(const std::string& word) {
  return fmt::format(
      "unknown command '{}'{}; there are render, develop, match, metamers, compare, sky, convert and info", word,
      word.find('.') != std::string::npos
          ? fmt::format(" (did you mean 'metamer render {}'?)", word)
          : suggestion(word, {"render", "develop", "match", "metamers", "compare", "sky", "convert", "info"}));
}

// The argument without a flag, and what it names.
std::pair<const char*, const char*> input_of(const CLI::App& command) {
  if (command.get_name() == "develop") return {"IN.exr", "film"};
  if (command.get_name() == "match") return {"LIGHT", "light"};
  if (command.get_name() == "metamers") return {"BASE", "reflectance"};
  return {"SCENE", "scene"};
}

// What no flag, scene or command took. After an unknown flag other words are no mistakes of their own: any of them may
// have been meant as its value.
void note_extras(const CLI::App& app, const CLI::App* command, Mistakes& mistakes) {
  const CLI::App& parsed = command != nullptr ? *command : app;
  std::string unexpected;
  bool has_unknown_flag = false;
  for (const std::string& word : parsed.remaining()) {
    if (word.size() < 2 || word[0] != '-') {
      if (unexpected.empty()) unexpected = word;
    } else if (word != "--") {
      const std::string flag = word.substr(0, word.find('='));
      mistakes.push_back(fmt::format("unknown flag '{}'{}", flag, suggestion(flag, flags_of(parsed))));
      has_unknown_flag = true;
    }
  }
  if (has_unknown_flag || unexpected.empty()) return;
  if (command == nullptr)
    mistakes.push_back(unknown_command(unexpected));
  else if (command->get_name() == "compare" || command->get_name() == "convert")
    mistakes.push_back(fmt::format("unexpected argument '{}'", unexpected));
  else if (command->get_name() == "sky")
    mistakes.push_back(fmt::format("unexpected argument '{}': sky takes flags only", unexpected));
  else
    mistakes.push_back(fmt::format("unexpected argument '{}': one {} at a time, and '{}' was named already", unexpected,
                                   input_of(*command).second,
                                   command->get_option(input_of(*command).first)->as<std::string>()));
}

bool is_automatic(const std::string& exposure) { return in_lower_case(exposure) == "auto"; }

SceneOverrides parse_overrides(const CLI::App& render, const RenderTexts& texts, Mistakes& mistakes) {
  SceneOverrides overrides;
  const auto given = [&](const char* flag) { return render.count(flag) > 0; };
  if (given("--size"))
    if (const auto size = parse_size("--size", texts.size, mistakes)) {
      overrides.width = size->first;
      overrides.height = size->second;
    }
  if (given("--spp"))
    overrides.samples_per_pixel = parse_count("--spp", texts.samples_per_pixel, 1, max_samples_per_pixel, mistakes);
  if (given("--max-depth"))
    overrides.max_depth = parse_count("--max-depth", texts.max_depth, 0, deepest_path, mistakes);
  overrides.no_shadows = texts.no_shadows;
  if (given("--integrator"))
    if (const auto place = parse_name("--integrator", texts.integrator, integrator_names, mistakes))
      overrides.integrator = static_cast<Integrator>(*place);
  if (given("--seed")) overrides.seed = parse_count("--seed", texts.seed, 0, 0xffffffffu, mistakes);
  if (given("--spectral"))
    overrides.band_count = parse_count("--spectral", texts.spectral, 0, max_band_count, mistakes);
  if (given("--texture-memory"))
    overrides.texture_memory = parse_bytes("--texture-memory", texts.texture_memory, least_texture_memory, mistakes);
  if (given("--color"))
    if (const auto index = parse_name("--color", texts.color, color_mode_names(), mistakes))
      overrides.color = static_cast<ColorMode>(*index);
  if (given("--clamp-indirect"))
    overrides.clamp_indirect = parse_real("--clamp-indirect", texts.clamp_indirect, 1e-6f, 1e12f, mistakes);
  if (given("--exposure") && !is_automatic(texts.exposure))
    overrides.exposure_stops =
        parse_real("--exposure", texts.exposure, -largest_exposure, largest_exposure, mistakes, " or auto");
  return overrides;
}

void parse_render(const CLI::App& render, const RenderTexts& texts, RenderArguments& arguments, Mistakes& mistakes) {
  arguments.overrides = parse_overrides(render, texts, mistakes);
  arguments.look = parse_look(render, texts.look, mistakes);
  arguments.automatic_exposure = render.count("--exposure") > 0 && is_automatic(texts.exposure);
  if (render.count("--threads") > 0)
    arguments.threads = parse_count("--threads", texts.threads, 1, most_threads, mistakes).value_or(0);
  if (render.count("--tile") > 0)
    arguments.tile_size = parse_count("--tile", texts.tile, 1, largest_tile, mistakes).value_or(1);
  const std::array<std::pair<const char*, const std::string*>, 3> names = {
      {{"--output", &arguments.exr}, {"--png", &arguments.png}, {"--stats", &arguments.stats}}};
  for (const auto& [flag, name] : names)
    if (render.count(flag) > 0 && name->empty()) mistakes.push_back(fmt::format("{}: the file's name is empty", flag));
  if (render.count("SCENE") > 0 && arguments.scene.empty()) mistakes.push_back("the scene's name is empty");
}

void parse_develop(const CLI::App& develop, const DevelopTexts& texts, DevelopArguments& arguments,
                   Mistakes& mistakes) {
  arguments.look = parse_look(develop, texts.look, mistakes);
  if (develop.count("--exposure") > 0) {
    arguments.automatic_exposure = is_automatic(texts.exposure);
    if (!arguments.automatic_exposure)
      arguments.exposure_stops =
          parse_real("--exposure", texts.exposure, -largest_exposure, largest_exposure, mistakes, " or auto");
  }
  if (develop.count("--threads") > 0)
    arguments.threads = parse_count("--threads", texts.threads, 1, most_threads, mistakes).value_or(0);
  if (arguments.input.empty()) mistakes.push_back("an EXR file was expected: metamer develop IN.exr -o OUT.png");
  if (arguments.output.empty()) mistakes.push_back("--output: the name of a .png or .exr file was expected");
}

// --spectral may stand alone: what follows it is its value only if it is a number. The words in reverse, as CLI11 wants
// them.
std::vector<std::string> reversed_words(int argc, char** argv) {
  std::vector<std::string> words;
  for (int i = argc - 1; i > 0; --i) {
    std::string word = argv[i];
    const bool has_number = !words.empty() && words.back().find_first_not_of("0123456789") == std::string::npos;
    if (word == "--spectral" && (!has_number || words.back().empty()))
      word = fmt::format("--spectral={}", default_band_count);
    words.push_back(std::move(word));
  }
  return words;
}

void fail_if_any(const Mistakes& mistakes) {
  if (!mistakes.empty()) throw Failure(exit_wrong_input, fmt::format("{}", fmt::join(mistakes, "\n")));
}

}  // namespace

Command parse_command_line(int argc, char** argv) {
  CLI::App app("metamer, a spectral renderer", "metamer");
  app.footer(main_footer);
  app.require_subcommand(0, 1);
  app.allow_extras();
  app.get_formatter()->column_width(28);
  bool wants_version = false;
  app.add_flag("--version", wants_version, "Version, libraries and instruction sets");
  RenderArguments render_arguments;
  RenderTexts render_texts;
  InfoArguments info_arguments;
  add_render(app, render_arguments, render_texts);
  DevelopArguments develop_arguments;
  DevelopTexts develop_texts;
  add_develop(app, develop_arguments, develop_texts);
  MatchArguments match_arguments;
  ObserverTexts match_texts;
  add_match(app, match_arguments, match_texts);
  MetamersArguments metamers_arguments;
  ObserverTexts metamers_texts;
  add_metamers(app, metamers_arguments, metamers_texts);
  CompareArguments compare_arguments;
  CompareTexts compare_texts;
  add_compare(app, compare_arguments, compare_texts);
  SkyArguments sky_arguments;
  SkyTexts sky_texts;
  add_sky(app, sky_arguments, sky_texts);
  ConvertArguments convert_arguments;
  add_convert(app, convert_arguments);
  add_info(app, info_arguments);
  for (CLI::App* command : app.get_subcommands({})) command->allow_extras();
  try {
    app.parse(reversed_words(argc, argv));
  } catch (const CLI::CallForHelp&) {
    return ShowText{app.help()};
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string what = error.what();
    throw Failure(exit_wrong_input, fmt::format("{}: a value was expected after it", what.substr(0, what.find(':'))));
  } catch (const CLI::ParseError& error) {
    throw Failure(exit_wrong_input, error.what());
  }

  const std::vector<CLI::App*> commands = app.get_subcommands();
  const CLI::App* command = commands.empty() ? nullptr : commands.front();
  Mistakes mistakes;
  note_extras(app, command, mistakes);
  if (command != nullptr) note_extras(app, nullptr, mistakes);  // flags before the command
  if (command != nullptr && command->get_name() == "render")
    parse_render(*command, render_texts, render_arguments, mistakes);
  if (command != nullptr && command->get_name() == "develop")
    parse_develop(*command, develop_texts, develop_arguments, mistakes);
  if (command != nullptr && command->get_name() == "match")
    parse_match(*command, match_texts, match_arguments, mistakes);
  if (command != nullptr && command->get_name() == "metamers")
    parse_metamers(*command, metamers_texts, metamers_arguments, mistakes);
  if (command != nullptr && command->get_name() == "compare")
    parse_compare(*command, compare_texts, compare_arguments, mistakes);
  if (command != nullptr && command->get_name() == "convert") parse_convert(convert_arguments, mistakes);
  if (command != nullptr && command->get_name() == "sky") parse_sky(*command, sky_texts, sky_arguments, mistakes);
  fail_if_any(mistakes);
  if (wants_version) return ShowVersion{};
  if (command == nullptr)
    throw Failure(exit_wrong_input,
                  "a command was expected: render, develop, match, metamers, compare, sky, convert or info (metamer "
                  "--help says more)");
  if (command->get_name() == "render") return render_arguments;
  if (command->get_name() == "develop") return develop_arguments;
  if (command->get_name() == "match") return match_arguments;
  if (command->get_name() == "metamers") return metamers_arguments;
  if (command->get_name() == "compare") return compare_arguments;
  if (command->get_name() == "sky") return sky_arguments;
  if (command->get_name() == "convert") return convert_arguments;
  return info_arguments;
}

}  // namespace metamer
