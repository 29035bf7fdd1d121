// Grids of OpenVDB (.vdb) and NanoVDB (.nvdb) files, told apart by their first bytes.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "engine/diagnostics.h"
#include "engine/ecs/grid.h"

namespace metamer {

// Which grid of which file is wanted, and what became of it.
struct GridRequest {
  std::string path;
  std::string grid_name;  // empty: the file's only one
  SourceLocation named_at = {};
  bool may_be_negative = false;  // temperatures
  bool may_be_missing = false;   // without an error; `found` tells
  Grid grid = {};                // in the coordinates of the file
  bool found = false;
};

// Reads on all threads. Errors at `named_at`, in the order of the requests: there is no such file, it is neither kind,
// it is cut short or damaged; it has no grid of that name (those present are listed), or of a type that is not
// supported (of float, half, double, quantised floats or three-dimensional vectors, in 5-4-3 trees); the grid has a
// perspective transform, is a level set, too large for the memory, or has values that are not finite or negative.
void read_grids(std::span<GridRequest> requests, Diagnostics& diagnostics);

// As above, of one kind of file; they throw.
void read_vdb(const std::string& path, GridRequest& request);
void read_nvdb(const std::string& path, GridRequest& request);

// The index of the wanted one among the names of a file; nothing where it may be missing. Throws if it is missing or
// not told.
std::optional<size_t> choose_grid(const GridRequest& request, std::span<const std::string> names);

// A level set is negative inside of its surface: for what must not be negative it is refused by name.
void refuse_level_set(const GridRequest& request);

}  // namespace metamer
