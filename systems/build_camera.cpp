#include <algorithm>
#include <glm/geometric.hpp>

#include "engine/simd/portable_math.h"
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
  const glm::dmat4& matrix = to_world[table.owner(0).index];
  const Window window = screen_window(camera, world.settings);
  const bool perspective = camera.kind == CameraKind::perspective;
  const double half_degree = 3.14159265358979323846 / 360;
  const double half_side =
      perspective ? portable::tan(double{camera.fov_deg} * half_degree) : double{camera.screen_height} / 2;
  const double x_step = (window.x_max - window.x_min) * half_side / world.settings.width;
  const double y_step = (window.y_max - window.y_min) * half_side / world.settings.height;
  const glm::dvec3 x(matrix[0]), y(matrix[1]), z(matrix[2]), origin(matrix[3]);
  const glm::dvec3 corner = x * (window.x_min * half_side) + y * (window.y_max * half_side);
  CameraRow& row = world.camera;
  row.kind = camera.kind;
  store(row.origin, perspective ? origin : origin + corner);
  store(row.axis, perspective ? corner + z : glm::normalize(z));
  store(row.right, x * x_step);
  store(row.down, -y * y_step);
  store(row.lens_x, x * double{camera.lens_radius});
  store(row.lens_y, y * double{camera.lens_radius});
  row.lens_radius = camera.lens_radius;
  // The plane of focus is at camera depth focal_distance: z / |z|^2 measures depth in camera units.
  store(row.forward, z / glm::dot(z, z));
  row.focal_distance = camera.focal_distance;
}

}  // namespace metamer
