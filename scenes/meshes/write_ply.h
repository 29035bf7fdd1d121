// Meshes to files.
#pragma once
#include <string>

#include "engine/ecs/scene.h"

namespace metamer {

// The mesh as a binary little-endian PLY file, every number bit by bit: read_ply gives the same columns back.
std::string ply_bytes(const Mesh& mesh);

}  // namespace metamer
