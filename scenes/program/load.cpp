#include "scenes/program/load.h"

#include <chrono>
#include <cstdio>

#include "scenes/late_mistakes.h"
#include "scenes/program/failure.h"
#include "scenes/read_scene.h"
#include "systems/freeze.h"

namespace metamer {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Remarks that belong to no file are about the scene as a whole.
void print_diagnostics(const Diagnostics& diagnostics, const std::string& path) {
  Diagnostics placed;
  for (const Diagnostic& d : diagnostics.all()) {
    const SourceLocation at{d.file.empty() ? path : d.file, d.line};
    switch (d.severity) {
      case Severity::note: placed.note(at, d.message); break;
      case Severity::warning: placed.warning(at, d.message); break;
      case Severity::error: placed.error(at, d.message); break;
    }
  }
  std::fputs(format_diagnostics(placed).c_str(), stderr);
}

void apply(const SceneOverrides& overrides, RenderSettings& settings) {
  settings.width = overrides.width.value_or(settings.width);
  settings.height = overrides.height.value_or(settings.height);
  settings.samples_per_pixel = overrides.samples_per_pixel.value_or(settings.samples_per_pixel);
  settings.max_depth = overrides.max_depth.value_or(settings.max_depth);
  settings.integrator = overrides.integrator.value_or(settings.integrator);
  settings.clamp_indirect = overrides.clamp_indirect.value_or(settings.clamp_indirect);
  settings.shadows = settings.shadows && !overrides.no_shadows;
  settings.seed = overrides.seed.value_or(settings.seed);
  settings.band_count = overrides.band_count.value_or(settings.band_count);
  settings.exposure_stops = overrides.exposure_stops.value_or(settings.exposure_stops);
  settings.color = overrides.color.value_or(settings.color);
}

template <class... Columns>
size_t bytes_of(const Columns&... columns) {
  return (size_t{0} + ... + columns.bytes());
}

size_t coated_bytes(const CoatedColumns& c) {
  return bytes_of(c.reflectance, c.texture, c.eta, c.alpha_x, c.alpha_y, c.thickness, c.hits, c.schlick, c.first_row,
                  c.row_stride, c.last_pair, c.eta_least, c.rows_per_eta, c.albedos);
}

template <class S>
BuiltWorld freeze_and_print(S&& scene, const std::string& path, Remarks remarks) {
  const Clock::time_point start = Clock::now();
  BuiltWorld built;
  built.world = freeze(std::forward<S>(scene), built.diagnostics);
  if (remarks.strict) built.diagnostics.apply_strict();
  if (built.world == nullptr || built.diagnostics.has_errors()) {
    print_diagnostics(built.diagnostics, path);
    throw Failure(exit_wrong_input, "");
  }
  if (!remarks.quiet) print_diagnostics(built.diagnostics, path);
  built.seconds = seconds_since(start);
  return built;
}

}  // namespace

LoadedScene load_scene(const std::string& path, const SceneOverrides& overrides, Remarks remarks) {
  const Clock::time_point start = Clock::now();
  LoadedScene loaded;
  loaded.scene.texture_memory = overrides.texture_memory.value_or(loaded.scene.texture_memory);
  const bool is_good = read_scene(path, loaded.scene, loaded.diagnostics);
  if (!is_good) add_late_mistakes(loaded.scene, loaded.diagnostics);
  if (remarks.strict) loaded.diagnostics.apply_strict();
  if (!is_good || loaded.diagnostics.has_errors()) {
    print_diagnostics(loaded.diagnostics, path);
    throw Failure(exit_wrong_input, "");
  }
  if (!remarks.quiet) print_diagnostics(loaded.diagnostics, path);
  apply(overrides, loaded.scene.settings);
  loaded.seconds = seconds_since(start);
  return loaded;
}

BuiltWorld build_world(const LoadedScene& loaded, const std::string& path, Remarks remarks) {
  return freeze_and_print(loaded.scene, path, remarks);
}
BuiltWorld build_world(LoadedScene&& loaded, const std::string& path, Remarks remarks) {
  return freeze_and_print(std::move(loaded.scene), path, remarks);
}

size_t world_bytes(const World& world) {
  const ObjectColumns& o = world.objects;
  size_t environments = 0;
  for (const Environment& e : world.environments)
    environments += bytes_of(e.density.marginal, e.density.conditional, e.density.marginal_guide,
                             e.density.conditional_guide, e.portal.density.sums);
  return bytes_of(o.kind, o.first_triangle, o.triangle_count, o.shade_kind, o.material, o.first_light, o.placement,
                  o.visibility, o.first_key, o.key_count) +
         bytes_of(world.positions, world.normals, world.uvs, world.triangle_vertices, world.placements,
                  world.motion_keys, world.camera_keys, world.curve_points, world.curve_normals, world.curve_segments,
                  world.curve_u) +
         coated_bytes(world.smooth_coated) + coated_bytes(world.rough_coated) +
         bytes_of(world.rough.kd, world.rough.ks, world.rough.shininess, world.rough.normalized) +
         bytes_of(world.diffuse.reflectance, world.conductor.eta, world.conductor.kappa, world.conductor.alpha_x,
                  world.conductor.alpha_y, world.conductor.schlick, world.dielectric.eta, world.dielectric.schlick,
                  world.dielectric.dispersive) +
         environments + world.grids.bytes() + bytes_of(world.majorants) +
         bytes_of(world.lights, world.image_of_light, world.light_images.rows, world.light_images.texels,
                  world.light_choice.cdf, world.spectra);
}

}  // namespace metamer
