#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "engine/files/exr_picture.h"
#include "engine/files/output_kind.h"
#include "scenes/program/commands.h"
#include "scenes/program/failure.h"
#include "scenes/program/load.h"
#include "scenes/program/outputs.h"
#include "scenes/program/progress.h"
#include "scenes/program/signals.h"
#include "systems/compare_pictures.h"
#include "systems/display_colour.h"
#include "systems/render.h"
#include "systems/write_frame.h"

namespace metamer {
namespace {

namespace fs = std::filesystem;

constexpr const char* software = "metamer " METAMER_VERSION;

// Read by the signal handlers. A comparison is made whole or not at all.
Cancellation cancellation;

void write(const std::string& path, const Picture& picture, float exposure_stops, uint32_t threads) {
  Developed developed;
  developed.picture = picture;
  developed.tone.exposure_stops = exposure_stops;
  developed.tone.threads = threads;
  if (const FileError error = write_developed_png(path, developed, software)) throw Failure(exit_failed, *error);
}

Picture linear_srgb(const XyzPicture& xyz) {
  Picture picture{xyz.width, xyz.height, {}, {}, {}};
  colour_match(display_matrix(ColorSpace::srgb, std::nullopt, Adaptation::cat16), xyz.X, xyz.Y, xyz.Z, picture.r,
               picture.g, picture.b);
  return picture;
}

float chosen_exposure(const CompareArguments& arguments, std::optional<float> remembered, const XyzPicture& first) {
  if (arguments.exposure_stops) return *arguments.exposure_stops;
  if (arguments.automatic_exposure) return automatic_exposure_stops(linear_srgb(first), ColorSpace::srgb);
  return remembered.value_or(0.0f);
}

void print_numbers(const PictureDifference& difference, uint32_t width, float exposure_stops) {
  fmt::print("CIEDE2000  mean {:.3f}, median {:.3f}, 95 % {:.3f}, max {:.3f} at pixel {},{}\n", difference.mean,
             difference.median, difference.percentile_95, difference.largest, difference.largest_pixel % width,
             difference.largest_pixel / width);
  if (difference.not_finite > 0) fmt::print("not finite {} pixels, left out above\n", difference.not_finite);
  fmt::print("exposure   {:+g} stops\n", exposure_stops);
}

void print_map(const CompareArguments& arguments, const std::string& path) {
  if (!arguments.quiet) fmt::print("map        {}: black is 0, white {:g} and more\n", path, arguments.map_scale);
}

void check_map(const std::string& path) {
  if (const FileError error = check_writable(path, OutputKind::png))
    throw Failure(output_kind(path) == OutputKind::png ? exit_failed : exit_wrong_input,
                  fmt::format("--output: {}", *error));
}

ExrPicture read(const std::string& path) {
  ExrPicture picture;
  if (const FileError error = read_exr_picture(path, picture)) throw Failure(exit_wrong_input, *error);
  return picture;
}

int compare_files(const CompareArguments& arguments) {
  if (!arguments.output.empty()) check_map(arguments.output);
  const ExrPicture a = read(arguments.inputs[0]), b = read(arguments.inputs[1]);
  if (a.picture.width != b.picture.width || a.picture.height != b.picture.height)
    throw Failure(exit_wrong_input, fmt::format("{} has {}x{} pixels, {} has {}x{}: pictures of one size were expected",
                                                arguments.inputs[0], a.picture.width, a.picture.height,
                                                arguments.inputs[1], b.picture.width, b.picture.height));
  const XyzPicture first = xyz_of(a.picture, a.chromaticities), second = xyz_of(b.picture, b.chromaticities);
  const float stops = chosen_exposure(arguments, a.exposure_stops, first);
  const PictureDifference difference = compare_pictures(first, second, {double{stops}, arguments.threads});
  print_numbers(difference, first.width, stops);
  if (arguments.output.empty()) return exit_done;
  write(arguments.output, difference_map(difference, first.width, first.height, double{arguments.map_scale}), 0,
        arguments.threads);
  print_map(arguments, arguments.output);
  return exit_done;
}

struct Rendered {
  Film film;
  float exposure_stops = 0;
  double seconds = 0;
};

Rendered render_as(const CompareArguments& arguments, ColorMode color) {
  SceneOverrides overrides;
  overrides.width = arguments.width;
  overrides.height = arguments.height;
  overrides.samples_per_pixel = arguments.samples_per_pixel;
  overrides.seed = arguments.seed;
  overrides.color = color;
  overrides.band_count = 0;  // only XYZ is compared
  const std::string& path = arguments.inputs[0];
  // What the reader remarks is the same both times.
  const bool quiet = arguments.quiet || color != ColorMode::spectral;
  LoadedScene loaded = load_scene(path, overrides, {quiet, arguments.strict});
  const RenderSettings& settings = loaded.scene.settings;
  const TileRect rendered_part = rendered_pixels(settings);
  if (const auto mistake = check_frame_size(rendered_part.width(), rendered_part.height()))
    throw Failure(exit_wrong_input, fmt::format("{}: {}", path, *mistake));
  const BuiltWorld built = build_world(std::move(loaded), path, {quiet, arguments.strict});
  Rendered rendered{Film(rendered_part.width(), rendered_part.height()), settings.exposure_stops, 0};
  RenderProgress progress;
  std::optional<ProgressReport> shown;
  if (!arguments.quiet) shown.emplace(progress, cancellation);
  rendered.seconds =
      render(*built.world, {arguments.threads, 32}, cancellation, progress, rendered.film).render_seconds;
  return rendered;
}

struct SceneOutputs {
  std::string spectral, other, map;
};

SceneOutputs scene_outputs(const CompareArguments& arguments) {
  const std::string stem = arguments.output.empty() ? scene_title(arguments.inputs[0])
                                                    : fs::path(arguments.output).replace_extension().string();
  SceneOutputs outputs = {stem + "-spectral.png", fmt::format("{}-{}.png", stem, color_mode_name(arguments.color)),
                          arguments.output.empty() ? stem + "-difference.png" : arguments.output};
  for (const std::string& path : {outputs.spectral, outputs.other, outputs.map}) check_map(path);
  return outputs;
}

int compare_scene(const CompareArguments& arguments) {
  const SceneOutputs outputs = scene_outputs(arguments);
  const Rendered spectral = render_as(arguments, ColorMode::spectral), other = render_as(arguments, arguments.color);
  const XyzPicture first = xyz_of(spectral.film), second = xyz_of(other.film);
  const float stops = chosen_exposure(arguments, spectral.exposure_stops, first);
  const CompareSettings settings{double{stops}, arguments.threads};
  const PictureDifference difference = compare_pictures(first, second, settings);
  print_numbers(difference, first.width, stops);
  if (sample_totals(spectral.film).fewest >= 4) {
    // Halves of n samples each differ by sqrt(2) times what two whole pictures of 2 n do.
    const double noise =
        compare_pictures(xyz_of(spectral.film, 0), xyz_of(spectral.film, 1), settings).median / std::sqrt(2.0);
    fmt::print("noise      median {:.3f} of two spectral pictures with as many samples\n", noise);
  }
  if (!arguments.quiet)
    fmt::print("time       spectral {}, {} {}\n", short_time(spectral.seconds), color_mode_name(arguments.color),
               short_time(other.seconds));
  write(outputs.spectral, linear_srgb(first), stops, arguments.threads);
  write(outputs.other, linear_srgb(second), stops, arguments.threads);
  write(outputs.map, difference_map(difference, first.width, first.height, double{arguments.map_scale}), 0,
        arguments.threads);
  if (!arguments.quiet) fmt::print("PNG        {}\nPNG        {}\n", outputs.spectral, outputs.other);
  print_map(arguments, outputs.map);
  return exit_done;
}

}  // namespace

int run_compare(const CompareArguments& arguments) {
  install_signal_handlers(cancellation);
  return arguments.is_scene() ? compare_scene(arguments) : compare_files(arguments);
}

}  // namespace metamer
