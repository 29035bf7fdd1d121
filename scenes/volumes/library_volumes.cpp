#include "scenes/volumes/library_volumes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "engine/schedule/workers.h"
#include "engine/simd/portable_math.h"
#include "systems/noise.h"

namespace metamer {
namespace {

using Field = double (*)(glm::dvec3 p);

struct Job {
  Field field;
  glm::dvec3 lower;
  double voxel;
  glm::ivec3 size;
  std::vector<float> values;
};

void fill_slice(void* context, uint32_t, size_t z) {
  Job& job = *static_cast<Job*>(context);
  size_t at = z * size_t(job.size.x) * size_t(job.size.y);
  for (int y = 0; y < job.size.y; ++y)
    for (int x = 0; x < job.size.x; ++x)
      job.values[at++] =
          static_cast<float>(job.field(job.lower + job.voxel * (glm::dvec3(x, y, static_cast<double>(z)) + 0.5)));
}

// Values at the centres of cubes of `voxel` that fill a box from `lower` on.
Grid sample(Field field, glm::dvec3 lower, glm::ivec3 size, double voxel) {
  Job job{field, lower, voxel, size, {}};
  job.values.resize(size_t(size.x) * size_t(size.y) * size_t(size.z));
  run_units(available_threads(), static_cast<size_t>(size.z), Cancellation(), fill_slice, &job);
  Grid grid;
  for (int i = 0; i < 3; ++i) {
    grid.index_to_local[i][i] = voxel;
    grid.index_to_local[3][i] = lower[i] + 0.5 * voxel;
  }
  set_dense_values(grid, size, job.values);
  return grid;
}

// 0 below a, 1 above b.
double step_between(double a, double b, double x) {
  const double t = std::clamp((x - a) / (b - a), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Balls (x, y, z, radius) that a cumulus is heaped of.
constexpr std::array<std::array<double, 4>, 11> cloud_balls = {{{-0.62, 0.05, 0.20, 0.34},
                                                                {-0.28, -0.12, 0.33, 0.42},
                                                                {0.10, 0.08, 0.42, 0.50},
                                                                {0.48, -0.05, 0.28, 0.40},
                                                                {0.78, 0.10, 0.16, 0.26},
                                                                {-0.05, -0.30, 0.24, 0.32},
                                                                {0.24, 0.34, 0.24, 0.30},
                                                                {-0.40, 0.30, 0.18, 0.28},
                                                                {0.02, 0.04, 0.80, 0.30},
                                                                {-0.30, -0.02, 0.66, 0.26},
                                                                {0.34, -0.06, 0.64, 0.24}}};

double cloud(glm::dvec3 p) {
  double depth = -1;  // below the surface of the heap, in metres
  for (const auto& [x, y, z, radius] : cloud_balls)
    depth = std::max(depth, radius - glm::length(p - glm::dvec3(x, y, z)));
  if (depth < -0.2) return 0;
  // Cauliflower: lumps stand out, the creases between them are sharp.
  const double lumps = 0.16 - 0.32 * reference::turbulence(4.5 * p + glm::dvec3(3.1, 5.7, 1.3), 0.55, 5);
  const double base = step_between(0, 0.08, p.z + 0.05 * reference::fbm(6.0 * p, 0.5, 3));
  return step_between(0, 0.09, depth + lumps) * base;
}

double plume(glm::dvec3 p) {
  if (p.z <= 0) return 0;
  // The wind takes it along; the swirls grow with the column.
  const double width = 0.05 + 0.17 * p.z;
  const glm::dvec3 swirl = width * glm::dvec3(reference::fbm(2.2 * p + glm::dvec3(0.3, 7.1, 2.2), 0.5, 3),
                                              reference::fbm(2.2 * p + glm::dvec3(9.4, 1.8, 6.6), 0.5, 3), 0);
  const glm::dvec3 centre(0.07 * p.z * p.z, 0.04 * p.z * portable::sin(2.5 * p.z), 0);
  const glm::dvec3 off = glm::dvec3(p.x, p.y, 0) - centre + 1.1 * swirl;
  const double depth = 1 - glm::length(off) / width;
  if (depth < -0.6) return 0;
  const double wisps = reference::fbm(glm::dvec3(3.5 * p.x, 3.5 * p.y, 2.4 * p.z) / (0.4 + 0.3 * p.z), 0.6, 5);
  const double thinning = 1 / (1 + 2.2 * p.z * p.z) * (1 - step_between(2.3, 2.95, p.z));
  return std::max(0.0, step_between(-0.15, 0.55, depth + 0.9 * wisps) * thinning);
}

// How far within the flame, 1 on its axis and 0 at its skin: a drop that is widest at a quarter of its height.
double within_flame(glm::dvec3 p) {
  constexpr double height = 4;
  const double t = p.z / height;
  if (t <= 0 || t >= 1) return -1;
  const double radius = 0.52 * std::sqrt(t) * (1 - t) * (1.35 + 0.9 * (1 - t));
  return 1 - std::sqrt(p.x * p.x + p.y * p.y) / radius;
}

// Soot shines; there is none around the wick, where the wax still burns blue.
double soot(glm::dvec3 p) {
  const double within = within_flame(p);
  if (within <= 0) return 0;
  return step_between(0, 0.35, within) * step_between(0.5, 1.5, p.z);
}

// Hottest where air reaches the fuel: near the skin and above the middle.
double temperature(glm::dvec3 p) {
  const double within = within_flame(p);
  const double skin = step_between(-0.4, 0.1, within) * (1 - 0.18 * step_between(0.2, 1, within));
  return 1950 * skin * (0.78 + 0.22 * step_between(0.3, 2.2, p.z));
}

}  // namespace

Grid cloud_volume() { return sample(cloud, {-1.2, -0.85, -0.05}, {112, 80, 64}, 2.4 / 112); }

Grid plume_volume() { return sample(plume, {-0.7, -0.75, 0}, {80, 56, 112}, 3.0 / 112); }

FlameVolume flame_volume() {
  const glm::dvec3 lower(-0.64, -0.64, -0.2);
  const glm::ivec3 size(32, 32, 112);
  return {sample(soot, lower, size, 0.04), sample(temperature, lower, size, 0.04)};
}

}  // namespace metamer
