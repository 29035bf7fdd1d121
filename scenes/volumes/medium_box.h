// Where a medium of grids is.
#pragma once
#include <span>

#include "engine/ecs/components.h"
#include "engine/ecs/grid.h"

namespace metamer {

// Sets the box of a medium to the smallest in its local space that holds the voxels that count of all these grids: in
// each grid's index space from `lower` - `margin` to `upper`. What interpolation between centres reaches is a margin of
// 1. Grids without voxels count as one voxel at the origin.
void set_medium_box(MediumGrid& medium, std::span<const Grid* const> grids, double margin);

}  // namespace metamer
