#include "systems/freeze.h"

#include <fmt/format.h>

#include "systems/display_colour.h"

namespace metamer {
namespace {

// What the light of that temperature looks like becomes the white of the picture's colour space, by Bradford's
// adaptation, as in pbrt-v4.
std::array<float, 9> white_balance(const RenderSettings& settings) {
  const Matrix3 matrix = adaptation_matrix(Adaptation::bradford, white_of_temperature(settings.white_balance_kelvin),
                                           white_xyz(settings.primaries));
  std::array<float, 9> rounded;
  for (size_t i = 0; i < 9; ++i) rounded[i] = static_cast<float>(matrix[i / 3][i % 3]);
  return rounded;
}

// All but what Embree makes of it. `disposable` is the scene if it is not needed any more, else null.
std::unique_ptr<World> lay_out(const Scene& scene, Scene* disposable, Diagnostics& diagnostics) {
  auto world = std::make_unique<World>();
  world->settings = scene.settings;
  world->spectra = scene.spectra;
  if (scene.settings.color != ColorMode::spectral && scene.settings.band_count > 0)
    diagnostics.error({},
                      fmt::format("there are no wavelengths in color mode '{}' for the {} bands of a spectral film: "
                                  "'spectral' goes with color 'spectral' only",
                                  color_mode_name(scene.settings.color), scene.settings.band_count));
  const Filter& filter = scene.settings.filter;
  world->filter =
      make_pixel_filter(filter.kind, filter.radius_x, filter.radius_y, {filter.sigma, filter.b, filter.c, filter.tau});
  if (scene.settings.white_balance_kelvin > 0) world->sensor_matrix = white_balance(scene.settings);
  const std::vector<glm::dmat4> to_world = build_transforms(scene, diagnostics);
  const size_t errors_before = diagnostics.error_count();
  build_textures(scene, disposable, *world, diagnostics);
  if (diagnostics.error_count() > errors_before) return nullptr;  // what follows needs them
  std::vector<MaterialRow> materials = build_materials(scene, *world, diagnostics);
  const std::vector<VolumeSides> volumes = build_volumes(scene, to_world, *world, diagnostics);
  if (disposable != nullptr) std::vector<Grid>().swap(disposable->grids);
  fill_solids(volumes, materials, *world, diagnostics);
  build_geometry(scene, to_world, materials, volumes, *world, diagnostics);
  if (disposable != nullptr) std::vector<Mesh>().swap(disposable->meshes);
  build_lights(scene, to_world, *world, diagnostics);
  if (disposable != nullptr) std::vector<Image>().swap(disposable->images);
  build_camera(scene, to_world, *world, diagnostics);
  if (scene.settings.integrator == Integrator::ambient_occlusion) {
    const SpectrumId white = world->spectra.add_white(ColorSpace::srgb);
    world->ambient_light = world->spectra.scaled(white, 1 / world->spectra.luminance(white)).id;
  }
  // Of the mean of four columns, of which so many carry light.
  world->indirect_limit = scene.settings.clamp_indirect * static_cast<float>(live_wavelengths(scene.settings)) / 4;
  if (scene.settings.color == ColorMode::spectral)  // there a radiance, that of equal energy of this luminance
    world->indirect_limit /= static_cast<float>(world->spectra.luminance(world->spectra.add_constant(1).id));
  build_coefficients(*world);
  if (world->zero_area_triangles > 0)
    diagnostics.warning(
        {},
        fmt::format("{} no area and cannot be hit", world->zero_area_triangles == 1
                                                        ? std::string("1 triangle has")
                                                        : fmt::format("{} triangles have", world->zero_area_triangles)),
        Strict::allows);
  return world;
}

std::unique_ptr<World> build(const Scene& scene, Scene* disposable, Diagnostics& diagnostics) {
  std::unique_ptr<World> world = lay_out(scene, disposable, diagnostics);
  if (diagnostics.has_errors()) return nullptr;
  build_accelerator(*world);
  build_camera_media(*world);
  return world;
}

}  // namespace

void reserve_triangles(const Scene& scene, World& world) {
  const Table<Geometry>& table = scene.registry.table<Geometry>();
  std::vector<uint32_t> users(scene.meshes.size());
  for (uint32_t row = 0; row < table.size(); ++row)
    if (const Geometry geometry = table.get(row); geometry.kind == ShapeKind::mesh) ++users[geometry.mesh];
  size_t vertices = 0, triangles = 0;
  std::vector<bool> counted(scene.meshes.size());
  for (uint32_t row = 0; row < table.size(); ++row) {
    const Geometry geometry = table.get(row);
    if (geometry.kind == ShapeKind::rectangle) vertices += 4, triangles += 2;
    if (geometry.kind != ShapeKind::mesh) continue;
    const bool is_shared =
        users[geometry.mesh] > 1 && geometry.flip_normal == 0 && !scene.registry.has<Light>(table.owner(row));
    if (is_shared && counted[geometry.mesh]) continue;
    if (is_shared) counted[geometry.mesh] = true;
    vertices += scene.meshes[geometry.mesh].positions.size();
    triangles += scene.meshes[geometry.mesh].indices.size() / 3;
  }
  constexpr size_t padding = 4;  // floats behind the last vertex, see build_geometry
  world.positions.reserve(3 * vertices + padding);
  world.normals.reserve(3 * vertices);
  world.uvs.reserve(2 * vertices);
  world.triangle_vertices.reserve(3 * triangles);
}

std::unique_ptr<World> freeze(const Scene& scene, Diagnostics& diagnostics) {
  return build(scene, nullptr, diagnostics);
}

void check(const Scene& scene, Diagnostics& diagnostics) { lay_out(scene, nullptr, diagnostics); }

std::unique_ptr<World> freeze(Scene&& scene, Diagnostics& diagnostics) { return build(scene, &scene, diagnostics); }

}  // namespace metamer
