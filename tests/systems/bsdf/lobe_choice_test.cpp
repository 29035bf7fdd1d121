// Chi-square of samplers with nothing to draw but one of two delta lobes: how often each is taken, against the
// probability by formula and the one that the draw states. Those that draw directions, too, have theirs beside their
// kernels: bsdf_sampling_test.cpp, rough_test.cpp, coated_test.cpp, rough_dielectric_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/chi_square.h"
#include "tests/support/each_target.h"
#include "tests/systems/bsdf/cases.h"
#include "tests/systems/support/bsdf_kernels.h"

namespace metamer::testing {
namespace {

BsdfCase seen_at(double cos_theta_o, double eta) {
  BsdfCase c;
  c.wo[0] = float(std::sqrt(1 - cos_theta_o * cos_theta_o)), c.wo[1] = 0, c.wo[2] = float(cos_theta_o);
  std::fill(c.eta, c.eta + 4, float(eta));
  return c;
}

// The case's draws reflect with the probability `reflecting` and go through otherwise.
void expect_shares(BsdfKernel sample, const BsdfCase& c, double reflecting) {
  constexpr size_t draws = 200000;
  Random random(47);
  std::vector<BsdfCase> cases(draws, c);
  for (BsdfCase& draw : cases) draw.u = random.uniform();
  for_each_target([&] {
    std::vector<double> observed(2, 0.0), expected = {reflecting * draws, (1 - reflecting) * draws};
    for (const BsdfResult& draw : sample(cases)) {
      observed[draw.transmitted == 1 ? 1 : 0] += 1;
      EXPECT_NEAR(draw.pdf, draw.transmitted == 1 ? 1 - reflecting : reflecting, 3e-5);
    }
    const ChiSquare result = chi_square_test(observed, expected);
    EXPECT_EQ(result.degrees_of_freedom, 1);
    EXPECT_GT(result.p_value, chi_square_level);
  });
}

TEST(LobeChoice, ADielectricReflectsWithFresnelsProbability) {
  for (const double cos_theta : {0.9, 0.5, 0.1}) {
    SCOPED_TRACE(cos_theta);
    expect_shares(run_sample_dielectric, seen_at(cos_theta, 1.5), reference::fresnel_dielectric(1.5, cos_theta));
  }
  expect_shares(run_sample_dielectric, seen_at(-0.8, 1.5), reference::fresnel_dielectric(1 / 1.5, 0.8));
}

// Where wavelengths part, their mean decides.
TEST(LobeChoice, ADispersingDielectricReflectsWithTheMeanOfItsWavelengths) {
  for (const double cos_theta : {0.7, -0.9}) {
    BsdfCase c = seen_at(cos_theta, 1.5);
    c.dispersive = 1;
    double mean = 0;
    for (size_t j = 0; j < 4; ++j) {
      c.eta[j] = 1.3f + 0.2f * float(j);
      const double eta = double{c.eta[j]};
      mean += reference::fresnel_dielectric(cos_theta > 0 ? eta : 1 / eta, std::abs(cos_theta)) / 4;
    }
    SCOPED_TRACE(cos_theta);
    expect_shares(run_sample_dielectric, c, mean);
  }
}

// By the mean over the wavelengths of what comes back against that of what goes through.
TEST(LobeChoice, AThinPlateReflectsWithTheShareOfItsSeries) {
  for (const bool absorbs : {false, true})
    for (const double cos_theta : {0.9, -0.4}) {
      BsdfCase c = seen_at(cos_theta, 1.5);
      c.dispersive = 1;  // all four wavelengths are alive
      reference::ThinOptics optics;
      double reflected = 0, transmitted = 0;
      for (size_t j = 0; j < 4; ++j) {
        c.eta[j] = 1.4f + 0.2f * float(j), c.kappa[j] = absorbs ? 0.5f * float(j) : 0;
        optics.eta[j] = double{c.eta[j]}, optics.optical_depth[j] = double{c.kappa[j]};
        const reference::ThinShares shares = reference::thin_shares(optics, j, std::abs(cos_theta));
        reflected += shares.reflected, transmitted += shares.transmitted;
      }
      SCOPED_TRACE(::testing::Message() << cos_theta << (absorbs ? " absorbing" : " clear"));
      expect_shares(run_sample_thin, c, reflected / (reflected + transmitted));
    }
}

}  // namespace
}  // namespace metamer::testing
