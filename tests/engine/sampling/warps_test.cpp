// The warps: uniform where they claim to be (chi-square of the scalar twins), SIMD equal to scalar within the
// stated error on every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/engine/sampling/warps_test.cpp"
#include "engine/sampling/warps.h"

#include <gtest/gtest.h>
#include <hwy/foreach_target.h>

#include <cmath>
#include <random>
#include <vector>

#include "engine/sampling/points.h"
#include "engine/sampling/warps-inl.h"
#include "engine/simd/column.h"
#include "tests/support/chi_square.h"
#include "tests/support/each_target.h"

#ifndef METAMER_TESTS_ENGINE_SAMPLING_WARPS_TEST_ONCE
#define METAMER_TESTS_ENGINE_SAMPLING_WARPS_TEST_ONCE
namespace metamer {
enum class Warp { disk, hemisphere, triangle, sphere, cone };
struct WarpColumns {
  explicit WarpColumns(size_t n) : u(n), v(n), parameter(n), x(n), y(n), z(n), pdf(n) {}
  Column<float> u, v, parameter, x, y, z, pdf;
};
}  // namespace metamer
#endif

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

Vec3 apply(Warp warp, VF u, VF v, VF parameter, VF* pdf) {
  *pdf = splat(0.0f);
  switch (warp) {
    case Warp::disk: {
      const Point2V p = sample_concentric_disk(u, v);
      return {p.x, p.y, *pdf};
    }
    case Warp::hemisphere: {
      const Vec3 p = sample_cosine_hemisphere(u, v);
      *pdf = cosine_hemisphere_pdf(p.z);
      return p;
    }
    case Warp::triangle: {
      const BarycentricV b = sample_uniform_triangle(u, v);
      return {b.b0, b.b1, b.b2};
    }
    case Warp::sphere: *pdf = splat(uniform_sphere_pdf); return sample_uniform_sphere(u, v);
    case Warp::cone: break;
  }
  *pdf = uniform_cone_pdf(parameter);
  return sample_uniform_cone(u, v, parameter);
}

void warp_columns(Warp warp, WarpColumns* c) {
  const FloatTag d;
  for (size_t i = 0; i < c->u.size(); i += hn::Lanes(d)) {
    VF pdf;
    const Vec3 p = apply(warp, hn::Load(d, c->u.data() + i), hn::Load(d, c->v.data() + i),
                         hn::Load(d, c->parameter.data() + i), &pdf);
    hn::Store(p.x, d, c->x.data() + i);
    hn::Store(p.y, d, c->y.data() + i);
    hn::Store(p.z, d, c->z.data() + i);
    hn::Store(pdf, d, c->pdf.data() + i);
  }
}

// Cones about an arbitrary axis; and 1 - cos from the squared sine.
void cone_columns(const float axis[3], WarpColumns* c) {
  const FloatTag d;
  const Frame frame = make_frame({splat(axis[0]), splat(axis[1]), splat(axis[2])});
  for (size_t i = 0; i < c->u.size(); i += hn::Lanes(d)) {
    const VF parameter = hn::Load(d, c->parameter.data() + i);
    const Vec3 p = sample_uniform_cone(frame, hn::Load(d, c->u.data() + i), hn::Load(d, c->v.data() + i), parameter);
    hn::Store(p.x, d, c->x.data() + i);
    hn::Store(p.y, d, c->y.data() + i);
    hn::Store(p.z, d, c->z.data() + i);
    hn::Store(one_minus_cos(parameter), d, c->pdf.data() + i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(warp_columns);
HWY_EXPORT(cone_columns);
namespace {

using warps::pi;

WarpColumns random_columns(size_t n, double parameter_low, double parameter_high) {
  WarpColumns c(n);
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (size_t i = 0; i < n; ++i) {
    c.u[i] = unit_float(static_cast<uint32_t>(rng()));
    c.v[i] = unit_float(static_cast<uint32_t>(rng()));
    c.parameter[i] = static_cast<float>(parameter_low * std::pow(parameter_high / parameter_low, unit(rng)));
  }
  // Corners, edges and the centre.
  const float special[5] = {0, 0.25f, 0.5f, 0.75f, 0x1.fffffep-1f};
  for (size_t i = 0; i < 25; ++i) c.u[i] = special[i / 5], c.v[i] = special[i % 5];
  return c;
}

PointD3 scalar_twin(Warp warp, double u, double v, double parameter) {
  switch (warp) {
    case Warp::disk: {
      const PointD2 p = warps::concentric_disk(u, v);
      return {p.x, p.y, 0};
    }
    case Warp::hemisphere: return warps::cosine_hemisphere(u, v);
    case Warp::triangle: {
      const Barycentric b = warps::uniform_triangle(u, v);
      return {b.b0, b.b1, b.b2};
    }
    case Warp::sphere: return warps::uniform_sphere(u, v);
    case Warp::cone: break;
  }
  return warps::uniform_cone(u, v, parameter);
}

TEST(Warps, VectorsAgreeWithTheirScalarTwins) {
  WarpColumns c = random_columns(size_t{1} << 15, 1e-12, 2);
  for (const Warp warp : {Warp::disk, Warp::hemisphere, Warp::triangle, Warp::sphere, Warp::cone}) {
    for_each_target([&] {
      HWY_DYNAMIC_DISPATCH(warp_columns)(warp, &c);
      double worst = 0;
      for (size_t i = 0; i < c.u.size(); ++i) {
        const double parameter = c.parameter[i];
        const PointD3 p = scalar_twin(warp, c.u[i], c.v[i], parameter);
        const double radius = warp == Warp::cone ? std::sqrt(std::min(1.0, 2 * parameter)) : 1;
        worst = std::max(
            {worst, std::fabs(c.x[i] - p.x) / radius, std::fabs(c.y[i] - p.y) / radius, std::fabs(c.z[i] - p.z)});
      }
      EXPECT_LE(worst, 5e-7) << "warp " << static_cast<int>(warp);
      EXPECT_GT(worst, 1e-8) << "a float cannot be that exact: was it computed at all?";
    });
  }
}

TEST(Warps, PdfsAgreeWithTheirScalarTwins) {
  WarpColumns c = random_columns(4096, 1e-12, 2);
  for_each_target([&] {
    HWY_DYNAMIC_DISPATCH(warp_columns)(Warp::hemisphere, &c);
    for (size_t i = 0; i < c.u.size(); ++i) {
      ASSERT_NEAR(c.pdf[i], warps::cosine_hemisphere_pdf(c.z[i]), 3e-7 * c.pdf[i]);
    }
    HWY_DYNAMIC_DISPATCH(warp_columns)(Warp::cone, &c);
    for (size_t i = 0; i < c.u.size(); ++i) {
      ASSERT_NEAR(c.pdf[i] / warps::uniform_cone_pdf(c.parameter[i]), 1, 3e-7);
    }
    HWY_DYNAMIC_DISPATCH(warp_columns)(Warp::sphere, &c);
    EXPECT_NEAR(c.pdf[0] / warps::uniform_sphere_pdf, 1, 3e-7);
    EXPECT_EQ(warps::cosine_hemisphere_pdf(-0.5), 0);
  });
}

TEST(Warps, ConesKeepTheirAxisAndTheirAngleHoweverSmall) {
  const float axis[3] = {0.48f, -0.6f, 0.64f};
  WarpColumns c = random_columns(4096, 1e-12, 0.9);
  for_each_target([&] {
    HWY_DYNAMIC_DISPATCH(cone_columns)(axis, &c);
    for (size_t i = 0; i < c.u.size(); ++i) {
      const double dot = c.x[i] * 0.48 - c.y[i] * 0.6 + c.z[i] * 0.64;
      ASSERT_GE(dot, 1 - c.parameter[i] - 5e-7);
      const double p = c.parameter[i];
      ASSERT_NEAR(c.pdf[i] / warps::one_minus_cos(p), 1, 3e-7);
      ASSERT_NEAR(c.pdf[i] / (p / (1 + std::sqrt(1 - p))), 1, 3e-7);
    }
  });
  // A cone as small as the sun's seen from Pluto: the radius is still right.
  const PointD3 edge = warps::uniform_cone(1, 0, warps::one_minus_cos(1e-10));
  EXPECT_NEAR(edge.x, 1e-5, 1e-15);
}

// Points of the low-discrepancy sequence would be too even for the test; independent ones are drawn.
template <class Add>
void draw(size_t n, const Add& add) {
  std::mt19937_64 rng(12);
  std::uniform_real_distribution<double> unit(0, 1);
  for (size_t i = 0; i < n; ++i) {
    const double u = unit(rng), v = unit(rng);
    add(u, v);
  }
}

constexpr size_t draws = 400000;

TEST(Warps, DirectionsFollowTheirPdf) {
  DirectionHistogram hemisphere, sphere, cone;
  const double one_minus_cos_max = 0.3;
  draw(draws, [&](double u, double v) {
    const PointD3 h = warps::cosine_hemisphere(u, v), s = warps::uniform_sphere(u, v);
    const PointD3 c = warps::uniform_cone(u, v, one_minus_cos_max);
    hemisphere.add(h.x, h.y, h.z);
    sphere.add(s.x, s.y, s.z);
    cone.add(c.x, c.y, c.z);
    ASSERT_NEAR(h.x * h.x + h.y * h.y + h.z * h.z, 1, 1e-14);
    ASSERT_NEAR(s.x * s.x + s.y * s.y + s.z * s.z, 1, 1e-14);
    ASSERT_NEAR(c.x * c.x + c.y * c.y + c.z * c.z, 1, 1e-14);
  });
  const auto hemisphere_pdf = [](double, double, double z) { return warps::cosine_hemisphere_pdf(z); };
  EXPECT_GT(hemisphere.test(hemisphere_pdf).p_value, chi_square_level);
  EXPECT_GT(sphere.test([](double, double, double) { return warps::uniform_sphere_pdf; }).p_value, chi_square_level);
  const auto cone_pdf = [&](double, double, double z) {
    return z > 1 - one_minus_cos_max ? warps::uniform_cone_pdf(one_minus_cos_max) : 0;
  };
  EXPECT_GT(cone.test(cone_pdf, 40).p_value, chi_square_level);
  EXPECT_LT(hemisphere.test([](double, double, double z) { return z > 0 ? 1 / (2 * pi) : 0; }).p_value, 1e-9);
}

// Bins of equal area by construction: annuli of equal r^2, equal angles.
TEST(Warps, TheDiskIsUniformAndTheMapContinuous) {
  std::vector<double> observed(20 * 24, 0), expected(20 * 24, draws / (20.0 * 24.0));
  draw(draws, [&](double u, double v) {
    const PointD2 p = warps::concentric_disk(u, v);
    const double r2 = p.x * p.x + p.y * p.y, phi = std::atan2(p.y, p.x) / (2 * pi) + 0.5;
    observed[static_cast<size_t>(r2 * 20) * 24 + std::min<size_t>(23, static_cast<size_t>(phi * 24))] += 1;
    const PointD2 q = warps::concentric_disk(u + 1e-6, v), w = warps::concentric_disk(u, v + 1e-6);
    ASSERT_LT(std::hypot(q.x - p.x, q.y - p.y), 4e-6);
    ASSERT_LT(std::hypot(w.x - p.x, w.y - p.y), 4e-6);
  });
  EXPECT_GT(chi_square_test(observed, expected).p_value, chi_square_level);
}

// (1 - b0)^2 is uniform on a triangle, and b1 / (1 - b0) too, independently.
TEST(Warps, TheTriangleIsUniformAndCoveredToItsCorners) {
  std::vector<double> observed(20 * 20, 0), expected(20 * 20, draws / 400.0);
  draw(draws, [&](double u, double v) {
    const Barycentric b = warps::uniform_triangle(u, v);
    ASSERT_TRUE(b.b0 >= 0 && b.b1 >= 0 && b.b2 >= -1e-16);
    const double a = (1 - b.b0) * (1 - b.b0), c = b.b1 / (1 - b.b0);
    observed[static_cast<size_t>(a * 20) * 20 + std::min<size_t>(19, static_cast<size_t>(c * 20))] += 1;
  });
  EXPECT_GT(chi_square_test(observed, expected).p_value, chi_square_level);
  EXPECT_EQ(warps::uniform_triangle(1, 0).b0, 1);
  EXPECT_EQ(warps::uniform_triangle(0, 1).b1, 1);
  EXPECT_EQ(warps::uniform_triangle(0, 0).b2, 1);
}

}  // namespace
}  // namespace metamer
#endif
