// Frozen grids: the kernels against voxels in double precision, majorants against what is looked up, errors.
#include <random>

#include "engine/spectrum/sources.h"
#include "systems/build_grids.h"
#include "tests/reference_grids.h"
#include "tests/support/each_target.h"
#include "tests/systems/support/grid_kernels.h"
#include "tests/systems/support/grid_scene.h"

namespace metamer {
namespace {

// Bricks near and far from each other on all sides of 0, in part full, of three channels or one.
Grid scattered_grid(uint32_t channels, float background) {
  std::mt19937 random(3);
  Grid grid;
  grid.name = "bricks";
  grid.channels = channels;
  grid.background = glm::vec3(background, 2 * background, 3 * background);
  grid.origins = {{-200, -136, -24}, {-8, -8, -8}, {0, -8, -8}, {-8, 0, 0}, {0, 0, 0}, {8, 0, 0}, {120, 128, 240}};
  for (size_t i = 0; i < grid.origins.size() * brick_voxels * channels; ++i)
    grid.values.push_back(random() % 3 == 0 ? background * float(i % channels + 1) : float(random() % 1000) / 100);
  grid.lower = glm::ivec3(-200), grid.upper = glm::ivec3(256);
  return grid;
}

struct Frozen {
  Scene scene;
  World world;
  FrozenGrids grids{scene, world.grids};
  uint32_t row = 0;
  std::string error;
  explicit Frozen(const Grid& grid) {
    scene.grids.push_back(grid);
    row = grids.row_of(0, error);
  }
  const GridRow& columns() const { return world.grids.rows[row]; }
};

// Around every brick, on its borders, on voxels themselves, and far away.
std::vector<glm::vec3> places(const Grid& grid, size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> near(-2, 10);
  std::vector<glm::vec3> result = {{1e6f, 0, 0}, {-1e7f, 3, 3}, {0, 0, 1e30f}};
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 origin(grid.origins[i % grid.origins.size()]);
    glm::vec3 p = origin + glm::vec3(near(random), near(random), near(random));
    if (i % 5 == 0) p[int(i % 3)] = std::round(p[int(i % 3)]);
    if (i % 7 == 0) p = glm::round(p);
    result.push_back(p);
  }
  return result;
}

TEST(GridLookup, IsLinearBetweenVoxelsToItsStatedError) {
  for (const uint32_t channels : {1u, 3u})
    for (const float background : {0.0f, 0.5f}) {
      const Frozen frozen(scattered_grid(channels, background));
      ASSERT_EQ(frozen.error, "");
      for_each_target([&] {
        for (const glm::vec3& p : places(frozen.scene.grids[0], 3000)) {
          const auto got = kernel_trilinear(frozen.world.grids, frozen.columns(), p);
          const bool is_far = glm::any(glm::greaterThan(glm::abs(p), glm::vec3(1000)));
          const glm::dvec3 wanted = is_far ? glm::dvec3(scattered_grid(channels, background).background)
                                           : interpolated(frozen.scene.grids[0], p);
          const auto oracle = reference_grid_value(frozen.world, frozen.row, is_far ? glm::dvec3(900) : glm::dvec3(p));
          // Of the place 3e-5 voxels are uncertain, 300 voxels from the lowest one, times slopes of up to 10.
          for (int c = 0; c < int(channels); ++c) {
            ASSERT_NEAR(got[size_t(c)], wanted[c], 5e-4) << p.x << ' ' << p.y << ' ' << p.z;
            ASSERT_NEAR(oracle[size_t(c)], wanted[c], 1e-12);
          }
        }
      });
    }
}

TEST(GridLookup, TakesOneVoxelWithTrilinearChance) {
  const Frozen frozen(scattered_grid(1, 0.25f));
  constexpr int n = 16;
  for_each_target([&] {
    for (const glm::vec3& p : places(frozen.scene.grids[0], 60)) {
      double sum = 0;
      for (int i = 0; i < n * n * n; ++i) {
        const glm::vec3 u((float(i % n) + 0.5f) / n, (float(i / n % n) + 0.5f) / n, (float(i / n / n) + 0.5f) / n);
        sum += kernel_stochastic(frozen.world.grids, frozen.columns(), p, u)[0];
      }
      // Each of three weights is right to half a step of u.
      const double wanted = kernel_trilinear(frozen.world.grids, frozen.columns(), p)[0];
      ASSERT_NEAR(sum / (n * n * n), wanted, 10 * 1.5 / n) << p.x << ' ' << p.y << ' ' << p.z;
    }
  });
  // Where the place is in the middle of a step the weights are exact.
  const glm::vec3 p(3 + 5.0f / 16, 4 + 7.0f / 16, 2 + 8.0f / 16);
  double sum = 0;
  for (int i = 0; i < n * n * n; ++i)
    sum += kernel_stochastic(
        frozen.world.grids, frozen.columns(), p,
        glm::vec3((float(i % n) + 0.5f) / n, (float(i / n % n) + 0.5f) / n, (float(i / n / n) + 0.5f) / n))[0];
  EXPECT_NEAR(sum / (n * n * n), kernel_trilinear(frozen.world.grids, frozen.columns(), p)[0], 1e-4);
}

TEST(GridLookup, StaysWithinTheKnownRange) {
  const Frozen frozen(scattered_grid(3, 0.1f));
  std::mt19937 random(9);
  for (const glm::vec3& p : places(frozen.scene.grids[0], 2000)) {
    if (glm::any(glm::greaterThan(glm::abs(p), glm::vec3(1000)))) continue;
    const glm::ivec3 at(glm::floor(p));
    const int reach = int(random() % 12);
    const ValueRange range = frozen.grids.range(frozen.row, at - reach, at + reach / 2);
    for (const double value : kernel_trilinear(frozen.world.grids, frozen.columns(), p)) {
      ASSERT_LE(value, double{range.greatest} * (1 + 1e-6));
      ASSERT_GE(value, double{range.least} * (1 - 1e-6));
    }
  }
}

// Two far corners cost tables, not what is between them; too far is an error.
TEST(GridLookup, HoldsSparseGridsInBoundedMemory) {
  Grid grid;
  grid.name = "far";
  grid.origins = {{-8000, -8000, -8000}, {8000, 8000, 8000}};
  grid.values.assign(2 * brick_voxels, 1);
  grid.lower = glm::ivec3(-8000), grid.upper = glm::ivec3(8008);
  const Frozen frozen(grid);
  EXPECT_EQ(frozen.error, "");
  EXPECT_LT(frozen.world.grids.bytes(), size_t{20} << 20);
  EXPECT_EQ(kernel_trilinear(frozen.world.grids, frozen.columns(), glm::vec3(8003))[0], 1);
  EXPECT_EQ(kernel_trilinear(frozen.world.grids, frozen.columns(), glm::vec3(0))[0], 0);
  grid.origins[1] = {80000, 80000, 80000};
  grid.upper = glm::ivec3(80008);
  EXPECT_NE(Frozen(grid).error.find("'far'"), std::string::npos);
  grid.origins[1] = {1 << 24, 0, 0};
  EXPECT_NE(Frozen(grid).error.find("coordinates"), std::string::npos);
}

TEST(GridLookup, RefusesWhatIsNoDensity) {
  for (const float bad : {-1e-6f, std::nanf(""), INFINITY}) {
    Grid grid = scattered_grid(1, 0);
    grid.values[700] = bad;
    EXPECT_NE(Frozen(grid).error.find("'bricks'"), std::string::npos) << bad;
  }
}

TEST(Blackbody, StaysWithinItsStatedError) {
  constexpr double wien_nm_kelvin = 2.897771955e6;
  for_each_target([&] {
    for (float kelvin = 101; kelvin < 1e6f; kelvin *= 1.07f) {
      const double peak = planck_radiance(kelvin, wien_nm_kelvin / double{kelvin});
      ASSERT_NEAR(kernel_blackbody_peak(kelvin), peak, 1e-6 * peak);
      for (const float lambda_nm : {360.0f, 431.5f, 555.0f, 830.0f}) {
        const double y = 1.438776877e7 / (double{kelvin} * double{lambda_nm});
        const double wanted = planck_radiance(kelvin, lambda_nm) / peak;
        const double got = kernel_blackbody_shape(kelvin, lambda_nm);
        if (y > 86.9) {
          ASSERT_NEAR(got, 0, 1e-29);
        } else {
          ASSERT_NEAR(got, wanted, wanted * (1e-6 + 1.5e-7 * y)) << kelvin << " K " << lambda_nm << " nm";
        }
      }
    }
  });
}

}  // namespace
}  // namespace metamer
