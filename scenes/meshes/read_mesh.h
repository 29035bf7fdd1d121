// Triangle meshes from files. All functions return false after reporting why; the mesh is then not to be used.
#pragma once
#include <string>

#include "engine/ecs/scene.h"

namespace metamer {

// Reads PLY or OBJ, told apart by their extension; both may be compressed by gzip. `named_at` is the place that asked
// for the file; mistakes inside the file are reported with the file's own lines.
bool read_mesh(const std::string& path, const SourceLocation& named_at, Mesh& mesh, Diagnostics& diagnostics);

// Turk, "The PLY Polygon File Format", 1994: ascii and binary of either byte order, any scalar types; elements and
// properties we do not know are skipped. Polygons become fans around their first vertex, which is right for convex
// ones. Vertices: x y z, nx ny nz, and uv as u v, s t, texture_u texture_v or texture_s texture_t.
bool read_ply(const std::string& path, const SourceLocation& named_at, Mesh& mesh, Diagnostics& diagnostics);

// The same of a file that is in memory already.
bool read_ply_text(std::string_view file, const std::string& path, Mesh& mesh, Diagnostics& diagnostics);

// Wavefront OBJ through tinyobjloader: all shapes of the file merged, polygons triangulated, materials ignored.
bool read_obj(const std::string& path, const SourceLocation& named_at, Mesh& mesh, Diagnostics& diagnostics);

// What every mesh must satisfy, from whatever source: whole triangles, indices within the vertices, one normal and
// one uv per vertex or none, and finite numbers. Each kind of mistake is reported once with its count.
bool validate_mesh(const Mesh& mesh, const SourceLocation& at, Diagnostics& diagnostics);

// Triangles whose area in single precision is zero. They are allowed: nothing ever hits them.
size_t count_zero_area_triangles(const Mesh& mesh);

}  // namespace metamer
