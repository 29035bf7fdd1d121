// Gradient noise against Perlin's own programme, and the kernels against their twin.
#include "systems/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/each_target.h"
#include "tests/systems/support/noise_kernels.h"

namespace metamer {
namespace {

using glm::dvec3;

std::vector<dvec3> scattered_points(double extent) {
  std::vector<dvec3> points;
  for (int i = 0; i < 4096; ++i) {
    const auto at = [&](double step) { return (2 * std::fmod(i * step, 1.0) - 1) * extent; };
    points.push_back({static_cast<float>(at(0.8191725134)), static_cast<float>(at(0.6710436067)),
                      static_cast<float>(at(0.5497004779))});
  }
  return points;
}

TEST(Noise, UsesPerlinsPermutation) {
  // Improving Noise, 2002: a permutation, by its first and last entries.
  const auto table = noise_permutation();
  std::vector<int> seen(256);
  for (size_t i = 0; i < 256; ++i) {
    ++seen[table[i]];
    EXPECT_EQ(table[i], table[i + 256]);
  }
  for (const int count : seen) EXPECT_EQ(count, 1);
  EXPECT_EQ(table[0], 151u);
  EXPECT_EQ(table[1], 160u);
  EXPECT_EQ(table[254], 156u);
  EXPECT_EQ(table[255], 180u);
}

TEST(Noise, IsZeroOnTheLatticeAndBetweenMinusOneAndOne) {
  for (int i = -300; i < 300; ++i) EXPECT_EQ(reference::noise({i, 7 * i, -3 * i}), 0);
  double most = 0;
  for (const dvec3& p : scattered_points(200)) most = std::max(most, std::abs(reference::noise(p)));
  EXPECT_LE(most, 1);
  EXPECT_GT(most, 0.7);
}

TEST(Noise, HasPerlinsSlopeAtALatticePoint) {
  // At (1, 2, 3) the hash p[p[p[1] + 2] + 3] & 15 picks the gradient; noise grows along it with slope 1.
  const auto p = noise_permutation();
  const uint32_t h = p[p[p[1] + 2] + 3] & 15;
  constexpr double e = 1e-6;
  const dvec3 slope{reference::noise({1 + e, 2, 3}) / e, reference::noise({1, 2 + e, 3}) / e,
                    reference::noise({1, 2, 3 + e}) / e};
  const dvec3 directions[16] = {{1, 1, 0},  {-1, 1, 0},  {1, -1, 0}, {-1, -1, 0}, {1, 0, 1},  {-1, 0, 1},
                                {1, 0, -1}, {-1, 0, -1}, {0, 1, 1},  {0, -1, 1},  {0, 1, -1}, {0, -1, -1},
                                {1, 1, 0},  {-1, 1, 0},  {0, 1, -1}, {0, -1, -1}};
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(slope[k], directions[h][k], 1e-4) << "hash " << h;
}

TEST(Noise, RepeatsAfter256) {
  for (const dvec3& p : scattered_points(20))
    EXPECT_NEAR(reference::noise(p), reference::noise(p + dvec3(256, -512, 256)), 1e-9);
}

TEST(Noise, KernelsAgreeWithTheirTwins) {
  for_each_target([] {
    for (const dvec3& p : scattered_points(100)) EXPECT_NEAR(kernel_noise(p), reference::noise(p), 4e-6);
    for (const dvec3& p : scattered_points(10)) {
      EXPECT_NEAR(kernel_fbm(p, 0.5f, 8), reference::fbm(p, 0.5, 8), 2e-5);
      EXPECT_NEAR(kernel_turbulence(p, 0.7f, 5), reference::turbulence(p, 0.7, 5), 2e-5);
    }
  });
}

}  // namespace
}  // namespace metamer
