// Lookups in frozen grids, blackbodies and equiangular samples, one place at a time, on the instruction set of the
// moment.
#pragma once
#include <array>
#include <glm/vec3.hpp>

#include "engine/ecs/volume_grids.h"

namespace metamer {

// Of a grid of one channel the first number is its value.
std::array<double, 3> kernel_trilinear(const GridColumns& grids, const GridRow& row, const glm::vec3& index);
std::array<double, 3> kernel_stochastic(const GridColumns& grids, const GridRow& row, const glm::vec3& index,
                                        const glm::vec3& chance);
double kernel_blackbody_shape(float kelvin, float lambda_nm);
double kernel_blackbody_peak(float kelvin);
// Of a ray that is nearest to a light at `nearest`, so far away from it.
struct EquiangularPoint {
  double t = 0, pdf = 0;
};
EquiangularPoint kernel_equiangular(float nearest, float distance, float u);

}  // namespace metamer
