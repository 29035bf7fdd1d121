// Grids that are calculated: clouds of gradient noise.
#pragma once
#include <glm/vec3.hpp>

#include "engine/ecs/grid.h"

namespace metamer {

// At a place p of the box: max(0, bias + sum over the octaves of roughness^i noise(1.99^i frequency p)), Perlin's noise
// of 2002, shifted by the seed. It fades to 0 towards the ellipsoid that touches the faces of the box from within, over
// the outer `falloff` of its radius (smoothstep; 0: the whole box is filled).
struct NoiseShape {
  uint32_t seed = 0, octaves = 5;
  double roughness = 0.5, frequency = 1, bias = 0.5, falloff = 0;
  glm::dvec3 lower{0}, upper{1};
  uint32_t resolution = 64;  // voxels along the longest side of the box; they are cubes
};

// One channel; the index space begins at the box's lower corner, where voxel (0, 0, 0) has its lower corner. The same
// bits on every machine.
Grid noise_grid(const NoiseShape& shape);

}  // namespace metamer
