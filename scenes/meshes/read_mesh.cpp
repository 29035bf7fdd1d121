#include "scenes/meshes/read_mesh.h"

#include "scenes/gzip.h"

namespace metamer {

bool read_mesh(const std::string& path, const SourceLocation& named_at, Mesh& mesh, Diagnostics& diagnostics) {
  const std::string extension = packed_file_extension(path);
  if (extension == "ply") return read_ply(path, named_at, mesh, diagnostics);
  if (extension == "obj") return read_obj(path, named_at, mesh, diagnostics);
  diagnostics.error(named_at,
                    "'" + path + "': unknown kind of mesh; expected a file ending in .ply or .obj, or these with .gz");
  return false;
}

}  // namespace metamer
