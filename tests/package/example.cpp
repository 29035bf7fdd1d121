// Uses metamer as a library, through find_package and the installed headers alone: builds a scene from code, renders
// it and writes the picture.
#include <cstdio>

#include "engine/film/film.h"
#include "systems/freeze.h"
#include "systems/render.h"
#include "systems/write_frame.h"

namespace {

using namespace metamer;

// A gold ball on a grey floor under a square lamp of daylight.
Scene make_scene() {
  Scene scene;
  Registry& registry = scene.registry;
  SpectrumSet& spectra = scene.spectra;

  const Entity floor = registry.create();
  registry.set(floor, Geometry{.kind = ShapeKind::rectangle, .width = 8, .depth = 8});
  registry.set(floor, Material{.kind = MaterialKind::diffuse, .reflectance = spectra.add_constant(0.5).id});

  const Entity ball = registry.create();
  registry.set(ball, Transform{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 1}});
  registry.set(ball, Geometry{.kind = ShapeKind::sphere, .radius = 1});
  registry.set(ball, Material{.kind = MaterialKind::conductor,
                              .eta = *spectra.add_named("Au.n"),
                              .kappa = *spectra.add_named("Au.k"),
                              .alpha_x = 0.1f,
                              .alpha_y = 0.1f});

  // Turned over, so that it shines down; its luminance is 10 cd/m^2.
  const Entity lamp = registry.create();
  const SpectrumId daylight = *spectra.add_named("D65");
  registry.set(lamp, Transform{{1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 5}});
  registry.set(lamp, Geometry{.kind = ShapeKind::rectangle, .width = 3, .depth = 3});
  registry.set(lamp, Light{.kind = LightKind::area,
                           .spectrum = daylight,
                           .scale = static_cast<float>(10 / spectra.luminance(daylight))});

  // Camera space is +z forward, +y up, +x right; here it stands at (0, -6, 1) and looks along +y of the world.
  const Entity camera = registry.create();
  registry.set(camera, Transform{{1, 0, 0, 0}, {0, 0, 1, -6}, {0, 1, 0, 1}});
  registry.set(camera, Camera{.fov_deg = 40});

  scene.settings.width = 96;
  scene.settings.height = 64;
  scene.settings.samples_per_pixel = 16;
  return scene;
}

}  // namespace

int main() {
  const Scene scene = make_scene();
  Diagnostics diagnostics;
  const auto world = freeze(scene, diagnostics);
  std::fputs(format_diagnostics(diagnostics).c_str(), stderr);
  if (world == nullptr) return 1;

  Film film(scene.settings.width, scene.settings.height);
  RenderProgress progress;
  const RenderStats stats = render(*world, RenderOptions{}, Cancellation(), progress, film);

  WriteSettings settings;
  settings.exr_path = "example.exr";
  settings.png_path = "example.png";
  if (const FileError error = write_frame(film, settings)) {
    std::fprintf(stderr, "%s\n", error->c_str());
    return 1;
  }
  const double centre = mean_xyz(film, size_t{film.width()} * (film.height() / 2) + film.width() / 2)[1];
  std::printf("%llu samples, %.2f cd/m^2 on the ball: example.exr, example.png\n",
              static_cast<unsigned long long>(stats.counters.samples), centre);
  return centre > 0 ? 0 : 1;
}
