// Volumes that vary in space, and the beam through their middle along which integrals are known.
#pragma once
#include <numbers>

#include "engine/sampling/hash.h"
#include "tests/systems/support/grid_scene.h"

namespace metamer {

inline constexpr double pi = std::numbers::pi;
inline constexpr Integrator all_levels[] = {Integrator::local, Integrator::recursive, Integrator::path};
inline constexpr uint32_t many_events = 400;
inline constexpr int side = 20;  // voxels; not a multiple of a brick

inline SpectrumId slope(SceneBuilder& b, double blue, double red) {
  const std::vector<double> lambda_nm = {360, 830}, values = {blue, red};
  return b.scene.spectra.add_table(lambda_nm, values, Extend::constant).id;
}
inline double slope_at(double nm, double blue, double red) { return blue + (red - blue) * (nm - 360) / 470; }

inline SceneBuilder beam(uint32_t samples_per_pixel, uint32_t max_depth, Integrator integrator = Integrator::path) {
  SceneBuilder b(16, 16, samples_per_pixel, max_depth);
  b.scene.settings.integrator = integrator;
  b.look_at({0.01, 0.02, 5}, {0.01, 0.02, 0}, orthographic(1e-3f), {0, 1, 0});
  return b;
}

// Lumps from 0 to 1, different in every direction.
inline double lumps(int i, int j, int k) {
  const uint32_t hash = hash_combine(hash_combine(uint32_t(i / 2), uint32_t(j / 3)), uint32_t(k / 2));
  const double x = double(hash % 1000) / 1000;
  return x < 0.4 ? 0 : x;
}
inline GridId lumpy_grid(SceneBuilder& b) {
  return add_grid(b, glm::ivec3(side), voxels_in_box(glm::ivec3(side), glm::dvec3(-1), glm::dvec3(1)), lumps);
}
inline glm::vec3 colours(int i, int j, int k) {
  return {float(lumps(i, j, k)), float(0.3 * lumps(j, k, i)), float(2 * lumps(k, j, i + 1))};
}
inline MediumGrid unit_box() { return in_box(glm::vec3(-1), glm::vec3(1)); }

// The integral of f(local z) over the beam's way through the box from 1 to -1, from the camera on: f(z, depth so far).
template <class Density>
double along_beam(const Density& density, double from, double to, int steps = 20000) {
  double sum = 0;
  const double h = (to - from) / steps;
  for (int i = 0; i < steps; ++i) sum += density(from + (i + 0.5) * h) * h;
  return sum;
}
inline double beam_depth(const Scene& scene, GridId grid) {
  return along_beam([&](double z) { return value_at(scene.grids[grid], {0.01, 0.02, z}).x; }, -1, 1);
}

enum class Variation { grey, chromatic, coloured };
inline Entity white_smoke(SceneBuilder& b, Variation variation, float g) {
  MediumGrid grid = unit_box();
  grid.density = lumpy_grid(b);
  if (variation == Variation::coloured)
    grid.sigma_s =
        add_grid(b, glm::ivec3(side), voxels_in_box(glm::ivec3(side), glm::dvec3(-1), glm::dvec3(1)), colours);
  const SpectrumId sigma_s = variation == Variation::grey ? b.constant(5) : slope(b, 2, 8);
  return grid_medium(b, zero_spectrum, sigma_s, grid, g);
}

}  // namespace metamer
