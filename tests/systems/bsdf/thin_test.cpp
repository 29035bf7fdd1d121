// The thin plate: the geometric series of its inner reflections, absorption, and the kernel against its twin.
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

reference::ThinOptics plate(const BsdfCase& c) {
  reference::ThinOptics optics;
  optics.eta = spectrum(c.eta);
  optics.kappa = optics.optical_depth = spectrum(c.kappa);
  optics.opaque.fill(c.opaque == 1);
  optics.schlick = c.schlick == 1;
  optics.companions = c.dispersive == 1;
  return optics;
}

TEST(Thin, KernelsStayWithinTheirStatedErrors) {
  Random random(8);
  std::vector<BsdfCase> cases = random_metals(50000);
  for (BsdfCase& c : cases) {
    c.opaque = random.uniform() < 0.2f ? 1 : 0;
    c.dispersive = random.uniform() < 0.5f ? 1 : 0;
    for (size_t j = 0; j < 4; ++j) {
      c.eta[j] = 1.05f + 1.5f * random.uniform();
      c.kappa[j] = c.opaque == 1 ? 3 * random.uniform() : random.uniform() < 0.5f ? 0 : 2 * random.uniform();
    }
  }
  for_each_target([&] {
    const std::vector<BsdfResult> samples = run_sample_thin(cases);
    double share_error = 0, probability_error = 0;
    size_t mismatches = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
      const BsdfCase& c = cases[i];
      const reference::BsdfSample sample = reference::sample_thin(direction(c.wo), plate(c), c.u);
      if ((samples[i].transmitted == 1) != sample.transmitted) {
        ++mismatches;
        continue;
      }
      probability_error = std::max(probability_error, std::abs(samples[i].pdf - sample.pdf));
      for (size_t j = 0; j < 4; ++j) {
        const double share = double{samples[i].value[j]} * double{samples[i].pdf};
        share_error = std::max(share_error, std::abs(share - sample.weight[j] * sample.pdf));
      }
    }
    EXPECT_LT(share_error, 2e-5);
    EXPECT_LT(probability_error, 2e-5);
    EXPECT_LT(mismatches, 10u);
  });
}

// Without absorption R = 2 F / (1 + F); a window at normal incidence reflects 7.7 %.
TEST(Thin, AWindowReflectsTwiceAlmost) {
  reference::ThinOptics window;
  window.eta = {1.5, 1.5, 1.5, 1.5};
  EXPECT_NEAR(reference::thin_shares(window, 0, 1).reflected, 2 * 0.04 / 1.04, 1e-8);
  for (const double cos_theta : {1.0, 0.5, 0.1}) {
    const reference::ThinShares shares = reference::thin_shares(window, 0, cos_theta);
    const double f = reference::fresnel_dielectric(1.5, cos_theta);
    EXPECT_NEAR(shares.reflected, 2 * f / (1 + f), 1e-8);
    EXPECT_NEAR(shares.reflected + shares.transmitted, 1, 1e-8);
  }
}

// Grey glass: light takes the slanted way through at least once, so what goes through is at most that of one passage.
TEST(Thin, AbsorptionTakesFromBothSides) {
  reference::ThinOptics clear, grey;
  clear.eta = grey.eta = {1.5, 1.5, 1.5, 1.5};
  grey.optical_depth.fill(0.7);
  for (const double cos_theta : {1.0, 0.6, 0.2}) {
    const reference::ThinShares a = reference::thin_shares(clear, 0, cos_theta);
    const reference::ThinShares b = reference::thin_shares(grey, 0, cos_theta);
    const double f = reference::fresnel_dielectric(1.5, cos_theta);
    const double one_way = std::exp(-0.7 / reference::cos_transmitted(1.5, cos_theta));
    EXPECT_LT(b.reflected, a.reflected);
    EXPECT_GT(b.reflected, f);
    EXPECT_GT(b.transmitted, (1 - f) * (1 - f) * one_way);
    EXPECT_LT(b.transmitted, a.transmitted * one_way);
  }
}

}  // namespace
}  // namespace metamer::testing
