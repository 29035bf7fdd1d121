#include "scenes/program/match_arguments.h"

#include <fmt/format.h>

namespace metamer {
namespace {

constexpr const char* match_footer =
    R"(Three lamps of 645.16, 526.32 and 444.44 nm are mixed until they look like a light. A lamp with a negative amount has
to be added to the light's side: of pure colours the lamps alone make none but their own.
LIGHT is a wavelength in nm, the name of an illuminant or of a ColorChecker patch, or a file of lines "nm value".

Examples:
  metamer match 500
  metamer match 500 -o match.png
  metamer match D65 --observer cie1931
  metamer match lamp.csv -o lamp.png
  metamer match colorchecker.cyan --under A)";

constexpr const char* metamers_footer =
    R"(Makes two reflectances that look alike in one light and differ in another: BASE plus and minus a curve that adds
nothing to any of the three tristimulus values of the one light.
BASE is a grey from 0 to 1, the name of a ColorChecker patch, or a file of lines "nm value".

Examples:
  metamer metamers 0.4
  metamer metamers colorchecker.light_skin --same D65 --apart A -o skin.json
  metamer metamers 0.5 --same FL11 --apart D65)";

}  // namespace

void add_match(CLI::App& app, MatchArguments& arguments, ObserverTexts& texts) {
  CLI::App* match = app.add_subcommand("match", "Match a light with three lamps");
  match->footer(match_footer);
  match->add_option("LIGHT", arguments.light, "A wavelength in nm, a named spectrum or a file")->type_name("");
  const auto option = [&](const char* name, std::string& value, const char* type, const std::string& text) {
    match->add_option(name, value, text)->type_name(type)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  };
  option("-o,--output", arguments.output, "OUT.png", "The two halves of the field, and the amounts as bars");
  option("--observer", texts.observer, "NAME",
         fmt::format("{}; stiles-burch1955 if not given", fmt::join(observer_names(), ", ")));
  option("--under", arguments.under, "LIGHT", "LIGHT is a reflectance, lit by this");
  match->add_flag("-q,--quiet", arguments.quiet, "Print nothing but errors");
}

void parse_match(const CLI::App& match, const ObserverTexts& texts, MatchArguments& arguments, Mistakes& mistakes) {
  if (match.count("--observer") > 0)
    if (const auto index = parse_name("--observer", texts.observer, observer_names(), mistakes))
      arguments.observer = static_cast<Observer>(*index);
  if (arguments.light.empty()) mistakes.push_back("a light was expected: metamer match NM|SPECTRUM");
  if (match.count("--under") > 0 && arguments.under.empty())
    mistakes.push_back("--under: the name of a spectrum or a file was expected");
  if (match.count("--output") > 0 && arguments.output.empty())
    mistakes.push_back("--output: the name of a .png file was expected");
  if (arguments.quiet && arguments.output.empty())
    mistakes.push_back("--quiet: nothing would be left to do without --output");
}

void add_metamers(CLI::App& app, MetamersArguments& arguments, ObserverTexts& texts) {
  CLI::App* metamers = app.add_subcommand("metamers", "Make two reflectances that look alike in one light only");
  metamers->footer(metamers_footer);
  metamers->add_option("BASE", arguments.base, "A grey from 0 to 1, a named reflectance or a file")->type_name("");
  const auto option = [&](const char* name, std::string& value, const char* type, const std::string& text) {
    metamers->add_option(name, value, text)->type_name(type)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  };
  option("--same", arguments.same, "LIGHT", "In which they look alike: a name or a file; D65 if not given");
  option("--apart", arguments.apart, "LIGHT", "In which they differ: a name or a file; A if not given");
  option("--observer", texts.observer, "NAME",
         fmt::format("To whom: {}; cie1931 if not given", fmt::join(observer_names().first(4), ", ")));
  option("-o,--output", arguments.output, "OUT.json", "Both spectra, as the `spectra` of a scene");
}

void parse_metamers(const CLI::App& metamers, const ObserverTexts& texts, MetamersArguments& arguments,
                    Mistakes& mistakes) {
  // Those of X, Y, Z: colour differences are stated in CIELAB.
  if (metamers.count("--observer") > 0)
    if (const auto index = parse_name("--observer", texts.observer, observer_names().first(4), mistakes))
      arguments.observer = static_cast<Observer>(*index);
  if (arguments.base.empty()) mistakes.push_back("a reflectance was expected: metamer metamers BASE");
  if (arguments.same.empty()) mistakes.push_back("--same: the name of a spectrum or a file was expected");
  if (arguments.apart.empty()) mistakes.push_back("--apart: the name of a spectrum or a file was expected");
  if (metamers.count("--output") > 0 && arguments.output.empty())
    mistakes.push_back("--output: the name of a file was expected");
}

}  // namespace metamer
