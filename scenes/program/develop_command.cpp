#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "engine/files/output_kind.h"
#include "engine/files/spectral_exr.h"
#include "scenes/program/commands.h"
#include "scenes/program/failure.h"
#include "scenes/program/look_report.h"
#include "scenes/program/signals.h"
#include "systems/compare_pictures.h"
#include "systems/develop_bands.h"
#include "systems/display_colour.h"
#include "systems/write_frame.h"

namespace metamer {
namespace {

// Read by the signal handlers. Never asked for: a picture is developed at once or not at all.
Cancellation cancellation;

OutputKind check_output(const DevelopArguments& arguments) {
  const std::optional<OutputKind> kind = output_kind(arguments.output);
  const FileError error = check_writable(arguments.output);
  if (error) throw Failure(kind ? exit_failed : exit_wrong_input, fmt::format("--output: {}", *error));
  std::error_code missing;
  if (std::filesystem::equivalent(arguments.input, arguments.output, missing))
    throw Failure(exit_wrong_input,
                  arguments.output + ": is the film itself, another file was expected for the output");
  return *kind;
}

// What OpenEXR would say less clearly: there is no file, or it is of another kind.
void check_input(const std::string& path) {
  std::error_code failed;
  if (std::filesystem::is_directory(path, failed)) throw Failure(exit_wrong_input, path + ": is a folder, not a film");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Failure(exit_wrong_input, fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  constexpr std::array<char, 4> magic = {0x76, 0x2f, 0x31, 0x01};
  std::array<char, 4> begin = {};
  file.read(begin.data(), begin.size());
  if (begin != magic)
    throw Failure(exit_wrong_input, path +
                                        ": is not an OpenEXR file; develop reads those that metamer render wrote, and "
                                        "spectral ones of others");
}

// By which a developed EXR is known.
constexpr const char* tone_map_setting = "tonemap";

// What there is to develop.
struct Seen {
  std::optional<XyzPicture> xyz;  // of bands, or of a picture in other primaries
  Picture picture;                // else linear sRGB
  FrameHeader header;
  SampleTotals samples;  // none where only bands were read
};

void refuse_developed(const std::string& path, const FrameHeader& header) {
  for (const auto& [name, value] : header.settings)
    if (name == tone_map_setting)
      throw Failure(exit_wrong_input, path + ": has been developed already; develop takes what metamer render wrote");
}

// The 1931 observer takes the picture that render wrote; all others, and spectral files of others, the bands.
Seen look_at_file(const std::string& path, Observer observer, uint32_t threads) {
  ExrContents contents;
  if (const FileError error = look_into_exr(path, contents)) throw Failure(exit_wrong_input, *error);
  Seen seen;
  if (observer == Observer::cie1931 && (contents.has_film || !contents.has_bands)) {
    if (const FileError error = read_picture(path, seen.picture, seen.header, seen.samples))
      throw Failure(exit_wrong_input, *error);
    refuse_developed(path, seen.header);
    if (seen.header.chromaticities != display_chromaticities(ColorSpace::srgb))
      seen.xyz = xyz_of(seen.picture, seen.header.chromaticities);
    return seen;
  }
  if (!contents.has_bands)
    throw Failure(exit_wrong_input,
                  fmt::format("{}: --observer {}: holds no bands, only what the cie1931 observer sees; metamer render "
                              "--spectral records bands",
                              path, observer_name(observer)));
  SpectralPicture spectral;
  if (const FileError error = read_spectral_picture(path, spectral, seen.header))
    throw Failure(exit_wrong_input, *error);
  seen.xyz = integrate_bands(spectral, band_matrix(spectral.edges_nm, observer), threads);
  return seen;
}

// What the frame was rendered with, if the file remembers.
float remembered_exposure(const FrameHeader& header) {
  float stops = 0;
  for (const auto& [name, value] : header.settings)
    if (name == exposure_setting) std::from_chars(value.data(), value.data() + value.size(), stops);
  return stops;
}

Look chosen_look(const DevelopArguments& arguments, OutputKind kind, const FrameHeader& header) {
  Look look = arguments.look;
  look.threads = arguments.threads;
  if (arguments.exposure_stops)
    look.exposure_stops = *arguments.exposure_stops;
  else if (arguments.automatic_exposure)
    look.exposure_stops = std::nullopt;
  else
    look.exposure_stops = kind == OutputKind::png ? remembered_exposure(header) : 0.0f;
  return look;
}

std::string white_text(const std::optional<Color3>& white) {
  if (!white) return "none";
  const std::array<double, 2> xy = chromaticity(*white);
  return fmt::format("{:.5f} {:.5f}", xy[0], xy[1]);
}

// The settings of the render, with how it was developed.
void describe(FrameHeader& header, const Look& look, float exposure_stops) {
  header.software = "metamer " METAMER_VERSION;
  std::erase_if(header.settings, [](const auto& setting) { return setting.first == exposure_setting; });
  header.settings.emplace_back(exposure_setting, fmt::format("{}", exposure_stops));
  header.settings.emplace_back("observer", observer_name(look.observer));
  header.settings.emplace_back("display", display_name(look.display));
  header.settings.emplace_back("white", white_text(look.white));
  if (look.white) header.settings.emplace_back("adaptation", adaptation_names()[static_cast<size_t>(look.adaptation)]);
  header.settings.emplace_back(tone_map_setting, tone_map_text(look));
}

}  // namespace

int run_develop(const DevelopArguments& arguments) {
  const OutputKind kind = check_output(arguments);
  check_input(arguments.input);
  install_signal_handlers(cancellation);
  const Seen seen = look_at_file(arguments.input, arguments.look.observer, arguments.threads);
  FrameHeader header = seen.header;
  const Look look = chosen_look(arguments, kind, header);
  Developed developed = seen.xyz ? develop(*seen.xyz, look) : develop(seen.picture, look);
  const float stops = developed.tone.exposure_stops;
  describe(header, look, stops);
  if (!arguments.quiet) tell_negative_amounts(developed);
  const FileError error = kind == OutputKind::png
                              ? write_developed_png(arguments.output, std::move(developed), header.software)
                              : write_developed_exr(arguments.output, std::move(developed), header, seen.samples);
  if (error) throw Failure(exit_failed, *error);
  if (!arguments.quiet) {
    if (arguments.automatic_exposure) fmt::print(stderr, "metamer: exposure {:+.2f} stops\n", stops);
    fmt::print("{}   {}\n", kind == OutputKind::png ? "PNG" : "EXR", arguments.output);
  }
  return exit_done;
}

}  // namespace metamer
