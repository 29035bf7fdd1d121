// Fresnel reflectances against published values and against their double twins on every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "systems/bsdf/limits.h"
#include "systems/bsdf/reference.h"
#include "tests/support/each_target.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/systems/bsdf/fresnel_test.cpp"
#include "hwy/foreach_target.h"
//
#include "hwy/highway.h"
#include "systems/bsdf/fresnel-inl.h"

namespace metamer::testing {
// Rows of one boundary each; kappa is 0 for dielectrics.
#ifndef METAMER_FRESNEL_ROW
#define METAMER_FRESNEL_ROW
struct FresnelRow {
  float n, kappa, cos_theta_i;
  float exact, schlick, cos_theta_t, total;
};
#endif
}  // namespace metamer::testing

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {
template <class Kernel>
void for_each_vector(std::vector<testing::FresnelRow>& rows, Kernel kernel) {
  const FloatTag d;
  const size_t lanes = hn::Lanes(d);
  alignas(64) float n[16], kappa[16], c[16], out[4][16];
  for (size_t first = 0; first < rows.size(); first += lanes) {
    for (size_t lane = 0; lane < lanes; ++lane) {
      const auto& row = rows[std::min(first + lane, rows.size() - 1)];
      n[lane] = row.n, kappa[lane] = row.kappa, c[lane] = row.cos_theta_i;
    }
    kernel(hn::Load(d, n), hn::Load(d, kappa), hn::Load(d, c), out);
    for (size_t lane = 0; lane < lanes && first + lane < rows.size(); ++lane) {
      auto& row = rows[first + lane];
      row.exact = out[0][lane], row.schlick = out[1][lane], row.cos_theta_t = out[2][lane], row.total = out[3][lane];
    }
  }
}

void FresnelDielectrics(std::vector<testing::FresnelRow>& rows) {
  for_each_vector(rows, [](VF n, VF, VF c, float out[4][16]) {
    const FloatTag d;
    const VF inv_n = hn::Div(splat(1.0f), n);
    const DielectricBoundary exact = fresnel_dielectric(n, inv_n, c);
    hn::Store(exact.reflectance, d, out[0]);
    hn::Store(schlick_dielectric(n, inv_n, c).reflectance, d, out[1]);
    hn::Store(exact.cos_theta_t, d, out[2]);
    hn::Store(hn::IfThenElseZero(exact.total, splat(1.0f)), d, out[3]);
  });
}
void FresnelConductors(std::vector<testing::FresnelRow>& rows) {
  for_each_vector(rows, [](VF n, VF kappa, VF c, float out[4][16]) {
    const FloatTag d;
    hn::Store(fresnel_conductor(n, kappa, c), d, out[0]);
    hn::Store(schlick_conductor(n, kappa, c), d, out[1]);
    hn::Store(hn::Zero(d), d, out[2]);
    hn::Store(hn::Zero(d), d, out[3]);
  });
}
// Deviations of the SIMD vectors from the reference ones: {reflect, refract}, for unit v against unit n in any frame.
void DirectionErrors(double errors[2]) {
  const FloatTag d;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1, 1);
  errors[0] = errors[1] = 0;
  for (int k = 0; k < 20000; ++k) {
    const auto unit = [&] { return reference::normalize({uniform(random), uniform(random), uniform(random)}); };
    const reference::Direction n64 = unit();
    reference::Direction v64 = unit();
    if (reference::dot(v64, n64) > 0) v64 = {-v64.x, -v64.y, -v64.z};
    const float eta = 1.7f + 1.3f * uniform(random);
    const auto narrow = [](const reference::Direction& w) {
      return Vec3{splat(float(w.x)), splat(float(w.y)), splat(float(w.z))};
    };
    const auto distance = [&](const Vec3& a, const reference::Direction& b) {
      return std::max(
          {std::abs(hn::GetLane(a.x) - b.x), std::abs(hn::GetLane(a.y) - b.y), std::abs(hn::GetLane(a.z) - b.z)});
    };
    const Vec3 v = narrow(v64), n = narrow(n64);
    errors[0] = std::max(errors[0], distance(reflect(v, n), reference::reflect(v64, n64)));
    const VF inv_eta = hn::Div(splat(1.0f), splat(eta));
    const VF cos_alpha = hn::Neg(dot(v, n));
    const DielectricBoundary boundary = fresnel_dielectric(splat(eta), inv_eta, cos_alpha);
    reference::Direction t;
    const bool refracted = reference::refract(v64, n64, double{eta}, t);
    // Within rounding of the critical angle either answer is right.
    if (reference::cos_transmitted(double{eta}, -reference::dot(v64, n64)) < 1e-2) continue;
    const bool simd_total = !hn::AllFalse(d, boundary.total);
    if (simd_total == refracted) errors[1] = 1;
    if (refracted) errors[1] = std::max(errors[1], distance(refract(v, n, inv_eta, boundary.cos_theta_t), t));
  }
}
}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(FresnelDielectrics);
HWY_EXPORT(FresnelConductors);
HWY_EXPORT(DirectionErrors);

namespace testing {
namespace {
constexpr double degree = std::numbers::pi / 180;

FresnelRow dielectric(float eta, double cos_theta_i) {
  std::vector<FresnelRow> rows = {{eta, 0, float(cos_theta_i), 0, 0, 0, 0}};
  HWY_DYNAMIC_DISPATCH(FresnelDielectrics)(rows);
  return rows[0];
}
FresnelRow conductor(float n, float kappa, double cos_theta_i) {
  std::vector<FresnelRow> rows = {{n, kappa, float(cos_theta_i), 0, 0, 0, 0}};
  HWY_DYNAMIC_DISPATCH(FresnelConductors)(rows);
  return rows[0];
}

TEST(Fresnel, GlassReflectsFourPercentAtNormalIncidence) {
  for_each_target([] {
    EXPECT_NEAR(dielectric(1.5f, 1).exact, 0.04, 1e-7);
    EXPECT_NEAR(dielectric(1 / 1.5f, 1).exact, 0.04, 1e-7);
    EXPECT_NEAR(dielectric(1.5f, 1).schlick, 0.04, 1e-7);
  });
  EXPECT_NEAR(reference::fresnel_dielectric(1.5, 1), 0.04, 1e-15);
}

// Hecht, Optics (5th ed.), section 4.6.2: tan(theta_p) = n_t / n_i, 56.3 degrees for glass in air, where r_parallel =
// 0.
TEST(Fresnel, AtBrewstersAngleOnlyTheSTermIsLeft) {
  const double brewster = std::atan(1.5);
  EXPECT_NEAR(brewster / degree, 56.31, 0.005);
  const reference::Polarised r = reference::fresnel_dielectric_polarised(1.5, std::cos(brewster));
  EXPECT_NEAR(r.p, 0, 1e-15);
  // There r_s = (1 - n^2) / (1 + n^2), from tan(theta_i) = n in the Fresnel equations.
  const double r_s = (1 - 2.25) / (1 + 2.25);
  EXPECT_NEAR(r.s, r_s * r_s, 1e-15);
  for_each_target([&] { EXPECT_NEAR(dielectric(1.5f, std::cos(brewster)).exact, r_s * r_s / 2, 2e-7); });
}

// Hecht, Optics, table 4.2: the critical angle of n = 1.50 is 41.8103 degrees.
TEST(Fresnel, ReflectionIsTotalBeyondTheCriticalAngleAndOnlyThere) {
  EXPECT_NEAR(std::asin(1 / 1.5) / degree, 41.8103, 5e-5);
  for_each_target([] {
    const float eta = 1 / 1.5f;
    for (double above = 0.01; above < 48; above += 0.5) {
      const FresnelRow row = dielectric(eta, std::cos((41.8103 + above) * degree));
      EXPECT_EQ(row.exact, 1.0f);
      EXPECT_EQ(row.schlick, 1.0f);
      EXPECT_EQ(row.total, 1.0f);
      EXPECT_EQ(row.cos_theta_t, 0.0f);
    }
    for (double below = 0.01; below < 41.8; below += 0.5) {
      const FresnelRow row = dielectric(eta, std::cos((41.8103 - below) * degree));
      EXPECT_LT(row.exact, 1.0f);
      EXPECT_LT(row.schlick, 1.0f);
      EXPECT_EQ(row.total, 0.0f);
      EXPECT_GT(row.cos_theta_t, 0.0f);
    }
  });
}

// n and kappa: P. B. Johnson and R. W. Christy, Phys. Rev. B 6, 4370 (1972), at measured wavelengths. Reflectances from
// ((n-1)^2 + kappa^2) / ((n+1)^2 + kappa^2) by hand.
TEST(Fresnel, GoldAndCopperAtNormalIncidenceAreThePublishedMetals) {
  struct Metal {
    const char* name;
    float n, kappa;
    double reflectance;
  };
  const Metal metals[] = {
      {"gold, 450.9 nm", 1.38f, 1.914f, 0.40822},   {"gold, 548.6 nm", 0.43f, 2.455f, 0.78692},
      {"gold, 616.8 nm", 0.21f, 3.272f, 0.93098},   {"copper, 450.9 nm", 1.24f, 2.397f, 0.53917},
      {"copper, 548.6 nm", 1.02f, 2.577f, 0.61945}, {"copper, 616.8 nm", 0.3f, 3.205f, 0.89968},
  };
  for_each_target([&] {
    for (const Metal& m : metals) {
      EXPECT_NEAR(conductor(m.n, m.kappa, 1).exact, m.reflectance, 5e-5) << m.name;
      EXPECT_NEAR(conductor(m.n, m.kappa, 1).schlick, m.reflectance, 5e-5) << m.name;
    }
  });
}

TEST(Fresnel, GrazingIncidenceReflectsEverything) {
  for_each_target([] {
    for (const float eta : {0.4f, 0.75f, 1.00001f, 1.33f, 1.5f, 2.4f, 10.0f}) {
      EXPECT_EQ(dielectric(eta, 0).exact, 1.0f) << eta;
      EXPECT_NEAR(dielectric(eta, 1e-7).exact, 1.0, eta == 1.00001f ? 1e-3 : 1e-5) << eta;
    }
    for (const float kappa : {0.0f, 1e-6f, 0.1f, 3.0f, 1e4f, 1e8f}) {
      EXPECT_NEAR(conductor(0.2f, kappa, 0).exact, 1, 2e-7) << kappa;
      EXPECT_NEAR(conductor(2.4f, kappa, 0).exact, 1, 2e-7) << kappa;
    }
  });
}

TEST(Fresnel, AMediumThatIsNotThereReflectsNothing) {
  for_each_target([] {
    for (const double c : {0.0, 1e-6, 0.3, 1.0}) {
      EXPECT_EQ(dielectric(1, c).exact, 0.0f) << c;
      EXPECT_NEAR(conductor(1, 0, c).exact, 0, 1e-12) << c;
    }
    EXPECT_NEAR(dielectric(1, 0.3).cos_theta_t, 0.3, 1e-7);
  });
}

TEST(Fresnel, APerfectConductorReflectsExactlyEverything) {
  for_each_target([] {
    for (const double c : {0.0, 0.01, 0.5, 1.0}) EXPECT_EQ(conductor(1, 1e8f, c).exact, 1.0f) << c;
  });
}

TEST(Fresnel, BothSidesOfABoundaryReflectTheSame) {
  for_each_target([] {
    for (const float eta : {1.1f, 1.5f, 2.4f}) {
      for (int k = 1; k <= 100; ++k) {
        const FresnelRow outside = dielectric(eta, k * 0.01);
        const FresnelRow inside = dielectric(1 / eta, outside.cos_theta_t);
        EXPECT_NEAR(outside.exact, inside.exact, 5e-5) << eta << " " << k;
        EXPECT_NEAR(outside.schlick, inside.schlick, 5e-5) << eta << " " << k;
        EXPECT_NEAR(inside.cos_theta_t, outside.cos_theta_i, 2e-5);
      }
    }
  });
}

TEST(Fresnel, WithoutAbsorptionTheConductorIsTheDielectric) {
  for (const double n : {0.5, 0.9, 1.2, 1.5, 2.4}) {
    for (int k = 1; k <= 100; ++k) {
      EXPECT_NEAR(reference::fresnel_conductor(n, 0, k * 0.01), reference::fresnel_dielectric(n, k * 0.01), 1e-12);
      EXPECT_NEAR(reference::schlick_conductor(n, 0, k * 0.01), reference::schlick_dielectric(n, k * 0.01), 1e-12);
    }
  }
}

std::vector<FresnelRow> random_rows(bool metal, size_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<FresnelRow> rows(count);
  for (size_t i = 0; i < count; ++i) {
    const float logarithm = 2 * uniform(random) - 1;
    rows[i].n = metal ? 0.02f + 5 * uniform(random) : std::pow(3.0f, logarithm);
    // From barely absorbing to stronger than silver.
    rows[i].kappa = metal ? 0.001f * std::pow(1e4f, uniform(random)) : 0;
    const float c = uniform(random);
    rows[i].cos_theta_i = i % 3 == 0 ? c * c * c * c : c;  // a third near grazing
    if (i % 3 == 1 && rows[i].n < 1) {                     // a third around the critical angle
      const float critical = std::sqrt(1 - rows[i].n * rows[i].n);
      rows[i].cos_theta_i = std::min(1.0f, critical * (1 + 1e-3f * std::pow(2 * c - 1, 5.0f)));
    }
  }
  return rows;
}

TEST(Fresnel, DielectricKernelsStayWithinTheirStatedError) {
  for_each_target([] {
    std::vector<FresnelRow> rows = random_rows(false, 300000);
    HWY_DYNAMIC_DISPATCH(FresnelDielectrics)(rows);
    double error[2] = {0, 0}, schlick_error[2] = {0, 0}, cosine_error[2] = {0, 0};
    for (const FresnelRow& row : rows) {
      const double eta = row.n, c = row.cos_theta_i;
      const bool critical = std::abs((eta - 1) * (eta + 1) + c * c) < 1e-3;
      const auto worst = [&](double* of, double difference) {
        of[critical] = std::max(of[critical], std::abs(difference));
      };
      worst(error, row.exact - reference::fresnel_dielectric(eta, c));
      worst(schlick_error, row.schlick - reference::schlick_dielectric(eta, c));
      worst(cosine_error, row.cos_theta_t - reference::cos_transmitted(eta, c));
    }
    EXPECT_LT(error[0], 2e-5);
    EXPECT_LT(error[1], 8e-3);
    EXPECT_LT(schlick_error[0], 2e-5);
    EXPECT_LT(schlick_error[1], 8e-3);
    EXPECT_LT(cosine_error[0], 5e-6);
    EXPECT_LT(cosine_error[1], 1e-3);
  });
}

TEST(Fresnel, ConductorKernelsStayWithinTheirStatedError) {
  for_each_target([] {
    std::vector<FresnelRow> rows = random_rows(true, 300000);
    HWY_DYNAMIC_DISPATCH(FresnelConductors)(rows);
    double error[2] = {0, 0}, schlick_error[2] = {0, 0};
    for (const FresnelRow& row : rows) {
      const double n = row.n, kappa = row.kappa, c = row.cos_theta_i;
      const bool critical = n < 1 && kappa < refracting_kappa && std::abs((n - 1) * (n + 1) + c * c) < 1e-3;
      const auto worst = [&](double* of, double difference) {
        of[critical] = std::max(of[critical], std::abs(difference));
      };
      worst(error, row.exact - reference::fresnel_conductor(n, kappa, c));
      worst(schlick_error, row.schlick - reference::schlick_conductor(n, kappa, c));
    }
    EXPECT_LT(error[0], 2e-5);
    EXPECT_LT(error[1], 8e-3);
    EXPECT_LT(schlick_error[0], 2e-5);
    EXPECT_LT(schlick_error[1], 8e-3);
  });
}

TEST(Fresnel, ReflectedAndRefractedDirectionsMatchTheirTwins) {
  for_each_target([] {
    double errors[2];
    HWY_DYNAMIC_DISPATCH(DirectionErrors)(errors);
    EXPECT_LT(errors[0], 1e-6);
    EXPECT_LT(errors[1], 1e-4);
  });
}

// Snell's law: sin(alpha) = n sin(beta); glass at 30 degrees refracts to arcsin(1/3) = 19.47 degrees, in the plane.
TEST(Fresnel, RefractionObeysSnell) {
  const reference::Direction v = {std::sin(30 * degree), 0, -std::cos(30 * degree)};
  reference::Direction t;
  ASSERT_TRUE(reference::refract(v, {0, 0, 1}, 1.5, t));
  EXPECT_NEAR(std::asin(t.x) / degree, 19.4712, 1e-4);
  EXPECT_NEAR(t.y, 0, 1e-15);
  EXPECT_NEAR(reference::dot(t, t), 1, 1e-15);
  EXPECT_LT(t.z, 0);
  EXPECT_FALSE(reference::refract({std::sin(42 * degree), 0, -std::cos(42 * degree)}, {0, 0, 1}, 1 / 1.5, t));
}

}  // namespace
}  // namespace testing
}  // namespace metamer
#endif
