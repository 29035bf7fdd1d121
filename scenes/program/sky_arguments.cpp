#include "scenes/program/sky_arguments.h"

#include <fmt/format.h>

namespace metamer {
namespace {

constexpr const char* footer =
    R"(Prints what such a day gives: luminance and colour of the zenith, illuminance by sky and sun. OUT.exr is
the sky without the sun: latitude and longitude, linear Rec. 2020 in cd/m^2, zenith on top. OUT.json is a scene of
two lights, that image (written beside it) and the sun, for entities and a camera to be added. In a scene file the
light "type": "sky" takes the same values and needs no other file.

Examples:
  metamer sky --turbidity 2.5 --sun-elevation 30
  metamer sky --sun-elevation 12 --sun-azimuth 250 -o evening.json)";

}  // namespace

void add_sky(CLI::App& app, SkyArguments& arguments, SkyTexts& texts) {
  CLI::App* sky = app.add_subcommand("sky", "Make a clear sky and its sun");
  sky->footer(footer);
  const auto option = [&](const std::string& name, std::string& value, const char* type, const std::string& text) {
    sky->add_option(name, value, text)->type_name(type)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  };
  option("--turbidity", texts.turbidity, "T", "Haze from 2 (clear) to 10 (thick), 3 if not given");
  option("--sun-elevation", texts.elevation, "DEG", "Above the horizon, to 90; 45 if not given");
  option("--sun-azimuth", texts.azimuth, "DEG", "From north over east; 180, south, if not given");
  option("--ground-albedo", texts.albedo, "A", "Of the ground below the horizon, 0 to 1; 0.2 if not given");
  option("--resolution", texts.resolution, "N", "Rows of the image, even; 256 if not given");
  sky->add_flag("--no-sun", texts.no_sun, "The sky alone");
  option("-o,--output", arguments.output, "OUT", "A scene, .json, or its image alone, .exr");
}

void parse_sky(const CLI::App& sky, const SkyTexts& texts, SkyArguments& arguments, Mistakes& mistakes) {
  SkySettings& settings = arguments.settings;
  const auto real = [&](const char* flag, const std::string& text, double least, double most, double fallback) {
    if (sky.count(flag) == 0) return fallback;
    const auto value = parse_real(flag, text, static_cast<float>(least), static_cast<float>(most), mistakes);
    return value ? double{*value} : fallback;
  };
  settings.turbidity = real("--turbidity", texts.turbidity, turbidity_min, turbidity_max, settings.turbidity);
  settings.sun_elevation_deg = real("--sun-elevation", texts.elevation, 0, 90, settings.sun_elevation_deg);
  if (!(settings.sun_elevation_deg > 0))
    mistakes.push_back(fmt::format("--sun-elevation: expected a number above 0, not '{}'", texts.elevation));
  settings.sun_azimuth_deg = real("--sun-azimuth", texts.azimuth, -360, 360, settings.sun_azimuth_deg);
  settings.ground_albedo = real("--ground-albedo", texts.albedo, 0, 1, settings.ground_albedo);
  settings.has_sun = !texts.no_sun;
  if (sky.count("--resolution") > 0)
    if (const auto rows = parse_count("--resolution", texts.resolution, resolution_min, resolution_max, mistakes)) {
      settings.resolution = *rows;
      if (*rows % 2 != 0) mistakes.push_back(fmt::format("--resolution: expected an even number, not '{}'", *rows));
    }
}

}  // namespace metamer
