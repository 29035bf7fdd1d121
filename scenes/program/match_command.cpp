#include <fmt/format.h>

#include "engine/files/output_kind.h"
#include "engine/files/png_file.h"
#include "engine/spectrum/dominant_wavelength.h"
#include "engine/spectrum/lamps.h"
#include "scenes/program/commands.h"
#include "scenes/program/failure.h"
#include "scenes/program/light_argument.h"
#include "scenes/program/match_field.h"
#include "systems/tone_map.h"

namespace metamer {
namespace {

// As 500, 500.5, 500nm or 500 nm.
std::optional<double> wavelength(const std::string& text) {
  std::string_view digits = text;
  if (in_lower_case(text).ends_with("nm")) digits.remove_suffix(2);
  while (!digits.empty() && digits.back() == ' ') digits.remove_suffix(1);
  return number_argument(digits);
}

struct Match {
  Color3 amounts;
  std::string unit;    // what amounts are amounts of
  std::string colour;  // the light in the CIE 1931 diagram
};

std::string chromaticity_text(const Color3& xyz, const Color3& white) {
  const std::array<double, 2> xy = chromaticity(xyz);
  const DominantWavelength dominant = dominant_wavelength(xy, chromaticity(white));
  std::string text = fmt::format("CIE 1931 x {:.4f}, y {:.4f}", xy[0], xy[1]);
  if (dominant.purity < 1e-6) return text + ", white";
  return text + fmt::format("; {} wavelength {:.1f} nm, purity {:.3f}",
                            dominant.is_complementary ? "complementary" : "dominant", dominant.lambda_nm,
                            dominant.purity);
}

Match match_line(double lambda_nm, const MatchArguments& arguments) {
  const auto [first, last] = observer_range(arguments.observer);
  if (!(lambda_nm >= first && lambda_nm <= last))
    throw Failure(exit_wrong_input, fmt::format("{}: expected a wavelength from {} to {} nm, where the observer {} was "
                                                "measured",
                                                arguments.light, first, last, observer_name(arguments.observer)));
  if (!arguments.under.empty())
    throw Failure(exit_wrong_input, "--under: a wavelength is a light itself; a reflectance was expected");
  const auto xy = chromaticity(Color3(observer_value(Observer::cie1931, lambda_nm)));
  return {lamp_amounts_of_line(lambda_nm, arguments.observer), fmt::format("one unit of radiance of {} nm", lambda_nm),
          fmt::format("CIE 1931 x {:.4f}, y {:.4f}, on the spectrum itself", xy[0], xy[1])};
}

Match match_spectrum(const MatchArguments& arguments) {
  Samples light = read_light(arguments.light), white{};
  white.fill(1);
  std::string unit = arguments.light + " as its numbers are, per nm";
  if (!arguments.under.empty()) {
    white = read_light(arguments.under);
    for (size_t i = 0; i < lambda_count; ++i) light[i] *= white[i];
    unit = fmt::format("{} under {}", arguments.light, arguments.under);
  }
  const Color3 tristimulus = integrate_xyz(light, arguments.observer), xyz = integrate_xyz(light);
  if (tristimulus == Color3{} || !(xyz[1] > 0))
    throw Failure(exit_wrong_input, fmt::format("{}: holds no light that the observer {} sees", arguments.light,
                                                observer_name(arguments.observer)));
  return {lamp_amounts(tristimulus, arguments.observer), unit, chromaticity_text(xyz, integrate_xyz(white))};
}

void tell(const Match& match, Observer observer) {
  constexpr std::array<const char*, 3> names = {"red", "green", "blue"};
  fmt::print("{}, to the observer {}, is matched by\n", match.unit, observer_name(observer));
  for (size_t lamp = 0; lamp < 3; ++lamp)
    fmt::print("  {:.2f} nm  {:5}  {:>13.6g}{}\n", lamp_nm[lamp], names[lamp], match.amounts[lamp],
               match.amounts[lamp] < 0 ? "  negative: added to the other side, to the light" : "");
  fmt::print("{}\n", match.colour);
}

void write_field(const std::string& path, const Color3& amounts) {
  ToneSettings settings;
  settings.dither = false;
  const CodedPicture codes = tone_map(match_field(amounts), settings);
  if (const FileError error = write_png(path, codes, "metamer " METAMER_VERSION)) throw Failure(exit_failed, *error);
}

}  // namespace

int run_match(const MatchArguments& arguments) {
  if (!arguments.output.empty())
    if (const FileError error = check_writable(arguments.output, OutputKind::png))
      throw Failure(output_kind(arguments.output) == OutputKind::png ? exit_failed : exit_wrong_input,
                    fmt::format("--output: {}", *error));
  const std::optional<double> lambda_nm = wavelength(arguments.light);
  const Match match = lambda_nm ? match_line(*lambda_nm, arguments) : match_spectrum(arguments);
  if (!arguments.quiet) tell(match, arguments.observer);
  if (!arguments.output.empty()) {
    write_field(arguments.output, match.amounts);
    if (!arguments.quiet) fmt::print("PNG   {}\n", arguments.output);
  }
  return exit_done;
}

}  // namespace metamer
