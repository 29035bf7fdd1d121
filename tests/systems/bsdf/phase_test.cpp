// The phase function: its kernels against their twin, the sampler against its density, what g means.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "systems/bsdf/reference.h"
#include "tests/support/chi_square.h"
#include "tests/support/each_target.h"
#include "tests/systems/bsdf/cases.h"
#include "tests/systems/support/bsdf_kernels.h"

namespace metamer::testing {
namespace {

constexpr float asymmetries[] = {0, 1e-7f, -1e-4f, 0.01f, 0.3f, -0.6f, 0.85f, -0.9f};

// A case's alpha_x is g, alpha_y and shininess are the second lobe's and its share; the cosine is wi[2].
std::vector<BsdfCase> random_phases(size_t count, float g, float g2 = 0, float g2_share = 0) {
  Random random(5);
  std::vector<BsdfCase> cases(count);
  for (BsdfCase& c : cases) {
    c.alpha_x = g, c.alpha_y = g2, c.shininess = g2_share;
    c.wi[2] = 2 * random.uniform() - 1;
    c.u = random.uniform(), c.v = random.uniform(), c.choice = random.uniform();
  }
  return cases;
}

TEST(Phase, StaysWithinItsStatedError) {
  for (const float g : asymmetries) {
    const std::vector<BsdfCase> cases = random_phases(20000, g);
    const double bound = 2e-6 / (1 - std::abs(double{g}));
    for_each_target([&] {
      const std::vector<BsdfResult> values = run_eval_phase(cases), samples = run_sample_phase(cases);
      for (size_t i = 0; i < cases.size(); ++i) {
        const double value = reference::eval_phase(cases[i].wi[2], g);
        ASSERT_NEAR(values[i].pdf, value, bound * value) << "g " << g << " cos " << cases[i].wi[2];
        const reference::Direction wi = reference::sample_phase(g, cases[i].u, cases[i].v);
        const float* got = samples[i].wi;
        // Where the lobe is narrow u is magnified.
        const double slack = 1e-5 / (1 - std::abs(double{g}));
        ASSERT_NEAR(got[2], wi.z, slack) << "g " << g << " u " << cases[i].u;
        ASSERT_NEAR(got[0] * got[0] + got[1] * got[1] + got[2] * got[2], 1, 1e-5);
        ASSERT_NEAR(samples[i].pdf, reference::eval_phase(got[2], g), bound * reference::eval_phase(got[2], g));
      }
    });
  }
}

TEST(Phase, IsDrawnByItsDensity) {
  for (const float g : asymmetries) {
    const std::vector<BsdfCase> cases = random_phases(200000, g);
    for_each_target([&] {
      DirectionHistogram histogram;
      for (const BsdfResult& draw : run_sample_phase(cases)) histogram.add(draw.wi[0], draw.wi[1], draw.wi[2]);
      const auto pdf = [&](double, double, double z) { return reference::eval_phase(z, g); };
      EXPECT_GT(histogram.test(pdf, 24).p_value, chi_square_level) << g;
    });
  }
}

constexpr float two_lobes[][3] = {{0.85f, -0.3f, 0.25f}, {0.2f, 0.9f, 0.5f}, {-0.6f, 0.5f, 1}, {0.4f, -0.9f, 0.03f}};

TEST(Phase, OfTwoLobesStaysWithinItsStatedError) {
  for (const auto& [g, g2, share] : two_lobes) {
    const std::vector<BsdfCase> cases = random_phases(20000, g, g2, share);
    const reference::PhaseLobes lobes{g, g2, share};
    const double bound = 2e-6 / (1 - std::max(std::abs(double{g}), std::abs(double{g2})));
    for_each_target([&] {
      const std::vector<BsdfResult> values = run_eval_phase(cases), samples = run_sample_phase(cases);
      for (size_t i = 0; i < cases.size(); ++i) {
        const double value = reference::eval_phase(cases[i].wi[2], lobes);
        ASSERT_NEAR(values[i].pdf, value, bound * value) << "g " << g << " cos " << cases[i].wi[2];
        const reference::Direction wi = reference::sample_phase(lobes, cases[i].choice, cases[i].u, cases[i].v);
        ASSERT_NEAR(samples[i].wi[2], wi.z, 5 * bound) << "g " << g << " u " << cases[i].u;
        const double there = reference::eval_phase(samples[i].wi[2], lobes);
        ASSERT_NEAR(samples[i].pdf, there, bound * there);
      }
    });
  }
}

TEST(Phase, OfTwoLobesIsDrawnByItsDensity) {
  for (const auto& [g, g2, share] : two_lobes) {
    const std::vector<BsdfCase> cases = random_phases(200000, g, g2, share);
    const reference::PhaseLobes lobes{g, g2, share};
    for_each_target([&] {
      DirectionHistogram histogram;
      for (const BsdfResult& draw : run_sample_phase(cases)) histogram.add(draw.wi[0], draw.wi[1], draw.wi[2]);
      const auto pdf = [&](double, double, double z) { return reference::eval_phase(z, lobes); };
      EXPECT_GT(histogram.test(pdf, 24).p_value, chi_square_level) << g;
    });
  }
}

// Henyey and Greenstein: the integral over the sphere is 1 and the mean cosine is g.
TEST(Phase, ScattersAllLightWithAMeanCosineOfG) {
  for (const double g : {-0.9, -0.4, 0.0, 0.2, 0.8}) {
    const auto integral = [&](auto&& weight) {
      double sum = 0;
      for (int k = 0; k < 256; ++k)  // narrow lobes are steep
        sum += integrate_rectangle([&](double z, double) { return weight(z) * reference::eval_phase(z, g); },
                                   -1 + k / 128.0, -1 + (k + 1) / 128.0, 0, 2 * std::numbers::pi, 2);
      return sum;
    };
    EXPECT_NEAR(integral([](double) { return 1.0; }), 1, 1e-6);
    EXPECT_NEAR(integral([](double z) { return z; }), g, 1e-6);
  }
  EXPECT_NEAR(reference::eval_phase(0.3, 0), 1 / (4 * std::numbers::pi), 1e-15);
}

}  // namespace
}  // namespace metamer::testing
