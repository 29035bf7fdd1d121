// The pipeline's film against the oracle's picture: z-scores of 4x4 blocks and of the whole picture.
//
// Both are unbiased with independent errors of known variance: the film's from its four replicates, pooled over the
// pixels of a block (48 degrees of freedom), the oracle's from its samples. False alarms: a block's |t| of 48 degrees
// passes 6 with probability 2.4e-7, the picture's |z| passes 4.5 with 7e-6; all scenes together (16 scenes of 16 blocks
// and 3 channels: 768 and 48 figures) by chance once in 1900 choices of seeds. Seeds are fixed, so a passing test stays
// passing. Smallest visible bias: each scene must have enough samples that a bias of the stated fraction of the
// picture's Y stands two standard errors beyond the alarm, that is, is noticed with probability 0.977.
#pragma once
#include <gtest/gtest.h>

#include <cmath>

#include "tests/reference_path.h"
#include "tests/systems/support/scene_builder.h"

namespace metamer {

struct Estimate {
  double film = 0, oracle = 0, variance = 0;
  double z() const { return variance > 0 ? (film - oracle) / std::sqrt(variance) : (film == oracle ? 0 : INFINITY); }
};

inline Estimate estimate(const Film& film, const std::vector<ReferencePixel>& oracle, uint32_t x0, uint32_t y0,
                         uint32_t side, size_t channel) {
  Estimate e;
  const double n = double(side) * side;
  for (uint32_t y = y0; y < y0 + side; ++y)
    for (uint32_t x = x0; x < x0 + side; ++x) {
      const size_t pixel = size_t{y} * film.width() + x;
      e.film += mean_xyz(film, pixel)[channel] / n;
      e.oracle += oracle[pixel].mean_xyz[channel] / n;
      e.variance += (variance_of_mean_xyz(film, pixel)[channel] + oracle[pixel].variance_of_mean[channel]) / (n * n);
    }
  return e;
}

// Square pictures with sides of whole blocks. `visible_bias`: of the mean Y, as a fraction.
inline void expect_agreement(const World& world, uint32_t oracle_samples, double visible_bias) {
  constexpr double block_alarm = 6, picture_alarm = 4.5;
  const uint32_t side = world.settings.width;
  ASSERT_EQ(world.settings.height, side);
  ASSERT_EQ(side % 4, 0u);
  const Film film = render_film(world);
  EXPECT_EQ(film.invalid_samples(), 0u);
  const std::vector<ReferencePixel> oracle = reference_path(world, oracle_samples, 7);
  for (size_t c = 0; c < 3; ++c) {
    const Estimate whole = estimate(film, oracle, 0, 0, side, c);
    EXPECT_LT(std::abs(whole.z()), picture_alarm)
        << "channel " << c << ": " << whole.film << " against " << whole.oracle;
    if (c == 1) {
      EXPECT_GT(whole.oracle, 0);
      EXPECT_LT((picture_alarm + 2) * std::sqrt(whole.variance), visible_bias * whole.oracle) << "too few samples";
    }
    for (uint32_t y = 0; y < side; y += 4)
      for (uint32_t x = 0; x < side; x += 4) {
        const Estimate block = estimate(film, oracle, x, y, 4, c);
        EXPECT_LT(std::abs(block.z()), block_alarm)
            << "channel " << c << ", block at " << x << ", " << y << ": " << block.film << " against " << block.oracle;
      }
  }
}

}  // namespace metamer
