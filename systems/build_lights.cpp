#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "systems/freeze.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;

LightRow light_at_infinity_or_point(const Light& light, const glm::dmat4& matrix) {
  LightRow row;
  row.spectrum = light.spectrum;
  row.scale = light.scale;
  glm::dvec3 p(matrix[3]);
  row.shape = static_cast<uint32_t>(LightShape::point);
  if (light.kind == LightKind::directional) {
    row.shape = static_cast<uint32_t>(LightShape::directional);
    p = glm::normalize(glm::dvec3(matrix[2]));  // light travels along -z: +z is towards it
  }
  if (light.kind == LightKind::environment) row.shape = static_cast<uint32_t>(LightShape::environment);
  for (int i = 0; i < 3; ++i) row.p[i] = static_cast<float>(p[i]);
  return row;
}

// Radius of a sphere around everything, for the power of light from infinity.
double scene_radius(const World& world) {
  double lower[3] = {1e30, 1e30, 1e30}, upper[3] = {-1e30, -1e30, -1e30};
  const auto include = [&](int axis, double value) {
    lower[axis] = std::min(lower[axis], value);
    upper[axis] = std::max(upper[axis], value);
  };
  for (size_t i = 0; i < world.normals.size(); ++i) include(static_cast<int>(i % 3), world.positions[i]);
  for (const Placement& placement : world.placements)
    for (int axis = 0; axis < 3; ++axis) include(axis, placement.to_world[4 * axis + 3]);
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) squared += (upper[axis] - lower[axis]) * (upper[axis] - lower[axis]);
  return std::max(std::sqrt(squared) / 2, 1e-6);
}

// Proportional to the light's power, as luminous flux; what chooses among lights.
double power_of(const World& world, const LightRow& row, double radius) {
  const double level = world.spectra.luminance(row.spectrum) * row.scale;
  switch (static_cast<LightShape>(row.shape)) {
    case LightShape::point: return 4 * pi * level;
    case LightShape::directional: return pi * radius * radius * level;
    case LightShape::environment: return 4 * pi * pi * radius * radius * level * world.environment.mean_luminance;
    default: return pi * row.area * level * (row.two_sided != 0 ? 2 : 1);
  }
}

}  // namespace

void build_lights(const Scene& scene, std::span<const glm::dmat4> to_world, World& world, Diagnostics& diagnostics) {
  const Table<Light>& table = scene.registry.table<Light>();
  scene.registry.each<Light>([&](Entity entity, uint32_t table_row) {
    const Light light = table.get(table_row);
    if (light.kind == LightKind::area) {
      if (!scene.registry.has<Geometry>(entity))
        diagnostics.error(scene.location(entity),
                          fmt::format("the area light {} has no geometry", scene.describe(entity)));
      return;
    }
    const glm::dmat4& matrix = to_world[entity.index];
    if (light.kind == LightKind::environment) {
      if (world.environment.light != no_index) {
        diagnostics.error(scene.location(entity), "a second environment light: only one is possible");
        return;
      }
      world.environment.light = static_cast<uint32_t>(world.lights.size());
      build_environment(light.image == no_index ? nullptr : &scene.images[light.image], matrix, world.environment);
    }
    world.lights.push_back(light_at_infinity_or_point(light, matrix));
  });
  if (world.lights.empty()) return;
  const double radius = scene_radius(world);
  std::vector<double> power(world.lights.size());
  double total = 0;
  for (size_t i = 0; i < power.size(); ++i) total += power[i] = power_of(world, world.lights[i], radius);
  if (!(total > 0)) {
    // Nothing shines: without lights there is nothing to sample.
    world.lights.clear();
    world.environment = Environment{};
    for (uint32_t& light : world.objects.first_light) light = no_index;
    return;
  }
  world.light_choice = make_distribution_1d(power);
  for (size_t i = 0; i < power.size(); ++i)
    world.lights[i].choice_probability = discrete_probability(world.light_choice, static_cast<uint32_t>(i));
}

}  // namespace metamer
