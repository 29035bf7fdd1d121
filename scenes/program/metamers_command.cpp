#include <fmt/format.h>

#include <cmath>

#include "engine/files/atomic_file.h"
#include "engine/spectrum/metamers.h"
#include "scenes/program/commands.h"
#include "scenes/program/failure.h"
#include "scenes/program/light_argument.h"

namespace metamer {
namespace {

Samples read_base(const std::string& text) {
  Samples base;
  if (const std::optional<double> grey = number_argument(text)) {
    if (!(*grey >= 0 && *grey <= 1)) throw Failure(exit_wrong_input, text + ": expected a grey from 0 to 1");
    base.fill(*grey);
    return base;
  }
  base = read_light(text);
  for (size_t i = 0; i < lambda_count; ++i)
    if (base[i] > 1)
      throw Failure(exit_wrong_input, fmt::format("{}: is {} at {} nm; a reflectance, 0 to 1, was expected", text,
                                                  base[i], lambda_min_nm + static_cast<int>(i)));
  return base;
}

Samples read_lamp(const char* flag, const std::string& text, Observer observer) {
  const Samples lamp = read_light(text);
  for (const double value : integrate_xyz(lamp, observer))
    if (!(value > 0)) throw Failure(exit_wrong_input, fmt::format("{}: {} is not seen as a white", flag, text));
  return lamp;
}

// Seven decimals: rounding then moves no tristimulus value by 1e-7 of white.
MetamerCurve rounded(MetamerCurve curve) {
  for (double& v : curve) v = std::round(v * 1e7) / 1e7;
  return curve;
}

std::string table_text(const MetamerCurve& curve) {
  std::string text = "{ \"table\": [";
  for (size_t i = 0; i < metamer_points; ++i)
    text += fmt::format("{}{}[{:.0f}, {:.7f}]", i == 0 ? "" : ",", i % 5 == 0 ? "\n      " : " ", metamer_lambda_nm(i),
                        curve[i]);
  return text + "\n    ] }";
}

void write_spectra(const std::string& path, const std::string& name, const std::array<MetamerCurve, 2>& pair) {
  const std::string text = fmt::format("{{\n  \"spectra\": {{\n    \"{0} 1\": {1},\n    \"{0} 2\": {2}\n  }}\n}}\n",
                                       name, table_text(pair[0]), table_text(pair[1]));
  AtomicFile file;
  FileError error = file.open(path);
  if (!error) error = file.write(text.data(), text.size());
  if (!error) error = file.commit();
  if (error) throw Failure(exit_failed, *error);
}

void tell(const std::string& light, const Viewing& viewing, const std::array<Samples, 2>& pair) {
  const Color3 first = seen_xyz(pair[0], viewing), second = seen_xyz(pair[1], viewing);
  fmt::print("  {:8} {:11}  {:.7f} {:.7f} {:.7f}  {:.7f} {:.7f} {:.7f}  {:7.3f}\n", light,
             observer_name(viewing.observer), first[0], first[1], first[2], second[0], second[1], second[2],
             seen_difference(pair[0], pair[1], viewing));
}

// The last part of a file's path without what cannot stand in a JSON string.
std::string spectrum_title(const std::string& base) {
  std::string title;
  for (const char c : base.substr(base.find_last_of('/') + 1))
    if (c >= ' ' && c != '"' && c != '\\') title += c;
  return title;
}

}  // namespace

int run_metamers(const MetamersArguments& arguments) {
  if (!arguments.output.empty())
    if (const FileError error = check_target(arguments.output)) throw Failure(exit_failed, *error);
  const Observer observer = arguments.observer;
  const Observer other = observer == Observer::cie1964 ? Observer::cie1931 : Observer::cie1964;
  const Viewing same{read_lamp("--same", arguments.same, observer), observer};
  const Viewing apart{read_lamp("--apart", arguments.apart, observer), observer};
  const Viewing to_another{same.light, other};
  std::array<MetamerCurve, 2> curves = make_metamers(read_base(arguments.base), same, {apart, to_another});
  for (MetamerCurve& curve : curves) curve = rounded(curve);
  const std::array<Samples, 2> pair = {metamer_samples(curves[0]), metamer_samples(curves[1])};

  fmt::print("two reflectances around {}: X Y Z of the first and the second, white having Y = 1, and delta E 1976\n",
             arguments.base);
  tell(arguments.same, same, pair);
  tell(arguments.same, to_another, pair);
  tell(arguments.apart, apart, pair);
  tell(arguments.apart, {apart.light, other}, pair);
  if (!arguments.output.empty()) {
    write_spectra(arguments.output, spectrum_title(arguments.base), curves);
    fmt::print("JSON  {}\n", arguments.output);
  }
  return exit_done;
}

}  // namespace metamer
