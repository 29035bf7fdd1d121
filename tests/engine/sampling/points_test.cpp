#include "engine/sampling/points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace metamer {
namespace {

PointKeyScalar key_of(uint32_t replicate, uint32_t index, uint32_t pixel = 7, uint32_t seed = 0) {
  return make_point_key(pixel, pixel + 3, index * replicate_count + replicate, seed);
}

TEST(Points, BitReversalAndPascalDigitsFollowTheirDefinitions) {
  for (uint32_t b = 0; b < 32; ++b) EXPECT_EQ(reverse_bits(1u << b), 1u << (31 - b));
  for (uint32_t j = 0; j < 32; ++j) {
    uint32_t row = 1;  // Pascal's triangle modulo 2, row j, by its recurrence
    for (uint32_t i = 0; i < j; ++i) row ^= row << 1;
    EXPECT_EQ(pascal_digits(1u << j), row) << j;
  }
}

TEST(Points, LaineKarrasPermutesAndLetsLowBitsInfluenceHigherOnesOnly) {
  for (uint32_t i = 0; i < 2000; ++i) {
    const uint32_t x = hash_u32(i), seed = hash_u32(~i);
    const uint32_t bit = i % 32;
    const uint32_t changed = laine_karras_permutation(x, seed) ^ laine_karras_permutation(x ^ (1u << bit), seed);
    ASSERT_EQ(changed & ((2u << bit) - 1u), 1u << bit);  // bit itself flips, nothing below it does
  }
}

// Every elementary interval of area 2^-m holds exactly one of the first 2^m points.
TEST(Points, EachReplicatesFirstPointsAreANetInEveryDimension) {
  for (uint32_t replicate = 0; replicate < replicate_count; ++replicate) {
    for (const uint32_t dimension : {0u, 1u, 2u, 17u, 1000003u}) {
      for (const uint32_t m : {0u, 1u, 2u, 3u, 6u, 10u, 13u}) {
        for (uint32_t split = 0; split <= m; ++split) {
          std::vector<uint8_t> hit(size_t{1} << m, 0);
          for (uint32_t i = 0; i < (1u << m); ++i) {
            const Point2 p = sample_2d(key_of(replicate, i), dimension);
            const auto column = static_cast<uint32_t>(std::ldexp(p.u, static_cast<int>(split)));
            const auto row = static_cast<uint32_t>(std::ldexp(p.v, static_cast<int>(m - split)));
            ASSERT_EQ(hit[(column << (m - split)) | row]++, 0) << "m " << m << " split " << split;
          }
        }
      }
    }
  }
}

TEST(Points, EachReplicatesFirstPointsFallOnePerStratumInOneDimension) {
  for (uint32_t replicate = 0; replicate < replicate_count; ++replicate) {
    for (const uint32_t dimension : {0u, 5u, 77u, 0xffffffffu}) {
      for (uint32_t m = 0; m <= 12; ++m) {
        std::vector<uint8_t> hit(size_t{1} << m, 0);
        for (uint32_t i = 0; i < (1u << m); ++i) {
          const float u = sample_1d(key_of(replicate, i), dimension);
          ASSERT_EQ(hit[static_cast<size_t>(std::ldexp(u, static_cast<int>(m)))]++, 0);
        }
      }
    }
  }
}

TEST(Points, AreAlwaysInTheHalfOpenUnitInterval) {
  EXPECT_LT(unit_float(0xffffffffu), 1.0f);
  EXPECT_EQ(unit_float(0), 0.0f);
  for (uint32_t i = 0; i < 100000; ++i) {
    const Point2 p = sample_2d(key_of(i % 4, i * 2654435761u >> 3, i), i);
    ASSERT_TRUE(p.u >= 0 && p.u < 1 && p.v >= 0 && p.v < 1);
  }
}

TEST(Points, ReplicatesAndPixelsHaveDistinctSeeds) {
  std::set<uint32_t> seeds;
  for (uint32_t y = 0; y < 200; ++y) {
    for (uint32_t x = 0; x < 200; ++x) seeds.insert(make_point_key(x, y, 0, 9).pixel_seed);
  }
  EXPECT_EQ(seeds.size(), 200u * 200u);
  for (uint32_t pixel = 0; pixel < 1000; ++pixel) {
    std::set<uint32_t> of_pixel;
    for (uint32_t r = 0; r < replicate_count; ++r) of_pixel.insert(key_of(r, 5, pixel).pixel_seed);
    ASSERT_EQ(of_pixel.size(), replicate_count);
  }
}

}  // namespace
}  // namespace metamer
