// From entities to the read-only world: the only way into the pipeline.
#pragma once
#include <glm/mat4x4.hpp>
#include <memory>
#include <span>

#include "engine/ecs/world.h"

namespace metamer {

// Builds the world: transforms, materials by kind, geometry, lights, camera, acceleration structure. Mistakes go to
// `diagnostics` with the place where the user made them; with errors among them the result is null.
std::unique_ptr<World> freeze(const Scene& scene, Diagnostics& diagnostics);
// Only the mistakes that freeze would report. The scene may be one that was read with mistakes.
void check(const Scene& scene, Diagnostics& diagnostics);
// Freezes, too, but meshes and images are given back as soon as the world has them: less memory while trees are built.
std::unique_ptr<World> freeze(Scene&& scene, Diagnostics& diagnostics);

// Object to world of every entity, by entity index. Errors: a cycle of parents, a singular or non-finite matrix.
std::vector<glm::dmat4> build_transforms(const Scene& scene, Diagnostics& diagnostics);

// Where the Material of an entity went, by entity index.
struct MaterialRow {
  ShadeKind kind = ShadeKind::diffuse;
  uint32_t row = 0;
};
// Errors: a rough material's shininess out of range, negative spectra; those of build_materials.h. Warnings: its taught
// form creates energy at normal view; the albedos of its normalised form sum to more than 1.
std::vector<MaterialRow> build_materials(const Scene& scene, World& world, Diagnostics& diagnostics);

// Textures as programs, program i for texture i; images as texels. Errors: expressions that need too deep a stack.
// Images that are left in their files are prepared for the cache. Of `disposable`, if it is not null and the scene
// itself, pixels that are not needed any more are given back.
void build_textures(const Scene& scene, Scene* disposable, World& world, Diagnostics& diagnostics);
// The row of an image as a normal map; one for all that use it.
uint32_t add_normal_map(const Image& image, ImageId id, TextureSet& set, Diagnostics& diagnostics);

// Rows of World::volumes on both sides of an entity's surface.
struct VolumeSides {
  uint32_t inside = keeps_volume, outside = keeps_volume;
};
// The media that fill space, their places by entity index, and what the camera is in. Errors: negative or infinite
// coefficients, g not between -1 and 1, a slot that names an entity without Medium.
std::vector<VolumeSides> build_volumes(const Scene& scene, std::span<const glm::dmat4> to_world, World& world,
                                       Diagnostics& diagnostics);

// Solids that paths follow and whose surfaces have a medium inside get rows of World::media of their own, by which the
// medium is nested as the solids are. Changes their rows in `materials`; both by entity index. Errors: more media than
// paths can tell apart.
void fill_solids(std::span<const VolumeSides> sides, std::vector<MaterialRow>& materials, World& world,
                 Diagnostics& diagnostics);

// The alpha of the last object. A constant one of 0 is not there for any ray, one of 1 is no mask.
void build_mask(TextureId texture, World& world);
// How the lights of the last object are found.
void build_light_finding(World& world);
// Room for all triangles: growing the columns mesh by mesh would copy them again and again. Meshes exist.
void reserve_triangles(const Scene& scene, World& world);

// Objects, vertices, quadrics, and the light rows of emitting shapes.
void build_geometry(const Scene& scene, std::span<const glm::dmat4> to_world, std::span<const MaterialRow> materials,
                    std::span<const VolumeSides> volumes, World& world, Diagnostics& diagnostics);

// An environment's rotation and the density of the directions of its image (null: none).
void build_environment(const Image* image, const glm::dmat4& to_world, Environment& environment);

// Lights that are no shapes (see light_rows.h), then the choice among all lights by power.
void build_lights(const Scene& scene, std::span<const glm::dmat4> to_world, World& world, Diagnostics& diagnostics);

// In RGB mode: every spectrum of the world's columns gets its coefficients, by its role. After all that fills columns.
void build_coefficients(World& world);

void build_camera(const Scene& scene, std::span<const glm::dmat4> to_world, World& world, Diagnostics& diagnostics);

// What the camera's centre is inside of: media that probes along the axes leave without having entered them. Needs the
// trees. A lens or an orthographic window that stretches across a boundary counts as its centre.
void build_camera_media(World& world);

// Embree's trees, built on one thread each so that they are the same every time.
void build_accelerator(World& world);

}  // namespace metamer
