#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/simd/portable_math.h"
#include "systems/build_motion.h"
#include "systems/freeze.h"

namespace metamer {
namespace {

struct Window {
  double x_min, x_max, y_min, y_max;
};

// The rectangle that the picture shows, in units of half its shorter side.
Window screen_window(const Camera& camera, const RenderSettings& settings) {
  const glm::vec4& w = camera.screen_window;
  if (w.x < w.y && w.z < w.w) return {w.x, w.y, w.z, w.w};
  const double aspect = double(settings.width) / settings.height;
  const double x = std::max(aspect, 1.0), y = std::max(1 / aspect, 1.0);
  return {-x, x, -y, y};
}

void store(float (&target)[3], const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) target[i] = static_cast<float>(v[i]);
}

// Lookups of textures stand for a quarter of a pixel, as in pbrt-v4 from 64 samples per pixel on: the samples do the
// rest, and what a lens or a curved mirror magnifies up to fourfold stays sharp.
constexpr double footprint_pixels = 0.25;

// A pixel at the centre of the picture.
void set_footprint(const Camera& camera, const RenderSettings& settings, const glm::dmat4& matrix, CameraRow& row) {
  const auto length = [](const float(&v)[3]) { return std::hypot(double{v[0]}, double{v[1]}, double{v[2]}); };
  if (camera.kind == CameraKind::spherical) {
    const double pi = 3.14159265358979323846, pixels = double(settings.width) * settings.height;
    const bool is_map = camera.mapping == ImageMapping::latitude_longitude;
    row.footprint_angle =
        static_cast<float>(footprint_pixels * (is_map ? pi / settings.height : std::sqrt(4 * pi / pixels)));
    return;
  }
  const double pixel = footprint_pixels * std::min(length(row.right), length(row.down));
  if (camera.kind == CameraKind::perspective)
    row.footprint_angle = static_cast<float>(pixel / glm::length(glm::dvec3(matrix[2])));
  else
    row.footprint_width = static_cast<float>(pixel);
}

// All that depends on where the camera is; the matrix takes it to the world.
void place_camera(const Camera& camera, const RenderSettings& settings, const glm::dmat4& matrix, CameraRow& row) {
  const Window window = screen_window(camera, settings);
  const glm::dvec3 x(matrix[0]), y(matrix[1]), z(matrix[2]), origin(matrix[3]);
  if (camera.kind == CameraKind::spherical) {
    store(row.origin, origin);
    store(row.right, x);
    store(row.down, z);
    store(row.axis, y);
    return;
  }
  const bool perspective = camera.kind == CameraKind::perspective;
  const double half_degree = 3.14159265358979323846 / 360;
  const double half_side =
      perspective ? portable::tan(double{camera.fov_deg} * half_degree) : double{camera.screen_height} / 2;
  const double x_step = (window.x_max - window.x_min) * half_side / settings.width;
  const double y_step = (window.y_max - window.y_min) * half_side / settings.height;
  const glm::dvec3 corner = x * (window.x_min * half_side) + y * (window.y_max * half_side);
  store(row.origin, perspective ? origin : origin + corner);
  store(row.axis, perspective ? corner + z : glm::normalize(z));
  store(row.right, x * x_step);
  store(row.down, -y * y_step);
  store(row.lens_x, x * double{camera.lens_radius});
  store(row.lens_y, y * double{camera.lens_radius});
  // The plane of focus is at camera depth focal_distance: z / |z|^2 measures depth in camera units.
  store(row.forward, z / glm::dot(z, z));
}

CameraKey key_of(const CameraRow& row) {
  CameraKey key;
  const auto copy = [](const float(&from)[3], float(&to)[3]) { std::copy(from, from + 3, to); };
  copy(row.origin, key.origin);
  copy(row.axis, key.axis);
  copy(row.right, key.right);
  copy(row.down, key.down);
  copy(row.lens_x, key.lens_x);
  copy(row.lens_y, key.lens_y);
  copy(row.forward, key.forward);
  return key;
}

}  // namespace

void build_camera(const Scene& scene, std::span<const glm::dmat4> to_world, World& world, Diagnostics& diagnostics) {
  const Table<Camera>& table = scene.registry.table<Camera>();
  if (table.size() == 0) {
    diagnostics.error({}, "the scene has no camera");
    return;
  }
  if (table.size() > 1)
    diagnostics.warning(scene.location(table.owner(1)), "more than one camera: the first one is used");
  const Camera camera = table.get(0);
  CameraRow& row = world.camera;
  row.kind = camera.kind;
  row.lens_radius = camera.kind == CameraKind::spherical ? 0 : camera.lens_radius;
  row.focal_distance = camera.focal_distance;
  row.mapping = camera.mapping;
  row.x_step = 1.0f / static_cast<float>(world.settings.width);
  row.y_step = 1.0f / static_cast<float>(world.settings.height);
  const std::vector<glm::dmat4> keys = motion_keys(scene, table.owner(0), diagnostics);
  for (const glm::dmat4& key : keys) {
    place_camera(camera, world.settings, key, row);
    world.camera_keys.push_back(key_of(row));
  }
  const glm::dmat4& start = keys.empty() ? to_world[table.owner(0).index] : keys.front();
  place_camera(camera, world.settings, start, row);
  set_footprint(camera, world.settings, start, row);
}

}  // namespace metamer
