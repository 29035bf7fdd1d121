// Shapes: what they are locally, and the entities they become.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "scenes/pbrt/curve_shapes.h"
#include "scenes/pbrt/matrix.h"
#include "scenes/pbrt/mesh_shapes.h"
#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {
namespace {

constexpr std::string_view shape_kinds[] = {"trianglemesh", "plymesh", "bilinearmesh", "loopsubdiv",
                                            "sphere",       "disk",    "cylinder",     "curve"};

// The areas that pbrt divides a light's power by. Quadrics: as they are before the transformation. Meshes: of a
// triangle (or patch), each of which emits the whole power: here the mean over the mesh.
struct Shape {
  Geometry geometry;
  double area = 0;
};

// Degrees, at most 360; what is beyond counts as that, as in pbrt.
double read_phi_max(Parameters& parameters) { return std::min(parameters.positive("phimax", 360), 360.0); }
double radians(double degrees) { return degrees / 180 * std::numbers::pi; }

// 'zmin' and 'zmax' in their order; an error if there is nothing between them.
struct Heights {
  double z_min, z_max;
};
Heights read_heights(Parameters& parameters, double z_min, double z_max, double limit) {
  const double a = parameters.number("zmin", z_min), b = parameters.number("zmax", z_max);
  const Heights heights{std::clamp(std::min(a, b), -limit, limit), std::clamp(std::max(a, b), -limit, limit)};
  if (!(static_cast<float>(heights.z_min) < static_cast<float>(heights.z_max)))
    parameters.error("zmin", fmt::format("'zmin' {:g} and 'zmax' {:g} leave nothing of the shape", a, b));
  return heights;
}

Shape read_sphere(Parameters& parameters) {
  const double radius = parameters.positive("radius", 1), phi_max = read_phi_max(parameters);
  const auto [z_min, z_max] = read_heights(parameters, -radius, radius, radius);
  Geometry geometry{
      .kind = ShapeKind::sphere, .radius = static_cast<float>(radius), .phi_max_deg = static_cast<float>(phi_max)};
  if (z_min > -radius) geometry.z_min = static_cast<float>(z_min);
  if (z_max < radius) geometry.z_max = static_cast<float>(z_max);
  return {geometry, radians(phi_max) * radius * (z_max - z_min)};
}

Shape read_cylinder(Parameters& parameters) {
  const double radius = parameters.positive("radius", 1), phi_max = read_phi_max(parameters);
  const auto [z_min, z_max] = read_heights(parameters, -1, 1, std::numeric_limits<double>::infinity());
  const Geometry geometry{.kind = ShapeKind::cylinder,
                          .radius = static_cast<float>(radius),
                          .z_min = static_cast<float>(z_min),
                          .z_max = static_cast<float>(z_max),
                          .phi_max_deg = static_cast<float>(phi_max)};
  return {geometry, radians(phi_max) * radius * (z_max - z_min)};
}

Shape read_disk(Parameters& parameters) {
  const double radius = parameters.positive("radius", 1);
  const double inner = parameters.number_from("innerradius", 0, 0);
  const double height = parameters.number("height", 0);
  const double phi_max = read_phi_max(parameters);
  if (inner >= radius)
    parameters.error("innerradius", fmt::format("'innerradius' {} is not below 'radius' {}", inner, radius));
  Geometry geometry{.kind = ShapeKind::disk,
                    .radius = static_cast<float>(radius),
                    .inner_radius = static_cast<float>(inner),
                    .height = static_cast<float>(height),
                    .phi_max_deg = static_cast<float>(phi_max)};
  return {geometry, radians(phi_max) / 2 * (radius * radius - inner * inner)};
}

// In world space, as pbrt keeps its triangles.
double mean_face_area(const Mesh& mesh, const glm::dmat4& transform, size_t given_faces) {
  double sum = 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    glm::dvec3 p[3];
    for (size_t k = 0; k < 3; ++k)
      p[k] = glm::dvec3(transform * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[i + k]]), 1.0));
    sum += 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
  }
  const double faces = static_cast<double>(given_faces > 0 ? given_faces : mesh.indices.size() / 3);
  return faces > 0 ? sum / faces : 0;
}

std::optional<Shape> read_mesh_shape(Reader& reader, std::string_view kind, Parameters& parameters) {
  std::optional<ReadMesh> read;
  if (kind == "trianglemesh") {
    read = read_triangle_mesh(reader, parameters);
  } else if (kind == "loopsubdiv") {
    read = read_loop_mesh(reader, parameters);
  } else if (kind == "bilinearmesh") {
    read = read_bilinear_mesh(reader, parameters);
  } else {
    read = read_ply_mesh(reader, parameters);
  }
  if (!read) return std::nullopt;
  Shape shape{{.kind = ShapeKind::mesh, .mesh = read->id}, 0};
  if (reader.state.area_light.power > 0) {
    read_pending(reader);
    shape.area = mean_face_area(reader.scene.meshes[read->id], reader.state.transform, read->faces);
  }
  return shape;
}

std::optional<Shape> read_geometry(Reader& reader, std::string_view kind, Parameters& parameters, TextureId alpha) {
  if (kind == "sphere") return read_sphere(parameters);
  if (kind == "disk") return read_disk(parameters);
  if (kind == "cylinder") return read_cylinder(parameters);
  if (kind == "curve") {
    const std::optional<Geometry> curves = read_curve(reader, parameters, alpha);
    return curves ? std::optional<Shape>({*curves, 0}) : std::nullopt;
  }
  if (kind == "trianglemesh" || kind == "plymesh" || kind == "bilinearmesh" || kind == "loopsubdiv") {
    return read_mesh_shape(reader, kind, parameters);
  }
  parameters.ignore_the_rest();
  reader.messages.error(parameters.source(),
                        fmt::format("there is no shape \"{}\"{}", kind, did_you_mean(kind, shape_kinds)));
  return std::nullopt;
}

Light to_light(Parameters& parameters, const AreaLight& area_light, double area) {
  double scale = area_light.scale;
  if (area_light.power > 0 && area > 0) {
    scale *= area_light.power / (std::numbers::pi * area * (area_light.two_sided ? 2 : 1));
  } else if (area_light.power > 0) {
    parameters.messages().warning(parameters.source(),
                                  "a light without area cannot emit the 'power' of its AreaLightSource");
  }
  Light light;
  light.spectrum = area_light.spectrum;
  light.scale = to_light_scale(parameters, scale);
  light.two_sided = area_light.two_sided ? 1 : 0;
  light.image = area_light.image;
  return light;
}

}  // namespace

void read_shape(Reader& reader, std::string_view kind, Parameters& parameters) {
  const TextureId alpha = read_alpha(reader, parameters);
  std::optional<Shape> shape = read_geometry(reader, kind, parameters, alpha);
  if (!shape) return;
  shape->geometry.alpha_texture = alpha;
  shape->geometry.flip_normal = reader.state.reverse_orientation ? 1 : 0;
  if (reader.object) {
    if (reader.state.area_light.on) {
      reader.messages.warning_once("instanced light", parameters.source(),
                                   "shapes of an object emit no light, as in pbrt; this AreaLightSource does nothing");
    }
    reader.objects[*reader.object].push_back(
        {shape->geometry, reader.state.transforms(), reader.state.material, reader.state.media, parameters.source()});
    return;
  }
  Registry& registry = reader.scene.registry;
  const Entity entity = registry.create();
  TransformPair transforms = reader.state.transforms();
  if (reader.state.area_light.on) {
    report_moving_light(reader, parameters.source());
    transforms.end = transforms.start;
  }
  set_place(reader, entity, transforms);
  registry.set(entity, shape->geometry);
  registry.set(entity, parameters.source());
  if (!reader.state.material.is_null()) registry.set(entity, MaterialSlot{reader.state.material});
  if (separates(reader.state.media)) registry.set(entity, reader.state.media);
  if (reader.state.area_light.on && is_curves(shape->geometry.kind)) {
    reader.messages.warning_once("curve light", parameters.source(),
                                 "curves emit no light, as in pbrt; this AreaLightSource does nothing");
  } else if (reader.state.area_light.on) {
    registry.set(entity, to_light(parameters, reader.state.area_light, shape->area));
  }
}

}  // namespace metamer::pbrt
