#include "tests/reference_camera.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace metamer {
namespace {

// The pixel filter's shape by rejection.
double filter_offset(const PixelFilter& filter, double radius, ReferenceRandom& random) {
  for (;;) {
    const double x = radius * (2 * random() - 1);
    double height = 1;
    if (filter.kind == FilterKind::triangle) height = 1 - std::abs(x) / radius;
    if (filter.kind == FilterKind::gaussian) {
      const double sigma = filter.parameters.sigma, s = -0.5 / (sigma * sigma), edge = std::exp(s * radius * radius);
      height = (std::exp(s * x * x) - edge) / (1 - edge);
    }
    if (random() < height) return x;
  }
}

}  // namespace

ReferenceRay reference_camera_ray(const World& world, uint32_t x, uint32_t y, ReferenceRandom& random) {
  const CameraRow& camera = world.camera;
  const double film_x = x + 0.5 + filter_offset(world.filter, world.filter.radius_x, random);
  const double film_y = y + 0.5 + filter_offset(world.filter, world.filter.radius_y, random);
  const Vector across = read3(camera.right) * film_x + read3(camera.down) * film_y;
  Vector origin = read3(camera.origin), direction = read3(camera.axis);
  (camera.kind == CameraKind::perspective ? direction : origin) += across;
  direction = glm::normalize(direction);
  if (camera.lens_radius > 0) {
    const double depth = camera.focal_distance / glm::dot(direction, read3(camera.forward));
    const Vector focus = origin + depth * direction;
    double u = 1, v = 1;
    while (u * u + v * v > 1) u = 2 * random() - 1, v = 2 * random() - 1;
    origin += read3(camera.lens_x) * u + read3(camera.lens_y) * v;
    direction = glm::normalize(focus - origin);
  }
  return {origin, direction};
}

}  // namespace metamer
