// Rows of World::lights for emitting shapes, from world-space double precision.
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "engine/ecs/world.h"

namespace metamer {

// A triangle; it emits from the side where its vertices run counter-clockwise. `uv` is for its image.
LightRow triangle_light(const glm::dvec3 (&vertex)[3], const glm::dvec2 (&uv)[3], const Light& light);

// A sphere or a part of one, or the ellipsoid an affine map makes of it.
LightRow sphere_light(const glm::dmat4& to_world, const Geometry& geometry, const Light& light);

// A cylinder, or what an affine map makes of it.
LightRow cylinder_light(const glm::dmat4& to_world, const Geometry& geometry, const Light& light);

// A disk or ring or a sector of one, or the ellipse an affine map makes of it.
LightRow disk_light(const glm::dmat4& to_world, const Geometry& geometry, const Light& light);

// A light that is no shape: at the origin of the matrix and along its -z axis (projections +z), or the row of an
// environment. `image` is the light's, null if it has none; only its shape counts.
LightRow abstract_light(const glm::dmat4& to_world, const Light& light, const Image* image = nullptr);

// The integral of an image's luminance over the solid angle into which a light sends it, sr, by the middles of its
// pixels: all of the sphere, or the window of a projection. Of a shape's image the mean.
double image_weight(const Light& light, const Image& image);

// The point (u, v) of an image in this mapping, in [0, 1], v down, that a unit direction leads to; see
// systems/environment-inl.h.
glm::dvec2 image_point(ImageMapping mapping, const glm::dvec3& direction);

// For a light that states its power: divides the scale of the rows of its shape by pi A, the flux of unit radiance (for
// another profile than Lambert's 2 pi A / (cosine_power + 2), and twice that on two sides). False if A is 0.
bool spread_power(const Light& light, std::span<LightRow> rows);

// Flux per unit of what the light's spectrum is of one that is not at infinity: m^2 sr of a shape, sr otherwise.
//   shape  2 pi A / (cosine_power + 2), on two sides twice that
//   point  4 pi
//   goniometric, projection  1: image_weight has it
//   spot   pi (2 - cos falloff_deg - cos cone_deg): the smoothstep between the two cosines has a mean of 1/2
double flux_per_unit(const LightRow& row);

}  // namespace metamer
