// Shapes: what they are locally, and the entities they become.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

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

// An error if a parameter cuts a piece out of the full shape.
void require_full(Parameters& parameters, std::string_view name, double full) {
  const double value = parameters.number(name, full);
  if (std::abs(value - full) > 1e-5 * std::abs(full)) {
    parameters.error(
        name, fmt::format("'{}' is not supported yet: the shape must be full, that is '{}' {}", name, name, full));
  }
}

Shape read_sphere(Parameters& parameters) {
  const double radius = parameters.positive("radius", 1);
  require_full(parameters, "zmin", -radius);
  require_full(parameters, "zmax", radius);
  require_full(parameters, "phimax", 360);
  Geometry geometry{.kind = ShapeKind::sphere, .radius = static_cast<float>(radius)};
  return {geometry, 4 * std::numbers::pi * radius * radius};
}

Shape read_disk(Parameters& parameters) {
  const double radius = parameters.positive("radius", 1);
  const double inner = parameters.number_from("innerradius", 0, 0);
  const double height = parameters.number("height", 0);
  require_full(parameters, "phimax", 360);
  if (inner >= radius)
    parameters.error("innerradius", fmt::format("'innerradius' {} is not below 'radius' {}", inner, radius));
  Geometry geometry{.kind = ShapeKind::disk,
                    .radius = static_cast<float>(radius),
                    .inner_radius = static_cast<float>(inner),
                    .height = static_cast<float>(height)};
  return {geometry, std::numbers::pi * (radius * radius - inner * inner)};
}

// In world space, as pbrt keeps its triangles.
double mean_face_area(const Mesh& mesh, const glm::dmat4& transform, size_t triangles_per_face) {
  double sum = 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    glm::dvec3 p[3];
    for (size_t k = 0; k < 3; ++k)
      p[k] = glm::dvec3(transform * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[i + k]]), 1.0));
    sum += 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
  }
  const double faces = static_cast<double>(mesh.indices.size() / 3) / static_cast<double>(triangles_per_face);
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
    shape.area = mean_face_area(reader.scene.meshes[read->id], reader.state.transform, read->triangles_per_face);
  }
  return shape;
}

std::optional<Shape> read_geometry(Reader& reader, std::string_view kind, Parameters& parameters) {
  if (kind == "sphere") return read_sphere(parameters);
  if (kind == "disk") return read_disk(parameters);
  if (kind == "trianglemesh" || kind == "plymesh" || kind == "bilinearmesh" || kind == "loopsubdiv") {
    return read_mesh_shape(reader, kind, parameters);
  }
  parameters.ignore_the_rest();
  if (std::find(std::begin(shape_kinds), std::end(shape_kinds), kind) == std::end(shape_kinds)) {
    reader.messages.error(parameters.source(),
                          fmt::format("there is no shape \"{}\"{}", kind, did_you_mean(kind, shape_kinds)));
  } else {
    reader.messages.warning_once("shape " + std::string(kind), parameters.source(),
                                 fmt::format("shape \"{}\" is not supported yet; it is left out", kind));
  }
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
  std::optional<Shape> shape = read_geometry(reader, kind, parameters);
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
  if (reader.state.area_light.on) registry.set(entity, to_light(parameters, reader.state.area_light, shape->area));
}

}  // namespace metamer::pbrt
