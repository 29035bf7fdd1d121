// Rows of World::lights for emitting shapes, from world-space double precision.
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/ecs/world.h"

namespace metamer {

// A triangle; it emits from the side where its vertices run counter-clockwise.
LightRow triangle_light(const glm::dvec3 (&vertex)[3], const Light& light);

// A sphere, or the ellipsoid an affine map makes of it.
LightRow sphere_light(const glm::dmat4& to_world, const Geometry& geometry, const Light& light);

// A disk or ring, or the ellipse an affine map makes of it.
LightRow disk_light(const glm::dmat4& to_world, const Geometry& geometry, const Light& light);

}  // namespace metamer
