// Curves as columns of the world.
#pragma once
#include <glm/mat4x4.hpp>

#include "engine/ecs/world.h"

namespace metamer {

// The largest coordinate of curves in their own space.
double extent(const Curves& curves);

// Whether a transformation turns, moves and scales evenly and does not mirror: then curves keep their shape, and need
// not be instances.
bool is_turned_and_scaled(const glm::dmat4& m);

// Embree cuts a segment of a flat curve into so many straight pieces at most.
inline constexpr uint32_t pieces_of_segment = 16;

// Rows of World::curve_segments.
struct SegmentRange {
  uint32_t first = no_index, count = 0;
};
// Appends points, normals and segments, transformed by a matrix for which the above holds. Segments of flat and round
// curves that bend so much that those pieces would miss them by more than 1/20 of their width (pbrt-v4's measure) are
// divided into up to 64.
SegmentRange add_curves(const Curves& curves, ShapeKind kind, const glm::dmat4& to_world, World& world);

}  // namespace metamer
