#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numeric>
#include <optional>
#include <unordered_map>

#include "systems/build_light_images.h"
#include "systems/freeze.h"
#include "systems/light_rows.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;

struct Box {
  glm::dvec3 lower{1e300}, upper{-1e300};
  void include(const glm::dvec3& p) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
};

// In the object's own space.
Box object_box(const World& world, uint32_t object) {
  Box box;
  const auto kind = static_cast<ShapeKind>(world.objects.kind[object]);
  if (is_curves(kind)) {
    const uint32_t* segment = world.curve_segments.data() + world.objects.first_triangle[object];
    for (uint32_t i = 0; i < world.objects.triangle_count[object]; ++i) {
      for (size_t k = 0; k < 4; ++k) {
        const float* p = world.curve_points.data() + 4 * (segment[i] + k);
        box.include(glm::dvec3(p[0], p[1], p[2]) - double{p[3]});
        box.include(glm::dvec3(p[0], p[1], p[2]) + double{p[3]});
      }
    }
    return box;
  }
  if (kind != ShapeKind::mesh) {
    const Placement& shape = world.placements[world.objects.placement[object]];
    const double r = shape.radius;
    const bool is_sphere = kind == ShapeKind::sphere;
    box.include({-r, -r, is_sphere ? -r : double{shape.z_min}});
    box.include({r, r, is_sphere ? r : double{shape.z_max}});
    return box;
  }
  const size_t first = size_t{3} * world.objects.first_triangle[object];
  for (size_t corner = first; corner < first + size_t{3} * world.objects.triangle_count[object]; ++corner) {
    const float* p = world.positions.data() + size_t{3} * world.triangle_vertices[corner];
    box.include({p[0], p[1], p[2]});
  }
  return box;
}

// Radius of a sphere around everything, for the power of light from infinity.
double scene_radius(const World& world) {
  Box scene;
  std::unordered_map<uint32_t, Box> shared;  // by first triangle: instances share their mesh's
  for (uint32_t object = 0; object < world.objects.size(); ++object) {
    const auto kind = static_cast<ShapeKind>(world.objects.kind[object]);
    const bool is_mesh = kind == ShapeKind::mesh;
    if ((is_mesh || is_curves(kind)) && world.objects.triangle_count[object] == 0) continue;
    const uint32_t mesh = world.objects.first_triangle[object];
    const auto known = is_mesh ? shared.find(mesh) : shared.end();
    const Box box = known != shared.end() ? known->second : object_box(world, object);
    if (is_mesh) shared[mesh] = box;
    const float* m = world.placements[world.objects.placement[object]].to_world;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 p((corner & 1 ? box.upper : box.lower).x, (corner & 2 ? box.upper : box.lower).y,
                         (corner & 4 ? box.upper : box.lower).z);
      glm::dvec3 placed;
      for (int row = 0; row < 3; ++row)
        placed[row] = m[4 * row] * p.x + m[4 * row + 1] * p.y + m[4 * row + 2] * p.z + m[4 * row + 3];
      scene.include(placed);
    }
  }
  if (world.objects.size() == 0) return 1e-6;
  return std::max(glm::length(scene.upper - scene.lower) / 2, 1e-6);
}

// Proportional to the light's power, as luminous flux; what chooses among lights.
double power_of(const World& world, uint32_t index, double radius) {
  const LightRow& row = world.lights[index];
  const uint32_t image = world.image_of_light[index];
  const double weight = image == no_index ? 1 : double{world.light_images.rows[image].weight};
  const double level = world.spectra.luminance(row.spectrum) * row.scale;
  switch (static_cast<LightShape>(row.shape)) {
    case LightShape::directional: return pi * radius * radius * level;
    case LightShape::distant_disk: {
      const double half = row.axes[0];
      return pi * half * (2 - half) * pi * radius * radius * level;
    }
    case LightShape::environment: {
      const double solid_angle = image == no_index ? 4 * pi : weight;
      for (const Environment& environment : world.environments) {
        if (environment.light != index || !environment.has_portal()) continue;
        return solid_angle / 4 * level * double{environment.portal.width} * double{environment.portal.height};
      }
      return solid_angle * pi * radius * radius * level;
    }
    default: return flux_per_unit(row) * level * weight;
  }
}

// Which rows belong together: those of one shape, else each for itself.
std::vector<uint32_t> owners_of_rows(const World& world) {
  std::vector<uint32_t> owners(world.lights.size());
  for (uint32_t row = 0; row < owners.size(); ++row) owners[row] = row;
  for (uint32_t object = 0; object < world.objects.size(); ++object) {
    const uint32_t first = world.objects.first_light[object];
    if (first == no_index) continue;
    for (uint32_t i = 0; i < world.objects.triangle_count[object]; ++i) owners[first + i] = first;
  }
  return owners;
}

// Half of the choice is by power; half gives every light that shines the same share, divided by power among its
// triangles. By power alone a lamp beside a sun over wide ground would be found once in a billion samples, and then be
// a firefly; this way the price is at most twice the variance of choosing by power.
std::vector<double> choice_weights(const World& world, std::span<const double> power, double total) {
  const std::vector<uint32_t> owners = owners_of_rows(world);
  std::vector<double> of_owner(power.size());
  for (size_t row = 0; row < power.size(); ++row) of_owner[owners[row]] += power[row];
  const auto shining = std::count_if(of_owner.begin(), of_owner.end(), [](double p) { return p > 0; });
  std::vector<double> weights(power.size());
  for (size_t row = 0; row < power.size(); ++row) {
    if (!(power[row] > 0)) continue;
    weights[row] = power[row] / total + power[row] / of_owner[owners[row]] / double(shining);
  }
  return weights;
}

// See World::positional_choice.
void choose_positional(World& world) {
  if (world.settings.integrator != Integrator::path || !world.settings.shadows) return;
  const VolumeColumns& volumes = world.volumes;
  bool is_even = false;
  for (size_t row = 0; row < volumes.scatters.size(); ++row)
    is_even = is_even || (volumes.scatters[row] != 0 && volumes.grid[row] == no_index);
  if (!is_even) return;
  std::vector<double> weights(world.lights.size());
  double total = 0;
  for (size_t row = 0; row < weights.size(); ++row) {
    const auto shape = static_cast<LightShape>(world.lights[row].shape);
    if (shape < LightShape::point || shape > LightShape::projection) continue;
    total += weights[row] = double{world.lights[row].choice_probability};
  }
  if (total > 0) world.positional_choice = make_distribution_1d(weights);
}

// Path tracing draws one light of all. The other integrators sum the abstract ones and draw one of the rest.
void choose_lights(std::vector<double>& power, World& world) {
  if (world.settings.integrator != Integrator::path)
    for (uint32_t row = 0; row < power.size(); ++row) {
      if (!is_abstract(static_cast<LightShape>(world.lights[row].shape))) continue;
      if (power[row] > 0) world.summed_lights.push_back(row);
      power[row] = 0;
    }
  for (uint32_t row = 0; row < power.size(); ++row)
    if (world.light_finding[row] == static_cast<uint32_t>(LightFinding::rays)) power[row] = 0;
  const double total = std::accumulate(power.begin(), power.end(), 0.0);
  if (!(total > 0)) return;
  world.light_choice = make_distribution_1d(choice_weights(world, power, total));
  for (uint32_t row = 0; row < power.size(); ++row)
    world.lights[row].choice_probability = discrete_probability(world.light_choice, row);
  choose_positional(world);
}

}  // namespace

void build_lights(const Scene& scene, std::span<const glm::dmat4> to_world, World& world, Diagnostics& diagnostics) {
  const Table<Light>& table = scene.registry.table<Light>();
  while (world.image_of_light.size() < world.lights.size()) world.image_of_light.push_back(no_index);
  scene.registry.each<Light>([&](Entity entity, uint32_t table_row) {
    const Light light = table.get(table_row);
    if (light.kind == LightKind::area) {
      if (!scene.registry.has<Geometry>(entity))
        diagnostics.error(scene.location(entity),
                          fmt::format("the area light {} has no geometry", scene.describe(entity)));
      return;
    }
    const auto row = static_cast<uint32_t>(world.lights.size());
    const Image* image = light.image == no_index ? nullptr : &scene.images[light.image];
    uint32_t image_row = no_index;
    if (image != nullptr) {
      const std::optional<uint32_t> added = add_light_image(scene, light, world);
      if (!added) diagnostics.error(scene.location(entity), too_many_light_texels);
      image_row = added.value_or(no_index);
    }
    const glm::dmat4& matrix = to_world[entity.index];
    world.lights.push_back(abstract_light(matrix, light, image));
    world.image_of_light.push_back(image_row);
    world.light_finding.push_back(static_cast<uint32_t>(LightFinding::both));
    if (light.kind == LightKind::environment) {
      Environment environment;
      environment.light = row;
      environment.image = image_row;
      build_environment(image, matrix, environment);
      if (light.has_portal != 0) build_portal(light, image, environment);
      world.has_portals = world.has_portals || environment.has_portal();
      world.environments.push_back(std::move(environment));
    }
    if (world.lights[row].shape == static_cast<uint32_t>(LightShape::distant_disk)) world.distant_disks.push_back(row);
  });
  if (world.lights.empty()) return;
  const double radius = scene_radius(world);
  std::vector<double> power(world.lights.size());
  double total = 0;
  for (size_t i = 0; i < power.size(); ++i) total += power[i] = power_of(world, static_cast<uint32_t>(i), radius);
  if (!(total > 0)) {
    // Nothing shines: without lights there is nothing to sample.
    world.lights.clear();
    world.image_of_light.clear();
    world.light_images = LightImages{};
    world.light_finding.clear();
    world.distant_disks.clear();
    world.environments.clear();
    world.has_portals = world.has_shape_images = false;
    for (uint32_t& light : world.objects.first_light) light = no_index;
    return;
  }
  choose_lights(power, world);
}

}  // namespace metamer
