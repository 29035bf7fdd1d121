// Loop's subdivision surfaces.
#pragma once
#include <cstdint>

#include "engine/ecs/scene.h"

namespace metamer {

inline constexpr uint64_t most_subdivided_triangles = 50'000'000;

// Divides every triangle of a valid control mesh into four, `levels` times, by Loop's rules ("Smooth Subdivision
// Surfaces Based on Triangles", 1987; boundaries are cubic B-splines), then moves the vertices to where they are in the
// limit. The normals are those of the limit surface, on the side from which the control triangles run
// counter-clockwise; unit length, or zero where there is none. Normals and uvs of the control mesh play no part.
// Errors, and false: a triangle that names a vertex twice, more triangles than the above.
bool subdivide_loop(const Mesh& control, uint32_t levels, const SourceLocation& at, Mesh& mesh,
                    Diagnostics& diagnostics);

}  // namespace metamer
