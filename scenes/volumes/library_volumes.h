// The volumes of the scenes we ship, by formula: smoothed balls and columns, disturbed by noise.
#pragma once
#include "engine/ecs/grid.h"

namespace metamer {

// A cumulus on a flat base at z = 0, within 2.4 by 1.7 by 1.3; densities from 0 to 1.
Grid cloud_volume();
// Smoke that rises from the origin along +z to 3, bends and widens; densities from 0 to 1.
Grid plume_volume();
// A flame of 4 cm and its soot, in centimetres, from the origin along +z: densities from 0 to 1, and kelvin.
struct FlameVolume {
  Grid density, temperature;
};
FlameVolume flame_volume();

}  // namespace metamer
