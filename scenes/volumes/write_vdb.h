// Grids as OpenVDB files.
#pragma once
#include <span>
#include <string>

#include "engine/ecs/grid.h"
#include "engine/files/atomic_file.h"

namespace metamer {

struct NamedGrid {
  std::string name;
  const Grid* grid = nullptr;
  bool as_half = false;  // 16-bit floats: rounded
};

// One file of several grids; read_grids gives the same numbers back. Equal grids give equal bytes.
FileError write_vdb(const std::string& path, std::span<const NamedGrid> grids);

}  // namespace metamer
