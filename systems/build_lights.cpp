#include <fmt/format.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <unordered_map>

#include "engine/simd/portable_math.h"
#include "engine/spectrum/rgb_fit.h"
#include "systems/freeze.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;

void store_rotation(float (&to_world)[9], float (&to_local)[9], const glm::dmat3& rotation) {
  const glm::dmat3 inverse = glm::inverse(rotation);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      to_world[3 * row + column] = static_cast<float>(rotation[column][row]);
      to_local[3 * row + column] = static_cast<float>(inverse[column][row]);
    }
}

// Texels as sigmoid coefficients, and their luminance times the solid angle of a texel as the density.
void build_image(const Image& image, Environment& environment) {
  environment.width = image.width;
  environment.height = image.height;
  environment.mapping = image.mapping;
  const size_t count = size_t{image.width} * image.height;
  environment.texels.resize(4 * count);
  std::vector<double> weights(count);
  const Matrix3 to_xyz = rgb_to_xyz(image.color_space);
  for (uint32_t y = 0; y < image.height; ++y) {
    double ring = 1;
    if (image.mapping == ImageMapping::latitude_longitude) {
      const double top = portable::cos(pi * y / image.height), bottom = portable::cos(pi * (y + 1) / image.height);
      ring = (top - bottom) * image.height / pi;
    }
    for (uint32_t x = 0; x < image.width; ++x) {
      const size_t texel = size_t{y} * image.width + x;
      const float* rgb = image.rgb.data() + 3 * texel;
      const double scale = 2 * double{std::max({rgb[0], rgb[1], rgb[2]})};
      if (scale > 0) {
        const SigmoidFit fit = fit_sigmoid(image.color_space, {rgb[0] / scale, rgb[1] / scale, rgb[2] / scale});
        for (int i = 0; i < 3; ++i) environment.texels[4 * texel + i] = static_cast<float>(fit.c[i]);
      }
      environment.texels[4 * texel + 3] = static_cast<float>(scale);
      const double luminance = to_xyz[1][0] * rgb[0] + to_xyz[1][1] * rgb[1] + to_xyz[1][2] * rgb[2];
      weights[texel] = std::max(luminance, 0.0) * ring;
    }
  }
  environment.density = make_distribution_2d(weights, image.width, image.height);
}

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
  if (world.objects.kind[object] != static_cast<uint32_t>(ShapeKind::mesh)) {
    const Placement& shape = world.placements[world.objects.placement[object]];
    const bool is_sphere = world.objects.kind[object] == static_cast<uint32_t>(ShapeKind::sphere);
    const double r = shape.radius, z = is_sphere ? r : 0, height = is_sphere ? 0 : double{shape.height};
    box.include({-r, -r, height - z});
    box.include({r, r, height + z});
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
    const bool is_mesh = world.objects.kind[object] == static_cast<uint32_t>(ShapeKind::mesh);
    if (is_mesh && world.objects.triangle_count[object] == 0) continue;
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
double power_of(const World& world, const LightRow& row, double radius, double image_mean) {
  const double level = world.spectra.luminance(row.spectrum) * row.scale;
  switch (static_cast<LightShape>(row.shape)) {
    case LightShape::point: return 4 * pi * level;
    case LightShape::directional: return pi * radius * radius * level;
    case LightShape::environment: return 4 * pi * pi * radius * radius * level * image_mean;
    default: return pi * row.area * level * (row.two_sided != 0 ? 2 : 1);
  }
}

double mean_luminance(const Image& image) {
  double sum = 0;
  for (const float value : image.rgb) sum += value;
  return sum / static_cast<double>(image.rgb.size());
}

}  // namespace

void build_lights(const Scene& scene, std::span<const glm::dmat4> to_world, World& world, Diagnostics& diagnostics) {
  const Table<Light>& table = scene.registry.table<Light>();
  double image_mean = 1;
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
      store_rotation(world.environment.to_world, world.environment.to_local, glm::dmat3(matrix));
      if (light.image != no_index) {
        build_image(scene.images[light.image], world.environment);
        image_mean = mean_luminance(scene.images[light.image]);
      }
    }
    world.lights.push_back(light_at_infinity_or_point(light, matrix));
  });
  if (world.lights.empty()) return;
  const double radius = scene_radius(world);
  std::vector<double> power(world.lights.size());
  double total = 0;
  for (size_t i = 0; i < power.size(); ++i) total += power[i] = power_of(world, world.lights[i], radius, image_mean);
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
