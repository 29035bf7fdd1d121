// The sheet that scatters evenly to both of its sides: values, the kernels against their twin and the sampler against
// its density, on every instruction set. Reciprocity: reciprocity_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/chi_square.h"
#include "tests/support/each_target.h"
#include "tests/systems/bsdf/cases.h"

namespace metamer::testing {
namespace {
using reference::Direction;
constexpr double pi = std::numbers::pi;

reference::SheetOptics sheet(const BsdfCase& c) { return {spectrum(c.albedo), spectrum(c.ks)}; }

std::vector<BsdfCase> random_sheets(size_t count) {
  Random random(77);
  std::vector<BsdfCase> cases = random_metals(count);
  for (BsdfCase& c : cases) {
    c.choice = random.uniform();
    for (float& t : c.ks) t = random.uniform();
    if (random.uniform() < 0.1f) std::fill(c.ks, c.ks + 4, 0.0f);
    if (random.uniform() < 0.1f) std::fill(c.albedo, c.albedo + 4, 0.0f);
  }
  return cases;
}

TEST(Sheet, IsLambertianOnBothSidesEachWithItsAlbedo) {
  BsdfCase c;
  const float reflectance[4] = {0.1f, 0.2f, 0.3f, 0.4f}, transmittance[4] = {0.5f, 0.4f, 0.3f, 0.2f};
  std::copy_n(reflectance, 4, c.albedo);
  std::copy_n(transmittance, 4, c.ks);
  for (const float z : {0.8f, -0.8f}) {
    c.wi[0] = 0.6f, c.wi[2] = z;
    for_each_target([&] {
      const BsdfResult value = run_eval_sheet({c})[0];
      for (int j = 0; j < 4; ++j)
        EXPECT_NEAR(value.value[j], (z > 0 ? reflectance : transmittance)[j] * 0.8 / pi, 1e-7);
      EXPECT_NEAR(value.pdf, (z > 0 ? 1.0 : 1.4) / 2.4 * 0.8 / pi, 1e-7);
    });
  }
}

TEST(Sheet, KernelsStayWithinTheirStatedErrors) {
  const std::vector<BsdfCase> cases = random_sheets(200000);
  for_each_target([&] {
    const std::vector<BsdfResult> values = run_eval_sheet(cases), samples = run_sample_sheet(cases);
    double value_error = 0, direction_error = 0, weight_error = 0, pdf_error = 0;
    size_t other_side = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
      const BsdfCase& c = cases[i];
      const reference::BsdfValue value = reference::eval_sheet(direction(c.wo), sheet(c), direction(c.wi));
      for (size_t j = 0; j < 4; ++j)
        value_error =
            std::max(value_error, std::abs(values[i].value[j] - value.f_cos[j]) / (3e-8 + 6e-7 * value.f_cos[j]));
      value_error = std::max(value_error, std::abs(values[i].pdf - value.pdf) / (3e-8 + 6e-7 * value.pdf));
      const reference::BsdfSample sample = reference::sample_sheet(direction(c.wo), sheet(c), c.choice, c.u, c.v);
      const Direction wi = direction(samples[i].wi);
      if (wi.z * sample.wi.z < 0) {
        ++other_side;  // the choice within rounding of the share
        continue;
      }
      direction_error = std::max(
          {direction_error, std::abs(wi.x - sample.wi.x), std::abs(wi.y - sample.wi.y), std::abs(wi.z - sample.wi.z)});
      pdf_error = std::max(pdf_error, std::abs(samples[i].pdf - sample.pdf));
      for (size_t j = 0; j < 4; ++j)
        weight_error =
            std::max(weight_error, std::abs(samples[i].value[j] - sample.weight[j]) / (1 + sample.weight[j]));
    }
    EXPECT_LT(value_error, 1);
    EXPECT_LT(direction_error, 1e-6);
    EXPECT_LT(pdf_error, 1e-6);
    EXPECT_LT(weight_error, 1e-6);
    EXPECT_LT(other_side, 4u);
  });
}

TEST(Sheet, DrawsItsPdf) {
  for (const float transmittance : {0.0f, 0.2f, 0.9f}) {
    BsdfCase c;
    c.wo[0] = 0.6f, c.wo[2] = -0.8f;
    std::fill(c.albedo, c.albedo + 4, 0.4f);
    std::fill(c.ks, c.ks + 4, transmittance);
    Random random(5);
    std::vector<BsdfCase> cases(200000, c);
    for (BsdfCase& draw : cases) draw.u = random.uniform(), draw.v = random.uniform(), draw.choice = random.uniform();
    for_each_target([&] {
      DirectionHistogram histogram;
      double sum = 0;
      for (const BsdfResult& draw : run_sample_sheet(cases)) {
        histogram.add(draw.wi[0], draw.wi[1], draw.wi[2]);
        sum += double{draw.value[0]} / double(cases.size());
      }
      const auto pdf = [&](double x, double y, double z) {
        return reference::eval_sheet(direction(c.wo), sheet(c), {x, y, z}).pdf;
      };
      EXPECT_GT(histogram.test(pdf).p_value, chi_square_level) << transmittance;
      EXPECT_NEAR(sum, 0.4 + double{transmittance}, 1e-4) << "the albedo, whichever side is drawn";
    });
  }
}

}  // namespace
}  // namespace metamer::testing
