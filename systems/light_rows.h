// Rows of World::lights for emitting shapes, from world-space double precision.
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "engine/ecs/world.h"

namespace metamer {

// A triangle; it emits from the side where its vertices run counter-clockwise.
LightRow triangle_light(const glm::dvec3 (&vertex)[3], const Light& light);

// A sphere, or the ellipsoid an affine map makes of it.
LightRow sphere_light(const glm::dmat4& to_world, const Geometry& geometry, const Light& light);

// A disk or ring, or the ellipse an affine map makes of it.
LightRow disk_light(const glm::dmat4& to_world, const Geometry& geometry, const Light& light);

// A point, spot or directional light at the origin of the matrix and along its -z axis, or the row of the environment.
LightRow abstract_light(const glm::dmat4& to_world, const Light& light);

// For a light that states its power: divides the scale of the rows of its shape by pi A, the flux of unit radiance (for
// another profile than Lambert's 2 pi A / (cosine_power + 2), and twice that on two sides). False if A is 0.
bool spread_power(const Light& light, std::span<LightRow> rows);

// Flux per unit of what the light's spectrum is of one that is not at infinity: m^2 sr of a shape, sr otherwise.
//   shape  2 pi A / (cosine_power + 2), on two sides twice that
//   point  4 pi
//   spot   pi (2 - cos falloff_deg - cos cone_deg): the smoothstep between the two cosines has a mean of 1/2
double flux_per_unit(const LightRow& row);

}  // namespace metamer
