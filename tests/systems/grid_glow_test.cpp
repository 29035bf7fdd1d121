// What glows in volumes that vary in space, on each wavelength.
#include "engine/spectrum/sources.h"
#include "tests/systems/support/lumpy_volumes.h"

namespace metamer {
namespace {

// What a flame adds along the beam, from the camera on: sigma_a L_e times what is let through so far.
template <class Density, class Glow>
double seen_glow(const Density& density, const Glow& glow, double sigma_t) {
  constexpr int steps = 4000;
  constexpr double h = 2.0 / steps;
  double sum = 0, depth = 0;
  for (int i = 0; i < steps; ++i) {
    const double z = 1 - (i + 0.5) * h, d = density(z);
    sum += glow(z) * d * std::exp(-sigma_t * (depth + 0.5 * d * h)) * h;
    depth += d * h;
  }
  return sum;
}
double warmth(int i, int j, int k) { return 20 * (i + j) + 60 * k; }  // degrees above 300 K, over 3

// A thin flame that only absorbs and one that scatters out of the way what is not followed: at max_depth 0 both show
// what they emit themselves, dimmed.
TEST(GridGlow, FollowsItsGridAndItsTemperature) {
  for (const Integrator integrator : all_levels)
    for (const double scattering : {0.0, 1.5})
      for (const bool is_hot : {false, true}) {
        SceneBuilder b = beam(1024, 0, integrator);
        MediumGrid grid = unit_box();
        grid.density = lumpy_grid(b);
        const auto box = voxels_in_box(glm::ivec3(10), glm::dvec3(-1.2), glm::dvec3(1.2));
        if (is_hot) {
          grid.temperature = add_grid(b, glm::ivec3(10), box, warmth);
          grid.temperature_offset = -100, grid.temperature_scale = 3;
          grid.blackbody = BlackbodyUnit::peak;
        } else {
          grid.emission = add_grid(b, glm::ivec3(10), box, [](int i, int, int k) { return 1 + i + (k % 3); });
        }
        const Entity flame = grid_medium(b, slope(b, 0.02, 0.05), b.constant(scattering), grid);
        Medium medium = b.scene.registry.get<Medium>(flame);
        medium.emission = is_hot ? zero_spectrum : slope(b, 1, 2);
        medium.emission_scale = 3;
        b.scene.registry.set(flame, medium);
        b.scene.meshes.push_back(cube_mesh());
        b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)), flame);
        const auto at = [&](GridId id, double z) { return value_at(b.scene.grids[id], {0.01, 0.02, z}).x; };
        Samples expected;
        for (size_t k = 0; k < expected.size(); k += 10) {
          const double nm = lambda_min_nm + double(k), sigma_a = slope_at(nm, 0.02, 0.05);
          const auto glow = [&](double z) {
            if (!is_hot) return 3 * slope_at(nm, 1, 2) * at(grid.emission, z) * sigma_a;
            const double kelvin = 3 * (at(grid.temperature, z) + 100);
            return 3 * planck_radiance(kelvin, nm) / planck_radiance(kelvin, 2.897771955e6 / kelvin) * sigma_a;
          };
          expected[k] = seen_glow([&](double z) { return at(grid.density, z); }, glow, sigma_a + scattering);
        }
        for (size_t k = 0; k < expected.size(); ++k)
          if (k % 10 != 0)
            expected[k] = std::lerp(expected[k / 10 * 10], expected[k / 10 * 10 + 10], double(k % 10) / 10);
        expect_mean(
            trace_radiances(*b.freeze()), [&](double nm) { return interpolate(expected, nm); }, 0.03);
      }
}

// In a furnace of its own radiance what absorbs and glows as much vanishes, whatever it scatters.
TEST(GridGlow, VanishesAmongItsEquals) {
  for (const Variation variation : {Variation::grey, Variation::chromatic, Variation::coloured}) {
    SceneBuilder b(16, 16, 512, many_events);
    b.light(LightKind::environment, unit_spectrum, 1);
    b.look_at({0, 0, 4}, {0, 0, 0}, perspective(30));
    const Entity smoke = white_smoke(b, variation, 0.2f);
    Medium medium = b.scene.registry.get<Medium>(smoke);
    medium.sigma_a = slope(b, 1, 0.3);
    medium.emission = unit_spectrum;
    b.scene.registry.set(smoke, medium);
    b.scene.meshes.push_back(cube_mesh());
    b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)), smoke);
    expect_mean(
        trace_radiances(*b.freeze()), [](double) { return 1.0; }, 0.04);
  }
}

}  // namespace
}  // namespace metamer
