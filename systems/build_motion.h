// What moves, as matrices at times that are evenly spaced while the shutter is open.
#pragma once
#include <glm/mat4x4.hpp>
#include <vector>

#include "engine/ecs/world.h"

namespace metamer {

// An affine matrix taken apart: translation, then a rotation, then what is left, a symmetric matrix that stretches
// (polar decomposition; K. Shoemake, T. Duff, "Matrix Animation and Polar Decomposition", Graphics Interface 1992). A
// mirroring matrix's stretch is negative.
struct MotionParts {
  glm::dvec3 translation;
  double rotation[4];  // quaternion x y z w
  glm::dmat3 stretch;
};
MotionParts motion_parts(const glm::dmat4& matrix);

// Between two of them, `t` from 0 to 1: translation and stretch linearly, the rotation along the shorter arc (slerp).
glm::dmat4 interpolated(const MotionParts& from, const MotionParts& to, double t);

// To the world, of an entity that moves or has ancestors that do: so many keys, 2 to 129, that linear interpolation
// between them is off by at most motion_tolerance of the entity's size and way. Empty: it stands still while the
// shutter is open. An error where it would be flattened on its way.
inline constexpr double motion_tolerance = 1e-4;
std::vector<glm::dmat4> motion_keys(const Scene& scene, Entity entity, Diagnostics& diagnostics);

// Where an object is as the shutter opens, and the keys of its motion, if it moves.
struct Place {
  glm::dmat4 to_world;
  std::vector<glm::dmat4> keys;
  bool moves() const { return !keys.empty(); }
};
// `to_world` is at the start of its motion: what emits light stands there, with a warning.
Place place_of(const Scene& scene, Entity entity, const glm::dmat4& to_world, Diagnostics& diagnostics);
// Of the last object: its columns first_key and key_count, and its keys.
void add_motion(World& world, const Place& place);

}  // namespace metamer
