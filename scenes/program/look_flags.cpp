#include "scenes/program/look_flags.h"

#include <fmt/format.h>

#include "engine/diagnostics.h"
#include "systems/display_colour.h"

namespace metamer {
namespace {

std::string names_text(std::span<const std::string_view> names) { return fmt::format("{}", fmt::join(names, ", ")); }

// d65, d50, a, none or kelvin, as 5600 or 5600K.
std::optional<Color3> parse_white(const std::string& text, Observer observer, Mistakes& mistakes) {
  const std::string word = in_lower_case(text);
  if (word == "none") return std::nullopt;
  const auto names = white_names();
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == word) return white_at(i, observer);
  std::string_view digits = word;
  if (!digits.empty() && digits.back() == 'k') digits.remove_suffix(1);
  if (!digits.empty() && std::string_view("0123456789+-.").find(digits[0]) != std::string_view::npos) {
    const auto kelvin = parse_real("--white", digits, static_cast<float>(least_white_kelvin),
                                   static_cast<float>(most_white_kelvin), mistakes);
    return kelvin ? std::optional(white_of_temperature(*kelvin, observer)) : std::nullopt;
  }
  const std::vector<std::string_view> all = {names[0], names[1], names[2], "none"};
  mistakes.push_back(fmt::format("--white: unknown white '{}'{}; there are {}, and a temperature in kelvin", text,
                                 did_you_mean(word, all), names_text(all)));
  return std::nullopt;
}

// Those of tone_map.h, and ACES.
std::vector<std::string_view> tone_map_names() {
  std::vector<std::string_view> names(tone_curve_names().begin(), tone_curve_names().end());
  names.push_back("aces");
  return names;
}

void parse_tone_map(const CLI::App& command, const LookTexts& texts, Look& look, Mistakes& mistakes) {
  const std::vector<std::string_view> names = tone_map_names();
  if (command.count("--tonemap") > 0)
    if (const auto index = parse_name("--tonemap", texts.tone_map, names, mistakes)) {
      look.aces = *index == tone_curve_count;
      if (!look.aces) look.curve = static_cast<ToneCurve>(*index);
    }
  if (command.count("--tonemap-white") == 0) return;
  if (const auto white = parse_real("--tonemap-white", texts.tone_map_white, 1e-3f, 1e6f, mistakes))
    look.reinhard_white = *white;
  if (look.curve != ToneCurve::reinhard_extended)
    mistakes.push_back("--tonemap-white: belongs to --tonemap reinhard-extended");
}

void parse_ocio(const CLI::App& command, const LookTexts& texts, Look& look, Mistakes& mistakes) {
  if (command.count("--ocio") == 0) {
    for (const char* flag : {"--ocio-display", "--ocio-view"})
      if (command.count(flag) > 0) mistakes.push_back(fmt::format("{}: no configuration was given by --ocio", flag));
    return;
  }
  for (const char* flag : {"--display", "--tonemap"})
    if (command.count(flag) > 0) mistakes.push_back(fmt::format("{}: with --ocio, the view decides that", flag));
  if (texts.ocio.empty()) {
    mistakes.push_back("--ocio: the name of an OpenColorIO configuration was expected");
    return;
  }
  OcioView view{texts.ocio, texts.ocio_display, texts.ocio_view};
  if (OcioError error = resolve(view)) mistakes.push_back(*error);
  look.view = view;
}

}  // namespace

void add_look_flags(CLI::App& command, LookTexts& texts) {
  const auto option = [&](const char* name, std::string& value, const char* type, const std::string& text) {
    command.add_option(name, value, text)->type_name(type)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  };
  option("--observer", texts.observer, "NAME",
         "Whose eyes: " + names_text(observer_names()) + "; cie1931 if not given, others need the bands of --spectral");
  option("--display", texts.display, "NAME", names_text(display_names()) + "; srgb if not given");
  option("--white", texts.white, "WHITE",
         "What shall look neutral: d65, d50, a, a temperature such as 3200, or none (as recorded) if not given");
  option("--adaptation", texts.adaptation, "NAME",
         "How --white is reached: " + names_text(adaptation_names()) + "; cat16 if not given");
  option("--tonemap", texts.tone_map, "NAME", names_text(tone_map_names()) + "; linear if not given");
  option("--tonemap-white", texts.tone_map_white, "L", "The light that reinhard-extended makes white; 4 if not given");
  option("--ocio", texts.ocio, "CONFIG", "An OpenColorIO configuration, instead of --display and --tonemap");
  option("--ocio-display", texts.ocio_display, "NAME", "Its display; its default one if not given");
  option("--ocio-view", texts.ocio_view, "NAME", "Its view; the display's default one if not given");
}

Look parse_look(const CLI::App& command, const LookTexts& texts, Mistakes& mistakes) {
  Look look;
  const auto given = [&](const char* flag) { return command.count(flag) > 0; };
  if (given("--display"))
    if (const auto index = parse_name("--display", texts.display, display_names(), mistakes))
      look.display = display_at(*index);
  if (given("--observer"))
    if (const auto index = parse_name("--observer", texts.observer, observer_names(), mistakes))
      look.observer = static_cast<Observer>(*index);
  if (given("--white")) look.white = parse_white(texts.white, look.observer, mistakes);
  if (given("--adaptation")) {
    if (const auto index = parse_name("--adaptation", texts.adaptation, adaptation_names(), mistakes))
      look.adaptation = static_cast<Adaptation>(*index);
    if (!given("--white") || in_lower_case(texts.white) == "none")
      mistakes.push_back("--adaptation: says how to reach a white, but no --white was given");
  }
  parse_tone_map(command, texts, look, mistakes);
  parse_ocio(command, texts, look, mistakes);
  return look;
}

}  // namespace metamer
