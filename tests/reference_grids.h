// What the oracle knows of volumes that vary in space: the world's grids voxel by voxel in double precision, and free
// paths by one majorant for all of a volume.
#pragma once
#include <array>

#include "tests/reference_lights.h"
#include "tests/reference_media.h"

namespace metamer {

// Linear between voxels, at a place in the grid's index space; one channel: in all three.
std::array<double, 3> reference_grid_value(const World& world, uint32_t grid, const Vector& index);

// The first collision with what is in the volume, metres, by which everything beyond `distance` counts as none:
// infinity. `lambda_nm` alone.
double reference_free_path(const World& world, uint32_t volume, const Vector& origin, const Vector& direction,
                           double distance, double lambda_nm, ReferenceRandom& random);
// What gets through, on the mean over calls.
double reference_ratio(const World& world, uint32_t volume, const Vector& origin, const Vector& direction,
                       double distance, double lambda_nm, ReferenceRandom& random);

}  // namespace metamer
