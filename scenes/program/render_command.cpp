#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <optional>

#include "engine/simd/instruction_set.h"
#include "scenes/library.h"
#include "scenes/program/commands.h"
#include "scenes/program/failure.h"
#include "scenes/program/load.h"
#include "scenes/program/look_report.h"
#include "scenes/program/outputs.h"
#include "scenes/program/progress.h"
#include "scenes/program/signals.h"
#include "scenes/program/stats.h"
#include "systems/display_colour.h"
#include "systems/systems.h"
#include "systems/write_frame.h"

namespace metamer {
namespace {

// Read by the signal handlers, so it lives as long as the program.
Cancellation cancellation;

// What the files say about the frame: nothing that depends on the machine, the threads or the time.
WriteSettings write_settings(const RenderArguments& arguments, const Outputs& outputs, const std::string& title,
                             const RenderSettings& settings) {
  WriteSettings write;
  write.exr_path = outputs.exr;
  write.png_path = outputs.png;
  write.header.software = "metamer " METAMER_VERSION;
  write.header.scene = title;
  write.header.seed = settings.seed;
  write.header.settings = {{"samples_per_pixel", std::to_string(settings.samples_per_pixel)},
                           {"max_depth", std::to_string(settings.max_depth)},
                           {"integrator", std::string(integrator_name(settings.integrator))},
                           {"shadows", settings.shadows ? "true" : "false"},
                           {"filter", std::string(filter_name(settings.filter.kind))},
                           {"color", std::string(color_mode_name(settings.color))},
                           {exposure_setting, fmt::format("{}", settings.exposure_stops)}};
  if (std::isfinite(settings.clamp_indirect))
    write.header.settings.emplace_back("clamp_indirect", fmt::format("{}", settings.clamp_indirect));
  const TileRect rendered = rendered_pixels(settings);
  if (rendered.width() < settings.width || rendered.height() < settings.height)
    write.header.window = {rendered.x0, rendered.y0, settings.width, settings.height};
  if (settings.largest_component < std::numeric_limits<float>::infinity())
    write.header.settings.emplace_back("largest_component", fmt::format("{}", settings.largest_component));
  if (settings.white_balance_kelvin > 0)
    write.header.settings.emplace_back("white_balance", fmt::format("{}", settings.white_balance_kelvin));
  if (settings.band_count > 0) write.header.settings.emplace_back("spectral", std::to_string(settings.band_count));
  write.primaries = settings.primaries;
  write.look = arguments.look;
  write.look.exposure_stops = settings.exposure_stops;
  write.look.threads = arguments.threads;
  write.checkpoint = !arguments.preview_only;
  return write;
}

std::string samples_text(const SampleTotals& samples) {
  return samples.fewest == samples.most ? fmt::format("{}", samples.most)
                                        : fmt::format("{} to {}", samples.fewest, samples.most);
}

void tell_result(const FrameReport& report, bool quiet) {
  const RenderSettings& settings = report.settings;
  if (report.is_interrupted)
    fmt::print(stderr, "metamer: interrupted with {} of {} samples per pixel{}\n", samples_text(report.samples),
               settings.samples_per_pixel, report.samples.fewest == 0 ? "; pixels without any are black" : "");
  if (quiet) return;
  if (report.invalid_samples > 0)
    fmt::print(stderr, "metamer: warning: {} samples were not finite and count as black\n", report.invalid_samples);
  if (report.render.counters.lost_media > 0)
    fmt::print(
        stderr,
        "metamer: warning: rays entered a fifth medium inside of four {} times; the lowest priority was forgotten\n",
        report.render.counters.lost_media);
  if (report.render.counters.lost_rays > 0)
    fmt::print(stderr, "metamer: warning: {} rays met more than {} interfaces between media and end there\n",
               report.render.counters.lost_rays, most_interfaces);
  if (report.render.counters.grids.unfinished > 0)
    fmt::print(stderr, "metamer: warning: {} rays collided more than {} times within one medium and end there\n",
               report.render.counters.grids.unfinished, most_collisions);
  if (report.texture_cache.failed_lookups > 0)
    fmt::print(stderr, "metamer: warning: {} texels could not be read from the files of textures and count as black\n",
               report.texture_cache.failed_lookups);
  fmt::print(stderr, "metamer: first ray after {} ({} to read, {} to build)\n", short_time(report.first_ray_seconds),
             short_time(report.load_seconds), short_time(report.build_seconds));
  const double seconds = report.render.render_seconds;
  const TileRect rendered = rendered_pixels(settings);
  fmt::print(stderr, "metamer: {}x{}, {} samples per pixel in {} on {} thread{} ({} samples/s)\n", rendered.width(),
             rendered.height(), samples_text(report.samples), short_time(seconds), report.render.threads,
             report.render.threads == 1 ? "" : "s",
             short_count(seconds > 0 ? static_cast<double>(report.samples.total) / seconds : 0));
}

void tell_files(const Outputs& outputs) {
  fmt::print("EXR   {}\nPNG   {}\n", outputs.exr, outputs.png);
  if (!outputs.stats.empty()) fmt::print("stats {}\n", outputs.stats);
}

void refuse_frame_without_memory(uint32_t width, uint32_t height, uint32_t band_count, const std::string& said_by) {
  if (const std::optional<std::string> mistake = check_frame_size(width, height, band_count))
    throw Failure(exit_wrong_input, fmt::format("{}: {}", said_by, *mistake));
}

void refuse_observer_without_bands(Observer observer, uint32_t band_count) {
  if (observer != Observer::cie1931 && band_count == 0)
    throw Failure(exit_wrong_input,
                  fmt::format("--observer {}: needs the bands of a spectral film, render with --spectral; without "
                              "it the film records what cie1931 sees",
                              observer_name(observer)));
}

// Reads and builds; what was read is given back before the first ray.
std::unique_ptr<World> make_world(const RenderArguments& arguments, const std::string& path, FrameReport& report) {
  LoadedScene loaded = load_scene(path, arguments.overrides, {arguments.quiet, arguments.strict});
  const RenderSettings& settings = loaded.scene.settings;
  const TileRect rendered = rendered_pixels(settings);
  refuse_frame_without_memory(rendered.width(), rendered.height(), settings.band_count, path);
  refuse_observer_without_bands(arguments.look.observer, settings.band_count);
  report.load_seconds = loaded.seconds;
  report.grids = report_grids(loaded.scene);
  BuiltWorld built = build_world(std::move(loaded), path, {arguments.quiet, arguments.strict});
  report.build_seconds = built.seconds;
  return std::move(built.world);
}

Developed seen(const Film& film, const RenderArguments& arguments) {
  return develop(film, develop(observe(film, Observer::cie1931, arguments.threads)), arguments.look);
}

float automatic_stops(const Film& film, const RenderArguments& arguments) {
  const float stops = automatic_exposure_stops(seen(film, arguments).picture, arguments.look.display);
  if (!arguments.quiet) fmt::print(stderr, "metamer: exposure {:+.2f} stops\n", stops);
  return stops;
}

void trace(const RenderArguments& arguments, const World& world, Film& film, FrameReport& report) {
  RenderProgress progress;
  std::optional<ProgressReport> shown;
  if (!arguments.quiet) shown.emplace(progress, cancellation);
  report.first_ray_seconds = process_age_seconds();
  report.render = render(world, {arguments.threads, arguments.tile_size}, cancellation, progress, film);
  shown.reset();
  report.first_pixel_seconds = report.first_ray_seconds + report.render.first_pixel_seconds;
  report.samples = sample_totals(film);
  report.invalid_samples = film.invalid_samples();
  report.is_interrupted = report.samples.fewest < world.settings.samples_per_pixel;
}

}  // namespace

int run_render(const RenderArguments& arguments) {
  const std::string path = arguments.scene.empty() ? default_scene() : arguments.scene;
  const Outputs outputs = choose_outputs(arguments, path);
  check_outputs(outputs, path);
  const SceneOverrides& overrides = arguments.overrides;
  if (overrides.width && overrides.height)
    refuse_frame_without_memory(*overrides.width, *overrides.height, overrides.band_count.value_or(0), "--size");
  install_signal_handlers(cancellation);

  FrameReport report;
  report.scene = path;
  report.tile_size = arguments.tile_size;
  const std::unique_ptr<World> world = make_world(arguments, path, report);
  report.settings = world->settings;
  report.world_bytes = world_bytes(*world);
  report.texture_bytes = world->textures.bytes();
  const TileRect rendered = rendered_pixels(world->settings);
  report.film_bytes = film_bytes(rendered.width(), rendered.height(), world->settings.band_count);
  Film film(rendered.width(), rendered.height(), world->settings.band_count);
  save_when_interrupted();
  trace(arguments, *world, film, report);
  report.texture_cache = image_cache_stats(world->textures);
  if (report.samples.total == 0) throw Failure(exit_failed, "interrupted before the first pixel; nothing was written");

  tell_result(report, arguments.quiet);
  if (arguments.automatic_exposure) report.settings.exposure_stops = automatic_stops(film, arguments);
  if (!arguments.quiet && arguments.look.display == ColorSpace::lamps) tell_negative_amounts(seen(film, arguments));
  FileError errors = write_frame(film, write_settings(arguments, outputs, scene_title(path), report.settings));
  if (!outputs.stats.empty())
    if (const FileError error = write_stats(outputs.stats, report)) errors = errors ? *errors + "\n" + *error : *error;
  if (errors) throw Failure(exit_failed, *errors);
  if (!arguments.quiet) tell_files(outputs);
  return report.is_interrupted ? exit_failed : exit_done;
}

}  // namespace metamer
