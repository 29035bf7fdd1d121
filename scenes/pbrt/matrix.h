// Transforms as pbrt-v4 defines them, in double precision; the scene gets single precision at the end.
#pragma once
#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "engine/ecs/components.h"

namespace metamer::pbrt {

glm::dmat4 translation(glm::dvec3 by);
glm::dmat4 scaling(glm::dvec3 by);
// Right-handed rotation about an axis that need not be of unit length; nothing for a zero axis (Rodrigues).
std::optional<glm::dmat4> rotation(double angle_deg, glm::dvec3 axis);
// World to a left-handed camera at `eye` that looks along +z with +y towards `up`; nothing where that is undefined.
std::optional<glm::dmat4> look_at(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 up);
// 16 numbers as pbrt files have them: column after column.
glm::dmat4 from_columns(std::span<const double> numbers);
// Any right-handed orthonormal frame whose z axis is the unit vector w.
glm::dmat4 frame_of_z(glm::dvec3 w);

// What is wrong with a matrix as a placement in space: not affine, not finite in single precision, singular; or empty.
// Singular is a determinant below 1e-12 of the product of its columns' lengths.
std::string_view transform_mistake(const glm::dmat4& m);

// Of an affine matrix, whose inverse is affine to the last bit, too.
glm::dmat4 affine_inverse(const glm::dmat4& m);

Transform to_component(const glm::dmat4& m);

}  // namespace metamer::pbrt
