#include "systems/freeze.h"

#include <fmt/format.h>

namespace metamer {

std::unique_ptr<World> freeze(const Scene& scene, Diagnostics& diagnostics) {
  auto world = std::make_unique<World>();
  world->settings = scene.settings;
  world->spectra = scene.spectra;
  if (scene.settings.color != ColorMode::spectral && scene.settings.band_count > 0)
    diagnostics.error({},
                      fmt::format("there are no wavelengths in color mode '{}' for the {} bands of a spectral film: "
                                  "'spectral' goes with color 'spectral' only",
                                  color_mode_name(scene.settings.color), scene.settings.band_count));
  const Filter& filter = scene.settings.filter;
  world->filter = make_pixel_filter(filter.kind, filter.radius_x, filter.radius_y, filter.sigma);
  const std::vector<glm::dmat4> to_world = build_transforms(scene, diagnostics);
  build_textures(scene, *world, diagnostics);
  const std::vector<MaterialRow> materials = build_materials(scene, *world, diagnostics);
  const std::vector<VolumeSides> volumes = build_volumes(scene, *world, diagnostics);
  build_geometry(scene, to_world, materials, volumes, *world, diagnostics);
  build_lights(scene, to_world, *world, diagnostics);
  build_camera(scene, to_world, *world, diagnostics);
  if (scene.settings.integrator == Integrator::ambient_occlusion) {
    const SpectrumId white = world->spectra.add_white(ColorSpace::srgb);
    world->ambient_light = world->spectra.scaled(white, 1 / world->spectra.luminance(white)).id;
  }
  build_coefficients(*world);
  if (world->zero_area_triangles > 0)
    diagnostics.warning(
        {},
        fmt::format("{} no area and cannot be hit", world->zero_area_triangles == 1
                                                        ? std::string("1 triangle has")
                                                        : fmt::format("{} triangles have", world->zero_area_triangles)),
        Strict::allows);
  if (diagnostics.has_errors()) return nullptr;
  build_accelerator(*world);
  build_camera_media(*world);
  return world;
}

}  // namespace metamer
