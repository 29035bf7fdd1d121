#include "scenes/volumes/noise_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/schedule/workers.h"
#include "systems/noise.h"

namespace metamer {
namespace {

struct Job {
  const NoiseShape& shape;
  double voxel;
  glm::ivec3 size;
  glm::dvec3 shift;
  std::vector<float> values;
};

// Three places of the noise's period of 256, not on its lattice, that no two small seeds share (a Weyl sequence).
glm::dvec3 shift_of(uint32_t seed) {
  const auto coordinate = [&](uint32_t multiplier) { return static_cast<double>(seed * multiplier) * 0x1p-24; };
  return {coordinate(0x9e3779b1u), coordinate(0x85ebca6bu), coordinate(0xc2b2ae35u)};
}

double smoothstep(double t) { return t * t * (3 - 2 * t); }

double value_at(const Job& job, glm::dvec3 p) {
  const NoiseShape& shape = job.shape;
  double fade = 1;
  if (shape.falloff > 0) {
    const glm::dvec3 half = 0.5 * (shape.upper - shape.lower);
    const glm::dvec3 q = (p - shape.lower - half) / half;
    fade = smoothstep(std::clamp((1 - std::sqrt(glm::dot(q, q))) / shape.falloff, 0.0, 1.0));
  }
  if (!(fade > 0)) return 0;
  const double sum = reference::fbm(p * shape.frequency + job.shift, shape.roughness, shape.octaves);
  return std::max(0.0, shape.bias + sum) * fade;
}

void fill_slice(void* context, uint32_t, size_t z) {
  Job& job = *static_cast<Job*>(context);
  size_t at = z * size_t(job.size.x) * size_t(job.size.y);
  for (int y = 0; y < job.size.y; ++y)
    for (int x = 0; x < job.size.x; ++x) {
      const glm::dvec3 centre = glm::dvec3(x, y, static_cast<double>(z)) + 0.5;
      job.values[at++] = static_cast<float>(value_at(job, job.shape.lower + centre * job.voxel));
    }
}

}  // namespace

Grid noise_grid(const NoiseShape& shape) {
  const glm::dvec3 extent = shape.upper - shape.lower;
  Job job{shape, std::max({extent.x, extent.y, extent.z}) / shape.resolution, {}, shift_of(shape.seed), {}};
  for (int i = 0; i < 3; ++i) job.size[i] = std::max(1, static_cast<int>(std::ceil(extent[i] / job.voxel - 1e-9)));
  job.values.resize(size_t(job.size.x) * size_t(job.size.y) * size_t(job.size.z));
  run_units(available_threads(), static_cast<size_t>(job.size.z), Cancellation(), fill_slice, &job);
  Grid grid;
  grid.stored_as = "noise";
  for (int i = 0; i < 3; ++i) {
    grid.index_to_local[i][i] = job.voxel;
    grid.index_to_local[3][i] = shape.lower[i] + 0.5 * job.voxel;
  }
  set_dense_values(grid, job.size, job.values);
  return grid;
}

}  // namespace metamer
