// Shapes that are meshes.
#pragma once
#include <optional>

#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {

struct ReadMesh {
  MeshId id = no_index;
  size_t faces = 0;  // bilinear patches, of which pbrt makes a shape each; 0: that is the triangles
};

// Nothing after reporting why.
std::optional<ReadMesh> read_triangle_mesh(Reader& reader, Parameters& parameters);
std::optional<ReadMesh> read_loop_mesh(Reader& reader, Parameters& parameters);
std::optional<ReadMesh> read_bilinear_mesh(Reader& reader, Parameters& parameters);
// Its mesh is empty until read_pending.
std::optional<ReadMesh> read_ply_mesh(Reader& reader, Parameters& parameters);

}  // namespace metamer::pbrt
