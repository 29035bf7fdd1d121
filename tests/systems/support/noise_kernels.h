// The SIMD noise, one point at a time, on the instruction set of the moment.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>

namespace metamer {

double kernel_noise(const glm::dvec3& p);
double kernel_fbm(const glm::dvec3& p, float roughness, uint32_t octaves);
double kernel_turbulence(const glm::dvec3& p, float roughness, uint32_t octaves);

}  // namespace metamer
