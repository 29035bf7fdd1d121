// A light's portal from its four corners, for readers.
#pragma once
#include <glm/vec3.hpp>
#include <string_view>

#include "engine/ecs/components.h"

namespace metamer {

// Corners in world space, counter-clockwise seen from where the light goes to, as pbrt-v4 has them. What is wrong with
// them, or nothing.
std::string_view set_portal(const glm::dvec3 (&corners)[4], Light& light);

}  // namespace metamer
