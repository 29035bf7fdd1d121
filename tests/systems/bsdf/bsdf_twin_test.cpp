// Every BSDF kernel against its scalar double twin on random arguments, on every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "systems/bsdf/reference.h"
#include "tests/support/each_target.h"
#include "tests/systems/bsdf/cases.h"
#include "tests/systems/support/bsdf_kernels.h"

namespace metamer::testing {
namespace {
using reference::Direction;

double relative(double a, double b) { return a == b ? 0 : std::abs(a - b) / std::max(std::abs(b), 1e-30); }

TEST(BsdfTwin, DiffuseStaysWithinItsStatedError) {
  const std::vector<BsdfCase> cases = random_metals(100000);
  for_each_target([&] {
    const std::vector<BsdfResult> values = run_eval_diffuse(cases), samples = run_sample_diffuse(cases);
    double value_error = 0, direction_error = 0, pdf_error = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
      const BsdfCase& c = cases[i];
      const reference::BsdfValue value = reference::eval_diffuse(direction(c.wo), spectrum(c.albedo), direction(c.wi));
      const reference::BsdfSample sample = reference::sample_diffuse(direction(c.wo), spectrum(c.albedo), c.u, c.v);
      value_error = std::max(value_error, relative(values[i].pdf, value.pdf));
      for (size_t j = 0; j < 4; ++j) {
        value_error = std::max(value_error, relative(values[i].value[j], value.f_cos[j]));
        EXPECT_EQ(samples[i].value[j], samples[i].pdf > 0 ? c.albedo[j] : 0.0f);
      }
      const Direction wi = direction(samples[i].wi);
      direction_error = std::max(
          {direction_error, std::abs(wi.x - sample.wi.x), std::abs(wi.y - sample.wi.y), std::abs(wi.z - sample.wi.z)});
      pdf_error = std::max(pdf_error, std::abs(samples[i].pdf - sample.pdf));
    }
    EXPECT_LT(value_error, 4e-7);
    EXPECT_LT(direction_error, 1e-6);
    EXPECT_LT(pdf_error, 1e-6);
  });
}

TEST(BsdfTwin, ConductorEvaluationStaysWithinItsStatedError) {
  const std::vector<BsdfCase> cases = random_metals(300000);
  for_each_target([&] {
    const std::vector<BsdfResult> values = run_eval_conductor(cases);
    double f_error = 0, pdf_error = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
      const BsdfCase& c = cases[i];
      const reference::BsdfValue value =
          reference::eval_conductor(direction(c.wo), roughness(c), metal(c), direction(c.wi));
      for (size_t j = 0; j < 4; ++j) f_error = std::max(f_error, relative(values[i].value[j], value.f_cos[j]));
      pdf_error = std::max(pdf_error, relative(values[i].pdf, value.pdf));
    }
    EXPECT_LT(f_error, 2e-5);
    EXPECT_LT(pdf_error, 2e-5);
  });
}

TEST(BsdfTwin, ConductorSamplesStayWithinTheirStatedError) {
  const std::vector<BsdfCase> cases = random_metals(300000);
  for_each_target([&] {
    const std::vector<BsdfResult> samples = run_sample_conductor(cases);
    double direction_error = 0, weight_error = 0, pdf_error = 0;
    size_t void_mismatches = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
      const BsdfCase& c = cases[i];
      const reference::BsdfSample sample =
          reference::sample_conductor(direction(c.wo), roughness(c), metal(c), c.u, c.v);
      EXPECT_EQ(samples[i].delta == 1, sample.delta);
      const Direction wi = direction(samples[i].wi);
      direction_error = std::max(
          {direction_error, std::abs(wi.x - sample.wi.x), std::abs(wi.y - sample.wi.y), std::abs(wi.z - sample.wi.z)});
      // A draw at the horizon may fall to either side of it.
      if ((samples[i].pdf > 0) != (sample.pdf > 0)) {
        ++void_mismatches;
        EXPECT_LT(std::abs(wi.z), 1e-5);
        continue;
      }
      for (size_t j = 0; j < 4; ++j) {
        weight_error = std::max(weight_error, std::abs(samples[i].value[j] - sample.weight[j]));
      }
      pdf_error = std::max(pdf_error, relative(samples[i].pdf, sample.pdf));
    }
    EXPECT_LT(direction_error, 3e-5);
    EXPECT_LT(weight_error, 5e-5);
    EXPECT_LT(pdf_error, 1e-4);
    EXPECT_LT(void_mismatches, 5u);
  });
}

TEST(BsdfTwin, DielectricSamplesStayWithinTheirStatedError) {
  Random random(6);
  std::vector<BsdfCase> cases = random_metals(300000);
  for (BsdfCase& c : cases) {
    c.dispersive = random.uniform() < 0.5f ? 1 : 0;
    c.eta[0] = std::pow(2.5f, 2 * random.uniform() - 1);
    for (int j = 1; j < 4; ++j) c.eta[j] = c.eta[0] * (1 + 0.1f * random.uniform());
  }
  for_each_target([&] {
    const std::vector<BsdfResult> samples = run_sample_dielectric(cases);
    double direction_error = 0, weight_error = 0, probability_error = 0;
    size_t lobe_mismatches = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
      const BsdfCase& c = cases[i];
      const auto near_critical = [&](float eta) {
        const double relative_eta = c.wo[2] > 0 ? eta : 1.0 / eta, cos_theta = c.wo[2];
        return std::abs(relative_eta * relative_eta - 1 + cos_theta * cos_theta) < 1e-3;
      };
      if (std::any_of(c.eta, c.eta + 4, near_critical)) continue;
      const reference::BsdfSample sample =
          reference::sample_dielectric(direction(c.wo), {spectrum(c.eta), c.schlick == 1, c.dispersive == 1}, c.u);
      if ((samples[i].transmitted == 1) != sample.transmitted) {  // u within rounding of the probability
        ++lobe_mismatches;
        continue;
      }
      EXPECT_EQ(samples[i].terminate_secondary == 1, sample.terminate_secondary);
      const Direction wi = direction(samples[i].wi);
      direction_error = std::max(
          {direction_error, std::abs(wi.x - sample.wi.x), std::abs(wi.y - sample.wi.y), std::abs(wi.z - sample.wi.z)});
      for (size_t j = 0; j < 4; ++j) {
        weight_error = std::max(weight_error, std::abs(samples[i].value[j] - sample.weight[j]));
      }
      probability_error = std::max(probability_error, std::abs(samples[i].pdf - sample.pdf));
    }
    EXPECT_LT(direction_error, 1e-5);
    EXPECT_LT(weight_error, 2e-4);
    EXPECT_LT(probability_error, 2e-5);
    EXPECT_LT(lobe_mismatches, 10u);
  });
}

}  // namespace
}  // namespace metamer::testing
