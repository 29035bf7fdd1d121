#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <optional>

#include "engine/simd/portable_math.h"
#include "systems/build_curves.h"
#include "systems/build_light_images.h"
#include "systems/build_motion.h"
#include "systems/freeze.h"
#include "systems/light_rows.h"

namespace metamer {
namespace {

constexpr double farthest = 1e18;          // metres; Embree's largest coordinate is 1.8e18
constexpr double farthest_inverse = 1e36;  // float's largest number is 3.4e38
constexpr float infinity = std::numeric_limits<float>::infinity();

struct Builder {
  const Scene& scene;
  World& world;
  Diagnostics& diagnostics;
  std::vector<uint32_t> mesh_users;    // how many entities show a mesh
  std::vector<uint32_t> shared_first;  // first triangle of a mesh kept in its own space, or no_index
  std::vector<double> mesh_extent;     // largest coordinate of a mesh in its own space
  std::vector<uint32_t> curve_users;
  std::vector<SegmentRange> shared_curves[2];  // of curves that have been added; as ribbons
};

Placement make_placement(const glm::dmat4& to_world, const Geometry& geometry) {
  const glm::dmat4 to_object = glm::inverse(to_world);
  Placement placement;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) {
      placement.to_world[row * 4 + column] = static_cast<float>(to_world[column][row]);
      placement.to_object[row * 4 + column] = static_cast<float>(to_object[column][row]);
    }
  placement.radius = geometry.radius;
  placement.inner_radius = geometry.inner_radius;
  if (geometry.kind == ShapeKind::disk) {
    placement.z_min = placement.z_max = geometry.height;
  } else {
    // Where a sphere is whole its poles are not to be lost by rounding.
    const bool is_sphere = geometry.kind == ShapeKind::sphere;
    placement.z_min = is_sphere && geometry.z_min <= -geometry.radius ? -infinity : geometry.z_min;
    placement.z_max = is_sphere && geometry.z_max >= geometry.radius ? infinity : geometry.z_max;
  }
  const double phi = double{geometry.phi_max_deg} * glm::pi<double>() / 180;
  placement.phi_max = static_cast<float>(phi);
  if (geometry.phi_max_deg < 360) {
    placement.cos_phi_max = static_cast<float>(portable::cos(phi));
    placement.sin_phi_max = static_cast<float>(portable::sin(phi));
  }
  placement.normal_sign = geometry.flip_normal != 0 ? -1.0f : 1.0f;
  return placement;
}

// The largest coordinate of a shape in its own space: of a mesh's vertices, or of a box around a quadric or rectangle.
double extent(const Geometry& geometry) {
  const bool has_ends = geometry.kind == ShapeKind::cylinder;
  const float end = has_ends ? std::max(std::abs(geometry.z_min), std::abs(geometry.z_max)) : 0;
  return std::max({geometry.radius, std::abs(geometry.height), geometry.width / 2, geometry.depth / 2, end});
}
double extent(const Mesh& mesh) {
  float largest = 0;
  for (const glm::vec3& p : mesh.positions) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return double{largest};
}

// Whether all of a placed shape and its inverse's numbers are where single precision and Embree can follow.
bool is_within_reach(const glm::dmat4& to_world, double extent) {
  const glm::dmat4 to_object = glm::inverse(to_world);
  for (int row = 0; row < 3; ++row) {
    double reach = std::abs(to_world[3][row]), inverse = std::abs(to_object[3][row]);
    for (int column = 0; column < 3; ++column) {
      reach += std::abs(to_world[column][row]) * extent;
      inverse += std::abs(to_object[column][row]);
    }
    if (!(reach <= farthest) || !(inverse <= farthest_inverse)) return false;
  }
  return true;
}

constexpr float no_uv = std::numeric_limits<float>::quiet_NaN();
void push_vector(Column<float>& column, const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) column.push_back(static_cast<float>(v[i]));
}

// Appends the vertices and triangles of a mesh, transformed by `to_world`; returns the first triangle.
//
// A triangle's outside is the side its vertex normals point to where there are any, else the side from which its
// vertices run counter-clockwise in the mesh's own space; `flip` turns it over. The vertex order is made to say so.
uint32_t add_triangles(Builder& b, const Mesh& mesh, const glm::dmat4& to_world, bool flip) {
  World& world = b.world;
  const uint32_t first_triangle = static_cast<uint32_t>(world.triangle_vertices.size() / 3);
  const uint32_t first_vertex = static_cast<uint32_t>(world.positions.size() / 3);
  const glm::dmat3 linear(to_world);
  const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(linear));
  const bool mirrored = glm::determinant(linear) < 0;
  const bool has_normals = mesh.normals.size() == mesh.positions.size();
  const bool has_uvs = mesh.uvs.size() == mesh.positions.size();
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    push_vector(world.positions, glm::dvec3(to_world * glm::dvec4(glm::dvec3(mesh.positions[v]), 1.0)));
    glm::dvec3 normal(0);
    if (has_normals) {
      normal = normal_matrix * glm::dvec3(mesh.normals[v]);
      const double length = glm::length(normal);
      normal = length > 0 ? (flip ? -normal : normal) / length : glm::dvec3(0);
    }
    push_vector(world.normals, normal);
    world.uvs.push_back(has_uvs ? mesh.uvs[v].x : no_uv);
    world.uvs.push_back(has_uvs ? mesh.uvs[v].y : no_uv);
  }
  const auto vector_at = [](const Column<float>& column, uint32_t v) {
    return glm::dvec3(column[v * 3], column[v * 3 + 1], column[v * 3 + 2]);
  };
  for (size_t t = 0; t < mesh.indices.size(); t += 3) {
    uint32_t i[3];
    for (int k = 0; k < 3; ++k) i[k] = first_vertex + mesh.indices[t + k];
    const glm::dvec3 p = vector_at(world.positions, i[0]);
    const glm::dvec3 cross = glm::cross(vector_at(world.positions, i[1]) - p, vector_at(world.positions, i[2]) - p);
    if (!(glm::dot(cross, cross) > 0)) ++world.zero_area_triangles;
    const glm::dvec3 towards =
        vector_at(world.normals, i[0]) + vector_at(world.normals, i[1]) + vector_at(world.normals, i[2]);
    const double side = glm::dot(cross, towards);
    const bool turn = side != 0 ? side < 0 : mirrored != flip;
    if (turn) std::swap(i[1], i[2]);
    for (const uint32_t index : i) world.triangle_vertices.push_back(index);
  }
  return first_triangle;
}

Mesh rectangle_mesh(const Geometry& geometry) {
  Mesh mesh;
  const float x = geometry.width / 2, y = geometry.depth / 2;
  for (const glm::vec3 p : {glm::vec3(-x, -y, 0), glm::vec3(x, -y, 0), glm::vec3(x, y, 0), glm::vec3(-x, y, 0)})
    mesh.positions.push_back(p);
  for (const glm::vec2 uv : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)})
    mesh.uvs.push_back(uv);
  for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(i);
  return mesh;
}

// What the lights of the last object, those from its first_light on, have together: their image and their power.
void finish_lights(Builder& b, Entity entity) {
  Light light = b.scene.registry.get<Light>(entity);
  World& world = b.world;
  const size_t first = world.objects.first_light.back();
  if (light.image != no_index) {
    const std::optional<uint32_t> image = add_light_image(b.scene, light, world);
    if (!image) b.diagnostics.error(b.scene.location(entity), too_many_light_texels);
    while (world.image_of_light.size() < first) world.image_of_light.push_back(no_index);
    while (world.image_of_light.size() < world.lights.size()) world.image_of_light.push_back(image.value_or(no_index));
    world.has_shape_images = true;
    const double weight = image ? double{world.light_images.rows[*image].weight} : 1;
    if (light.is_power != 0 && weight > 0) light.scale = static_cast<float>(light.scale / weight);
  }
  if (light.is_power == 0) return;
  if (!spread_power(light, {b.world.lights.data() + first, b.world.lights.size() - first})) {
    b.diagnostics.error(b.scene.location(entity),
                        fmt::format("the area light {} has no area to emit its power from", b.scene.describe(entity)));
  }
}

void add_mesh_object(Builder& b, Entity entity, const Geometry& geometry, const Mesh& mesh, const Place& place) {
  const glm::dmat4& to_world = place.to_world;
  ObjectColumns& objects = b.world.objects;
  const bool emits = b.scene.registry.has<Light>(entity);
  // Of a mesh used more than once, and of one that moves, the vertices stay in its own space.
  const bool can_share = geometry.kind == ShapeKind::mesh && !emits && geometry.flip_normal == 0;
  const bool shared = can_share && (b.mesh_users[geometry.mesh] > 1 || place.moves());
  uint32_t first = 0, placement = 0;
  if (shared || place.moves()) {
    uint32_t own = no_index;
    uint32_t& known = shared ? b.shared_first[geometry.mesh] : own;
    if (known == no_index) known = add_triangles(b, mesh, glm::dmat4(1), geometry.flip_normal != 0);
    first = known;
    placement = static_cast<uint32_t>(b.world.placements.size());
    Placement instance = make_placement(to_world, geometry);
    // The outside is named in the mesh's own space; a mirror reverses the order in which its vertices run.
    if (glm::determinant(glm::dmat3(to_world)) < 0) instance.normal_sign = -1;
    b.world.placements.push_back(instance);
    b.world.has_instances = true;
  } else {
    first = add_triangles(b, mesh, to_world, geometry.flip_normal != 0);
  }
  objects.first_triangle.push_back(first);
  objects.triangle_count.push_back(static_cast<uint32_t>(mesh.indices.size() / 3));
  objects.placement.push_back(placement);
  if (!emits) return;
  objects.first_light.back() = static_cast<uint32_t>(b.world.lights.size());
  for (uint32_t t = first; t < first + mesh.indices.size() / 3; ++t) {
    glm::dvec3 vertices[3];
    glm::dvec2 uvs[3];
    for (int k = 0; k < 3; ++k) {
      const size_t vertex = b.world.triangle_vertices[size_t{3} * t + k];
      const float *p = b.world.positions.data() + 3 * vertex, *uv = b.world.uvs.data() + 2 * vertex;
      vertices[k] = {p[0], p[1], p[2]};
      uvs[k] = std::isnan(uv[0]) ? glm::dvec2(k > 0, k > 1) : glm::dvec2(uv[0], uv[1]);  // as in systems/surface.cpp
    }
    b.world.lights.push_back(triangle_light(vertices, uvs, b.scene.registry.get<Light>(entity)));
  }
  finish_lights(b, entity);
}

void add_quadric_object(Builder& b, Entity entity, const Geometry& geometry, const glm::dmat4& to_world) {
  ObjectColumns& objects = b.world.objects;
  objects.first_triangle.push_back(0);
  objects.triangle_count.push_back(0);
  objects.placement.push_back(static_cast<uint32_t>(b.world.placements.size()));
  b.world.placements.push_back(make_placement(to_world, geometry));
  b.world.has_quadrics = true;
  if (!b.scene.registry.has<Light>(entity)) return;
  objects.first_light.back() = static_cast<uint32_t>(b.world.lights.size());
  const Light light = b.scene.registry.get<Light>(entity);
  const auto make_light = geometry.kind == ShapeKind::sphere     ? sphere_light
                          : geometry.kind == ShapeKind::cylinder ? cylinder_light
                                                                 : disk_light;
  b.world.lights.push_back(make_light(to_world, geometry, light));
  finish_lights(b, entity);
}

void add_curves_object(Builder& b, Entity entity, const Geometry& geometry, const Curves& curves, const Place& place) {
  ObjectColumns& objects = b.world.objects;
  if (b.scene.registry.has<Light>(entity)) {
    b.diagnostics.error(b.scene.location(entity),
                        fmt::format("{} cannot emit light: it is made of curves", b.scene.describe(entity)));
  }
  const bool alone = b.curve_users[geometry.curves] == 1 && geometry.flip_normal == 0 && !place.moves();
  SegmentRange& known = b.shared_curves[geometry.kind == ShapeKind::ribbons][geometry.curves];
  uint32_t placement = 0;
  if (alone && is_turned_and_scaled(place.to_world)) {
    known = add_curves(curves, geometry.kind, place.to_world, b.world);
  } else {
    if (known.first == no_index) known = add_curves(curves, geometry.kind, glm::dmat4(1), b.world);
    placement = static_cast<uint32_t>(b.world.placements.size());
    b.world.placements.push_back(make_placement(place.to_world, geometry));
  }
  objects.first_triangle.push_back(known.first);
  objects.triangle_count.push_back(known.count);
  objects.placement.push_back(placement);
  b.world.has_curves = true;
}

// How often heavy data is shown, and that there is what entities name.
void count_users(Builder& b) {
  const Table<Geometry>& table = b.scene.registry.table<Geometry>();
  b.mesh_users.resize(b.scene.meshes.size());
  b.shared_first.resize(b.scene.meshes.size(), no_index);
  b.curve_users.resize(b.scene.curves.size());
  for (std::vector<SegmentRange>& shared : b.shared_curves) shared.resize(b.scene.curves.size());
  b.scene.registry.each<Geometry>([&](Entity entity, uint32_t row) {
    const Geometry geometry = table.get(row);
    const bool are_curves = is_curves(geometry.kind);
    if (geometry.kind != ShapeKind::mesh && !are_curves) return;
    std::vector<uint32_t>& users = are_curves ? b.curve_users : b.mesh_users;
    const uint32_t id = are_curves ? geometry.curves : geometry.mesh;
    if (id < users.size()) {
      ++users[id];
    } else {
      b.diagnostics.error(b.scene.location(entity), fmt::format("{} names {} not exist", b.scene.describe(entity),
                                                                are_curves ? "curves that do" : "a mesh that does"));
    }
  });
}

// The last object is an interface: it hides no light, but shadow rays look for it on their way.
void pass_shadows(World& world) {
  uint32_t& mask = world.objects.visibility.back();
  if ((mask & visible_to_shadows) != 0) mask = (mask & ~visible_to_shadows) | visible_to_crossings;
  world.has_interfaces = world.has_volumes = true;
}

}  // namespace

void build_geometry(const Scene& scene, std::span<const glm::dmat4> to_world, std::span<const MaterialRow> materials,
                    std::span<const VolumeSides> volumes, World& world, Diagnostics& diagnostics) {
  const Registry& registry = scene.registry;
  Builder b{scene, world, diagnostics, {}, {}, {}, {}, {}};
  world.placements.push_back(make_placement(glm::dmat4(1), Geometry{}));
  const Table<Geometry>& table = registry.table<Geometry>();
  count_users(b);
  for (const Mesh& mesh : scene.meshes) b.mesh_extent.push_back(extent(mesh));
  if (diagnostics.has_errors()) return;
  reserve_triangles(scene, world);
  registry.each<Geometry>([&](Entity entity, uint32_t row) {
    const Geometry geometry = table.get(row);
    ObjectColumns& objects = world.objects;
    const bool is_mesh = geometry.kind == ShapeKind::mesh || geometry.kind == ShapeKind::rectangle;
    objects.kind.push_back(static_cast<uint32_t>(is_mesh ? ShapeKind::mesh : geometry.kind));
    objects.shade_kind.push_back(static_cast<uint32_t>(materials[entity.index].kind));
    objects.material.push_back(materials[entity.index].row);
    objects.first_light.push_back(no_index);
    objects.visibility.push_back(registry.get<Visibility>(entity).mask);
    if (materials[entity.index].kind == ShadeKind::interface) pass_shadows(world);
    const VolumeSides sides = entity.index < volumes.size() ? volumes[entity.index] : VolumeSides{};
    objects.volume_inside.push_back(sides.inside);
    objects.volume_outside.push_back(sides.outside);
    objects.alpha.push_back(no_index);
    build_mask(geometry.alpha_texture, world);
    const double size = geometry.kind == ShapeKind::mesh ? b.mesh_extent[geometry.mesh]
                        : is_curves(geometry.kind)       ? extent(scene.curves[geometry.curves])
                                                         : extent(geometry);
    const Place place = place_of(scene, entity, to_world[entity.index], diagnostics);
    add_motion(world, place);
    const bool reaches = std::all_of(place.keys.begin(), place.keys.end(),
                                     [&](const glm::dmat4& key) { return is_within_reach(key, size); });
    if (!reaches || !is_within_reach(place.to_world, size))
      diagnostics.error(scene.location(entity),
                        fmt::format("{} is too large, too small or too far away for single precision: shapes may reach "
                                    "1e18 m from the origin",
                                    scene.describe(entity)));
    if (geometry.kind == ShapeKind::mesh)
      add_mesh_object(b, entity, geometry, scene.meshes[geometry.mesh], place);
    else if (is_mesh)
      add_mesh_object(b, entity, geometry, rectangle_mesh(geometry), place);
    else if (is_curves(geometry.kind))
      add_curves_object(b, entity, geometry, scene.curves[geometry.curves], place);
    else
      add_quadric_object(b, entity, geometry, place.to_world);
    build_light_finding(world);
  });
  // Embree reads 16 bytes for the last vertex.
  for (int i = 0; i < 4; ++i) world.positions.push_back(0);
  if (!world.curve_normals.empty()) world.curve_normals.push_back(0);
}

}  // namespace metamer
