// Hair: the white furnace, the sampler against its density, kernels against the double twin, colours that come out as
// they were asked for. On every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/chi_square.h"
#include "tests/support/each_target.h"
#include "tests/systems/bsdf/cases.h"
#include "tests/systems/support/hair_kernels.h"

namespace metamer::testing {
namespace {
using reference::Direction;
constexpr double pi = std::numbers::pi;

reference::HairOptics hair_of(double beta_m, double beta_n, double tilt_deg = 2) {
  reference::HairOptics hair;
  hair.shape = hair_shape(beta_m, beta_n, tilt_deg);
  return hair;
}
std::vector<HairCase> random_cases(size_t count, double absorption) {
  Random random(31);
  std::vector<HairCase> cases(count);
  for (HairCase& c : cases) {
    random.direction(c.c.wo);
    random.direction(c.c.wi);
    c.c.choice = random.uniform(), c.c.u = random.uniform(), c.c.v = random.uniform();
    c.h = 1.98 * double{random.uniform()} - 0.99;
    for (float& sigma : c.c.kappa) sigma = static_cast<float>(absorption * double{random.uniform()});
  }
  return cases;
}

// Without absorption all light leaves again, wherever it met the fibre.
TEST(Hair, WithoutAbsorptionAllLightLeaves) {
  for (const double beta_m : {0.15, 0.4, 1.0})
    for (const double beta_n : {0.15, 0.5, 1.0})
      for (const double h : {-0.9, 0.0, 0.4}) {
        reference::HairOptics hair = hair_of(beta_m, beta_n);
        hair.h = h;
        const Direction wo = reference::normalize({0.5, 0.3, 0.8});
        const double albedo = integrate_rectangle(
            [&](double theta, double phi) {
              const Direction wi = {std::sin(theta), std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi)};
              return reference::eval_hair(wo, hair, wi).f_cos[0] * std::cos(theta);
            },
            -pi / 2, pi / 2, -pi, pi, 150);
        EXPECT_NEAR(albedo, 1, 2e-3) << beta_m << " " << beta_n << " " << h;
      }
}

TEST(Hair, DrawsOfWhiteHairWeighOne) {
  for (const auto& [beta_m, beta_n] : {std::pair{0.3, 0.3}, std::pair{0.1, 0.9}, std::pair{1.0, 0.2}}) {
    const std::vector<HairCase> cases = random_cases(50000, 0);
    for_each_target([&] {
      double sum = 0;
      for (const BsdfResult& draw : run_sample_hair(hair_of(beta_m, beta_n), cases)) {
        EXPECT_NEAR(draw.value[0], 1, 1e-3);
        sum += double{draw.value[0]} / double(cases.size());
      }
      EXPECT_NEAR(sum, 1, 1e-4);
    });
  }
}

TEST(Hair, DrawsItsPdf) {
  for (const auto& [beta_m, beta_n, h] :
       {std::tuple{0.3, 0.3, 0.3}, std::tuple{0.6, 0.9, -0.8}, std::tuple{1.0, 0.5, 0.0}}) {
    reference::HairOptics hair = hair_of(beta_m, beta_n);
    hair.h = h;
    hair.sigma_a = {0.2, 0.2, 0.2, 0.2};
    std::vector<HairCase> cases = random_cases(200000, 0);
    for (HairCase& c : cases) {
      const float wo[3] = {0.48f, 0.6f, 0.64f};
      std::copy_n(wo, 3, c.c.wo);
      std::fill_n(c.c.kappa, 4, 0.2f);
      c.h = h;
    }
    for_each_target([&] {
      DirectionHistogram histogram(24, 24);
      for (const BsdfResult& draw : run_sample_hair(hair, cases)) histogram.add(draw.wi[0], draw.wi[1], draw.wi[2]);
      const auto pdf = [&](double x, double y, double z) {
        return reference::eval_hair({0.48, 0.6, 0.64}, hair, {x, y, z}).pdf;
      };
      const ChiSquare result = histogram.test(pdf, 8);
      EXPECT_GT(result.p_value, chi_square_level) << beta_m << " " << beta_n << " " << h;
      EXPECT_GT(result.degrees_of_freedom, 50);
    });
  }
}

TEST(Hair, KernelsStayWithinTheirStatedErrors) {
  for (const auto& [beta_m, beta_n, tilt] :
       {std::tuple{0.3, 0.3, 2.0}, std::tuple{0.1, 0.1, 5.0}, std::tuple{0.9, 0.8, -3.0}}) {
    const reference::HairOptics hair = hair_of(beta_m, beta_n, tilt);
    const std::vector<HairCase> cases = random_cases(30000, 2);
    for_each_target([&] {
      const std::vector<BsdfResult> values = run_eval_hair(hair, cases), draws = run_sample_hair(hair, cases);
      double worst = 0, direction_error = 0;
      size_t elsewhere = 0;
      for (size_t i = 0; i < cases.size(); ++i) {
        reference::HairOptics o = hair;
        o.h = double{float(cases[i].h)};
        o.sigma_a = spectrum(cases[i].c.kappa);
        const Direction wo = direction(cases[i].c.wo);
        const reference::BsdfValue value = reference::eval_hair(wo, o, direction(cases[i].c.wi));
        for (size_t j = 0; j < 5; ++j) {
          const double got = j < 4 ? values[i].value[j] : values[i].pdf, wanted = j < 4 ? value.f_cos[j] : value.pdf;
          worst = std::max(worst, std::abs(got - wanted) / (1e-6 + 2e-4 * wanted));
        }
        const reference::BsdfSample sample =
            reference::sample_hair(wo, o, cases[i].c.choice, cases[i].c.u, cases[i].c.v);
        const Direction wi = direction(draws[i].wi);
        const double distance =
            std::max({std::abs(wi.x - sample.wi.x), std::abs(wi.y - sample.wi.y), std::abs(wi.z - sample.wi.z)});
        if (distance > 0.01) {
          ++elsewhere;  // the choice at the edge of its share
          continue;
        }
        direction_error = std::max(direction_error, distance);
      }
      EXPECT_LT(worst, 1) << beta_m << " " << beta_n;
      EXPECT_LT(direction_error, 1e-2);
      EXPECT_LT(elsewhere, 20u);
    });
  }
}

// Thicker pigment, darker hair; and light that goes through it is coloured more than what its surface reflects.
TEST(Hair, AbsorbsWhatPassesThroughIt) {
  reference::HairOptics clear = hair_of(0.3, 0.3), dark = clear;
  dark.sigma_a = {3, 3, 3, 3};
  const Direction wo = {0, 0, 1}, behind = {0, 0, -1}, before = {0, 0, 1};
  EXPECT_LT(reference::eval_hair(wo, dark, behind).f_cos[0], 0.01 * reference::eval_hair(wo, clear, behind).f_cos[0]);
  EXPECT_GT(reference::eval_hair(wo, dark, before).f_cos[0], 0.1 * reference::eval_hair(wo, clear, before).f_cos[0]);
}

// Chiang et al., equation 9, at beta_n = 0.3: the factor is 5.969 - 0.0645 + 0.22788 - 0.28971 + 0.04515 + 0.0006.
TEST(Hair, ReflectancesBecomeAbsorption) {
  EXPECT_NEAR(hair_absorption_of_reflectance(0.5, 0.3), std::pow(std::log(0.5) / 5.88842, 2), 1e-6);
  EXPECT_EQ(hair_absorption_of_reflectance(1, 0.3), 0);
}

// pbrt's variances and width for its default roughness: (0.726 0.3 + 0.812 0.09)^2 and sqrt(pi / 8) (0.0795 + 0.10746).
TEST(Hair, RoughnessBecomesVarianceAndWidth) {
  const HairShape shape = hair_shape(0.3, 0.3, 2);
  EXPECT_NEAR(shape.variance, std::pow(0.2178 + 0.07308, 2), 1e-8);
  EXPECT_NEAR(shape.width, std::sqrt(pi / 8) * 0.18696, 1e-8);
  EXPECT_NEAR(shape.sin_tilt[2], std::sin(8 * pi / 180), 1e-12);
}

}  // namespace
}  // namespace metamer::testing
