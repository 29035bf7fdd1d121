// Light of points scattered in homogeneous media, found by its angles and by free paths together.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/each_target.h"
#include "tests/systems/support/grid_kernels.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

constexpr double pi = std::numbers::pi;

// Kulla and Fajardo, equations 4 and 5, with the ray's end at infinity.
TEST(Equiangular, IsDrawnByItsDensity) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform;
  for_each_target([&] {
    for (int i = 0; i < 3000; ++i) {
      const double nearest = 20 * uniform(random) - 10, distance = std::exp(8 * uniform(random) - 6);
      const double u = uniform(random), first = std::atan2(-nearest, distance);
      const double angle = first + u * (pi / 2 - first);
      const double t = distance * std::tan(angle) + nearest;
      const EquiangularPoint got = kernel_equiangular(float(nearest), float(distance), float(u));
      // Towards infinity the angle's last digits are the distance's first ones.
      if (std::cos(angle) < 0.01) continue;
      const double scale = distance / (std::cos(angle) * std::cos(angle));
      ASSERT_NEAR(got.t, t, 3e-6 * (scale + std::abs(nearest) + 1)) << nearest << ' ' << distance << ' ' << u;
      const double there = got.t - nearest;
      const double wanted = distance / ((pi / 2 - first) * (distance * distance + there * there));
      ASSERT_NEAR(got.pdf, wanted, wanted * (1e-5 + 4e-6 * (std::abs(nearest) + 1) / distance));
    }
  });
}

SpectrumId slope(SceneBuilder& b, double blue, double red) {
  const std::vector<double> lambda_nm = {360, 830}, values = {blue, red};
  return b.scene.spectra.add_table(lambda_nm, values, Extend::constant).id;
}
double slope_at(double nm, double blue, double red) { return blue + (red - blue) * (nm - 360) / 470; }

// A beam through a box of haze (or from within) past a lamp, above a black floor that stops it.
SceneBuilder hazy(uint32_t samples, bool camera_inside) {
  SceneBuilder b(16, 16, samples, 1);
  const double start = camera_inside ? 1.5 : 5;
  const Entity camera = b.look_at({0, 0, start}, {0, 0, 0}, orthographic(1e-3f), {0, 1, 0});
  const Entity haze = b.medium(b.constant(0.05), slope(b, 0.05, 0.3), 0.4f);
  b.scene.meshes.push_back(cube_mesh());
  b.separate(b.add(mesh(0), b.interface(), stretched(4, 4, 4)), haze);
  if (camera_inside) b.separate(camera, {}, haze);
  b.add(rectangle(6, 6), b.diffuse(0.0), moved(0, 0, -1));
  b.light(LightKind::point, unit_spectrum, 1, moved(0.05, 0, 0.2));
  b.light(LightKind::point, unit_spectrum, 0.5f, moved(0.3, 0.2, -4));  // behind the floor
  return b;
}
double expected_haze(double nm, double start) {
  const double sigma_s = slope_at(nm, 0.05, 0.3), sigma_t = sigma_s + 0.05, g = 0.4;
  double sum = 0;
  constexpr int steps = 40000;
  const double from = std::min(start, 2.0), h = (from + 1) / steps;
  for (int i = 0; i < steps; ++i) {
    const double z = from - (i + 0.5) * h, dz = 0.2 - z, d = std::sqrt(0.05 * 0.05 + dz * dz);
    const double cosine = -dz / d;  // of onward (0, 0, -1) and to the lamp
    const double phase = (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
    sum += sigma_s * phase / (d * d) * std::exp(-sigma_t * (from - z + d)) * h;
  }
  return sum;
}

TEST(Equiangular, ScattersOnceAsTheIntegralSays) {
  for (const bool camera_inside : {true, false}) {
    SceneBuilder b = hazy(1024, camera_inside);
    Samples expected;
    for (size_t k = 0; k < expected.size(); k += 10)
      expected[k] = expected_haze(lambda_min_nm + double(k), camera_inside ? 1.5 : 5);
    for (size_t k = 0; k < expected.size(); ++k)
      if (k % 10 != 0) expected[k] = std::lerp(expected[k / 10 * 10], expected[k / 10 * 10 + 10], double(k % 10) / 10);
    expect_mean(
        trace_radiances(*b.freeze()), [&](double nm) { return interpolate(expected, nm); }, 0.06);
  }
}

double relative_variance(const std::vector<PathRadiance>& paths) {
  double sum = 0, squares = 0;
  for (const PathRadiance& path : paths) sum += path.radiance[0], squares += path.radiance[0] * path.radiance[0];
  const double n = double(paths.size());
  return squares / n / (sum / n * sum / n) - 1;
}

// Close to the lamp the two ways together are far better than free paths; in dense milk not much worse.
TEST(Equiangular, SavesNoiseNearLampsAndCostsLittleElsewhere) {
  const auto both = [](SceneBuilder b) {
    const std::unique_ptr<World> world = b.freeze();
    EXPECT_GT(world->positional_choice.size(), 0u);
    const double together = relative_variance(trace_radiances(*world));
    world->positional_choice = {};
    return std::array{together, relative_variance(trace_radiances(*world))};
  };
  const auto haze = both(hazy(64, false));
  EXPECT_LT(haze[0], 0.4 * haze[1]);
  SceneBuilder milk(16, 16, 64, 1);
  milk.look_at({0, 0, 5}, {0, 0, 0}, orthographic(1e-3f), {0, 1, 0});
  milk.scene.meshes.push_back(cube_mesh());
  milk.separate(milk.add(mesh(0), milk.interface(), stretched(2, 2, 2)),
                milk.medium(milk.constant(0.1), milk.constant(20)));
  milk.light(LightKind::point, unit_spectrum, 1, moved(3, 0, 3));
  const auto dense = both(milk);
  EXPECT_LT(dense[0], 1.2 * dense[1]);
}

}  // namespace
}  // namespace metamer
