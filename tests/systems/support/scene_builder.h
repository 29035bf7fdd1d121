// Scenes from code, for the tests of the systems.
#pragma once
#include <glm/ext/matrix_transform.hpp>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "engine/ecs/scene.h"
#include "systems/freeze.h"
#include "systems/render.h"

namespace metamer {

struct SceneBuilder {
  Scene scene;

  SceneBuilder(uint32_t width, uint32_t height, uint32_t samples_per_pixel, uint32_t max_depth) {
    scene.settings.width = width;
    scene.settings.height = height;
    scene.settings.samples_per_pixel = samples_per_pixel;
    scene.settings.max_depth = max_depth;
    scene.settings.filter = {FilterKind::box, 0.5f, 0.5f, 0.5f};
  }

  SpectrumId constant(double value) { return scene.spectra.add_constant(value).id; }
  SpectrumId named(std::string_view name) { return scene.spectra.add_named(name).value(); }

  Material diffuse(SpectrumId reflectance) {
    Material material;
    material.reflectance = reflectance;
    return material;
  }
  Material diffuse(double reflectance) { return diffuse(constant(reflectance)); }
  Material conductor(SpectrumId eta, SpectrumId kappa, float alpha_x = 0, float alpha_y = 0) {
    Material material;
    material.kind = MaterialKind::conductor;
    material.eta = eta;
    material.kappa = kappa;
    material.alpha_x = alpha_x;
    material.alpha_y = alpha_y;
    return material;
  }
  Material rough(SpectrumId kd, SpectrumId ks, float shininess, bool normalized) {
    Material material;
    material.kind = MaterialKind::rough;
    material.kd = kd;
    material.ks = ks;
    material.shininess = shininess;
    material.normalized = normalized;
    return material;
  }
  Material coated(SpectrumId reflectance, SpectrumId eta, float alpha = 0) {
    Material material;
    material.kind = MaterialKind::coated;
    material.reflectance = reflectance;
    material.eta = eta;
    material.alpha_x = material.alpha_y = alpha;
    return material;
  }
  Material dielectric(SpectrumId eta) {
    Material material;
    material.kind = MaterialKind::dielectric;
    material.eta = eta;
    return material;
  }

  Material smooth(SpectrumId n, SpectrumId kappa, uint32_t priority = 0) {
    Material material = dielectric(n);
    material.kind = MaterialKind::smooth;
    material.kappa = kappa;
    material.priority = priority;
    return material;
  }
  Material thin(SpectrumId eta, SpectrumId kappa, float thickness) {
    Material material = dielectric(eta);
    material.kappa = kappa;
    material.thin = 1;
    material.thickness = thickness;
    return material;
  }
  Material rough_glass(SpectrumId eta, float alpha_x, float alpha_y) {
    Material material = dielectric(eta);
    material.alpha_x = alpha_x;
    material.alpha_y = alpha_y;
    return material;
  }

  Material interface() {
    Material material;
    material.kind = MaterialKind::interface;
    return material;
  }
  Entity medium(SpectrumId sigma_a, SpectrumId sigma_s, float g = 0) {
    const Entity entity = scene.registry.create();
    Medium medium;
    medium.sigma_a = sigma_a;
    medium.sigma_s = sigma_s;
    medium.g = g;
    scene.registry.set(entity, medium);
    return entity;
  }
  // The media on both sides of a surface; of a camera, `outside` is what it is in.
  void separate(Entity surface, Entity inside, Entity outside = {}) {
    scene.registry.set(surface, MediumSlot{inside, outside});
  }

  Entity place(const glm::dmat4& matrix = glm::dmat4(1)) {
    const Entity entity = scene.registry.create();
    Transform t;
    for (int column = 0; column < 4; ++column) {
      t.row0[column] = static_cast<float>(matrix[column][0]);
      t.row1[column] = static_cast<float>(matrix[column][1]);
      t.row2[column] = static_cast<float>(matrix[column][2]);
    }
    scene.registry.set(entity, t);
    return entity;
  }
  Entity add(const Geometry& geometry, const Material& material, const glm::dmat4& matrix = glm::dmat4(1)) {
    const Entity entity = place(matrix);
    scene.registry.set(entity, geometry);
    scene.registry.set(entity, material);
    return entity;
  }
  void emit(Entity entity, SpectrumId spectrum, float scale, bool two_sided = false) {
    Light light;
    light.spectrum = spectrum;
    light.scale = scale;
    light.two_sided = two_sided;
    scene.registry.set(entity, light);
  }
  Entity light(LightKind kind, SpectrumId spectrum, float scale, const glm::dmat4& matrix = glm::dmat4(1)) {
    const Entity entity = place(matrix);
    Light light;
    light.kind = kind;
    light.spectrum = spectrum;
    light.scale = scale;
    scene.registry.set(entity, light);
    return entity;
  }
  Entity environment(const Image& image, float scale, const glm::dmat4& matrix = glm::dmat4(1)) {
    scene.images.push_back(image);
    const Entity entity = place(matrix);
    Light light;
    light.kind = LightKind::environment;
    light.spectrum = unit_spectrum;
    light.scale = scale;
    light.image = static_cast<ImageId>(scene.images.size() - 1);
    scene.registry.set(entity, light);
    return entity;
  }
  Entity look_at(const glm::dvec3& from, const glm::dvec3& to, Camera camera,
                 const glm::dvec3& up = glm::dvec3(0, 1, 0)) {
    const glm::dvec3 z = glm::normalize(to - from);
    const glm::dvec3 x = glm::normalize(glm::cross(z, up)), y = glm::cross(x, z);
    const Entity entity = place(glm::dmat4(glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4(from, 1)));
    scene.registry.set(entity, camera);
    return entity;
  }

  std::unique_ptr<World> freeze() {
    Diagnostics diagnostics;
    std::unique_ptr<World> world = metamer::freeze(scene, diagnostics);
    if (!world) throw std::runtime_error(format_diagnostics(diagnostics));
    return world;
  }
};

inline Geometry sphere(float radius) {
  Geometry geometry;
  geometry.kind = ShapeKind::sphere;
  geometry.radius = radius;
  return geometry;
}
inline Geometry disk(float radius, float inner_radius = 0) {
  Geometry geometry;
  geometry.kind = ShapeKind::disk;
  geometry.radius = radius;
  geometry.inner_radius = inner_radius;
  return geometry;
}
inline Geometry rectangle(float width, float depth) {
  Geometry geometry;
  geometry.kind = ShapeKind::rectangle;
  geometry.width = width;
  geometry.depth = depth;
  return geometry;
}
inline Geometry mesh(MeshId id) {
  Geometry geometry;
  geometry.mesh = id;
  return geometry;
}
inline Camera perspective(float fov_deg) {
  Camera camera;
  camera.fov_deg = fov_deg;
  return camera;
}
inline Camera orthographic(float screen_height) {
  Camera camera;
  camera.kind = CameraKind::orthographic;
  camera.screen_height = screen_height;
  return camera;
}

// Unit cube around the origin, counter-clockwise from outside, no vertex normals.
inline Mesh cube_mesh() {
  Mesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.positions.push_back({corner & 1 ? 0.5f : -0.5f, corner & 2 ? 0.5f : -0.5f, corner & 4 ? 0.5f : -0.5f});
  for (const uint32_t i : {0u, 2u, 3u, 0u, 3u, 1u, 4u, 5u, 7u, 4u, 7u, 6u, 0u, 4u, 6u, 0u, 6u, 2u,
                           1u, 3u, 7u, 1u, 7u, 5u, 0u, 1u, 5u, 0u, 5u, 4u, 2u, 6u, 7u, 2u, 7u, 3u})
    mesh.indices.push_back(i);
  return mesh;
}

inline glm::dmat4 moved(double x, double y, double z) { return glm::translate(glm::dmat4(1), glm::dvec3(x, y, z)); }
inline glm::dmat4 turned(double degrees, double x, double y, double z) {
  return glm::rotate(glm::dmat4(1), glm::radians(degrees), glm::dvec3(x, y, z));
}
inline glm::dmat4 stretched(double x, double y, double z) { return glm::scale(glm::dmat4(1), glm::dvec3(x, y, z)); }

inline Film render_film(const World& world, const RenderOptions& options = {2, 32}, RenderStats* stats = nullptr) {
  Film film(world.settings.width, world.settings.height, world.settings.band_count);
  Cancellation cancellation;
  RenderProgress progress;
  const RenderStats got = render(world, options, cancellation, progress, film);
  if (stats != nullptr) *stats = got;
  return film;
}

}  // namespace metamer
