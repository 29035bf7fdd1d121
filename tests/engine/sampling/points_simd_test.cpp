// The SIMD points and hashes against their scalar twins: equal bits on every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/engine/sampling/points_simd_test.cpp"
#include <gtest/gtest.h>
#include <hwy/foreach_target.h>

#include <random>
#include <vector>

#include "engine/sampling/points-inl.h"
#include "engine/sampling/points.h"
#include "engine/simd/column.h"
#include "tests/support/each_target.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

void hash_columns(const uint32_t* a, const uint32_t* b, size_t n, uint32_t* hashed, uint32_t* combined) {
  const UintTag d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    hn::Store(hash_u32(hn::Load(d, a + i)), d, hashed + i);
    hn::Store(hash_combine(hn::Load(d, a + i), hn::Load(d, b + i)), d, combined + i);
  }
}

void draw_columns(const uint32_t* x, const uint32_t* y, const uint32_t* sample, const uint32_t* dimension, size_t n,
                  uint32_t seed, float* one, float* u, float* v) {
  const UintTag d;
  const FloatTag f;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const PointKey key = make_point_key(hn::Load(d, x + i), hn::Load(d, y + i), hn::Load(d, sample + i), seed);
    const VU dims = hn::Load(d, dimension + i);
    VF us, vs;
    sample_2d(key, dims, &us, &vs);
    hn::Store(sample_1d(key, dims), f, one + i);
    hn::Store(us, f, u + i);
    hn::Store(vs, f, v + i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(hash_columns);
HWY_EXPORT(draw_columns);
namespace {

Column<uint32_t> random_column(std::mt19937& rng, size_t n, uint32_t mask) {
  Column<uint32_t> column(n);
  for (uint32_t& value : column) value = static_cast<uint32_t>(rng()) & mask;
  return column;
}

TEST(PointsSimd, HashesEqualTheScalarOnesInEveryLane) {
  std::mt19937 rng(1);
  const size_t n = 4096;
  const Column<uint32_t> a = random_column(rng, n, ~0u), b = random_column(rng, n, ~0u);
  for_each_target([&] {
    Column<uint32_t> hashed(n), combined(n);
    HWY_DYNAMIC_DISPATCH(hash_columns)(a.data(), b.data(), n, hashed.data(), combined.data());
    for (size_t i = 0; i < n; ++i) {
      ASSERT_EQ(hashed[i], hash_u32(a[i]));
      ASSERT_EQ(combined[i], hash_combine(a[i], b[i]));
    }
  });
}

TEST(PointsSimd, DrawsEqualTheScalarOnesWhenAllLanesDiffer) {
  std::mt19937 rng(2);
  const size_t n = 4096;
  const Column<uint32_t> x = random_column(rng, n, 0x1ffff), y = random_column(rng, n, 0x1ffff);
  const Column<uint32_t> sample = random_column(rng, n, ~0u), dimension = random_column(rng, n, 0xff);
  for (const uint32_t seed : {0u, 1u, 0xdeadbeefu}) {
    for_each_target([&] {
      Column<float> one(n), u(n), v(n);
      HWY_DYNAMIC_DISPATCH(draw_columns)
      (x.data(), y.data(), sample.data(), dimension.data(), n, seed, one.data(), u.data(), v.data());
      for (size_t i = 0; i < n; ++i) {
        const PointKeyScalar key = make_point_key(x[i], y[i], sample[i], seed);
        const Point2 expected = sample_2d(key, dimension[i]);
        ASSERT_EQ(one[i], sample_1d(key, dimension[i]));
        ASSERT_EQ(u[i], expected.u);
        ASSERT_EQ(v[i], expected.v);
      }
    });
  }
}

}  // namespace
}  // namespace metamer
#endif
