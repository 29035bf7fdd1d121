// The smooth dielectric: each wavelength keeps its energy whichever lobe is drawn, and radiance scales across the
// boundary.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "systems/bsdf/reference.h"
#include "tests/support/each_target.h"
#include "tests/systems/bsdf/cases.h"
#include "tests/systems/support/bsdf_kernels.h"

namespace metamer::testing {
namespace {
using Spectrum = std::array<float, 4>;

BsdfCase glass(const Spectrum& eta, double cos_theta_o, bool dispersive) {
  BsdfCase c;
  c.wo[0] = float(std::sqrt(1 - cos_theta_o * cos_theta_o)), c.wo[2] = float(cos_theta_o);
  std::copy(eta.begin(), eta.end(), c.eta);
  c.dispersive = dispersive ? 1 : 0;
  return c;
}

constexpr size_t lattice = 4096;  // values of u
// The mean over u of the weights of each lobe: what the estimator makes of a unit light on that side.
struct Expectation {
  double reflected[4] = {}, transmitted[4] = {};
  double transmitted_share = 0, transmission_probability = 0;
};
Expectation expectation(BsdfCase c) {
  std::vector<BsdfCase> cases(lattice, c);
  for (size_t i = 0; i < lattice; ++i) cases[i].u = (float(i) + 0.5f) / float(lattice);
  Expectation e;
  for (const BsdfResult& draw : run_sample_dielectric(cases)) {
    for (size_t j = 0; j < 4; ++j) {
      (draw.transmitted == 1 ? e.transmitted : e.reflected)[j] += draw.value[j] / double(lattice);
    }
    EXPECT_EQ(draw.terminate_secondary, draw.transmitted * c.dispersive);
    if (draw.transmitted == 0) continue;
    e.transmitted_share += 1.0 / double(lattice);
    e.transmission_probability = draw.pdf;
  }
  return e;
}

// DESIGN.md, section 1: seen from under water at normal incidence a unit sky is (1 - F) 1.777 bright.
TEST(Dielectric, TheSkyFromUnderWaterIsBrighterByTheSquareOfTheIndex) {
  for_each_target([] {
    const float n = 4.0f / 3;
    const double f = (n - 1.0) * (n - 1.0) / ((n + 1.0) * (n + 1.0));
    const Expectation below = expectation(glass({n, n, n, n}, -1, false));
    const Expectation above = expectation(glass({n, n, n, n}, 1, false));
    for (size_t j = 0; j < 4; ++j) {
      EXPECT_NEAR(below.transmitted[j], (1 - f) * 1.7778, 1e-3);
      EXPECT_NEAR(below.reflected[j], f, 1.0 / lattice);
      EXPECT_NEAR(above.transmitted[j], (1 - f) / 1.7778, 1e-3);
    }
  });
}

TEST(Dielectric, NoWavelengthLosesOrGainsLight) {
  struct Row {
    const char* what;
    Spectrum eta;
    double cos_theta_o;
  };
  const Row rows[] = {{"flint glass from outside", {1.62f, 1.6f, 1.65f, 1.68f}, 0.4},
                      {"flint glass from inside", {1.62f, 1.6f, 1.65f, 1.68f}, -0.9},
                      {"a hero that meets no boundary", {1.0f, 1.1f, 1.2f, 0.9f}, 0.5},
                      {"only the hero is refracted", {1.3f, 1.6f, 1.7f, 1.8f}, -0.68},
                      {"only the hero is totally reflected", {1.8f, 1.3f, 1.2f, 1.25f}, -0.7},
                      {"all totally reflected", {1.5f, 1.6f, 1.55f, 1.52f}, -0.2},
                      {"grazing", {1.5f, 1.6f, 1.55f, 1.52f}, 0.01}};
  for_each_target([&] {
    for (const Row& row : rows) {
      for (const float schlick : {0.0f, 1.0f}) {
        BsdfCase c = glass(row.eta, row.cos_theta_o, true);
        c.schlick = schlick;
        const Expectation e = expectation(c);
        for (size_t j = 0; j < 4; ++j) {
          const double eta = row.cos_theta_o > 0 ? double{row.eta[j]} : 1.0 / row.eta[j];
          const double f = schlick == 1 ? reference::schlick_dielectric(eta, std::abs(row.cos_theta_o))
                                        : reference::fresnel_dielectric(eta, std::abs(row.cos_theta_o));
          // The lattice counts each lobe to within one of its points, whose weight is at most 4.
          EXPECT_NEAR(e.reflected[j], f, 4.0 / lattice + 1e-4) << row.what << ", wavelength " << j;
          const double carried = j == 0 ? (1 - f) / (eta * eta) : 0;
          EXPECT_NEAR(e.transmitted[j], carried, 4.0 / eta / eta / lattice + 1e-4) << row.what << ", wavelength " << j;
        }
        EXPECT_NEAR(e.transmitted_share, e.transmission_probability, 1.0 / lattice) << row.what;
      }
    }
  });
}

TEST(Dielectric, WithoutDispersionEveryDrawHasTheExactWeight) {
  for_each_target([] {
    for (const double cos_theta_o : {1.0, 0.3, 0.02, -0.9, -0.2}) {
      for (const float u : {0.0f, 0.05f, 0.5f, 0x1.fffffep-1f}) {
        // Companions that have been terminated may carry any index: it must not be read.
        BsdfCase c = glass({1.5f, 1.0f, 0.0f, -7.0f}, cos_theta_o, false);
        c.u = u;
        const BsdfResult draw = run_sample_dielectric({c})[0];
        const float inv_eta = cos_theta_o > 0 ? 1 / 1.5f : 1.5f;
        for (const float weight : draw.value) EXPECT_EQ(weight, draw.transmitted == 1 ? inv_eta * inv_eta : 1.0f);
        EXPECT_EQ(draw.terminate_secondary, 0.0f);
      }
    }
  });
}

TEST(Dielectric, ARefractedRayReturnsTheWayItCame) {
  for_each_target([] {
    for (const double cos_theta_o : {0.999, 0.7, 0.1, 0.01}) {
      BsdfCase in = glass({1.5f, 1.5f, 1.5f, 1.5f}, cos_theta_o, false);
      in.u = 0x1.fffffep-1f;
      const BsdfResult inside = run_sample_dielectric({in})[0];
      ASSERT_EQ(inside.transmitted, 1.0f);
      EXPECT_LT(inside.wi[2], 0);
      BsdfCase out = in;
      std::copy_n(inside.wi, 3, out.wo);
      const BsdfResult outside = run_sample_dielectric({out})[0];
      ASSERT_EQ(outside.transmitted, 1.0f);
      for (size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(outside.wi[axis], in.wo[axis], 2e-5) << cos_theta_o;
      EXPECT_NEAR(outside.value[0] * inside.value[0], 1, 1e-6);
      EXPECT_NEAR(outside.pdf, inside.pdf, 2e-4);
    }
  });
}

TEST(Dielectric, TotalReflectionLeavesNoChoice) {
  for_each_target([] {
    for (const float dispersive : {0.0f, 1.0f}) {
      BsdfCase c = glass({1.5f, 1.5f, 1.5f, 1.5f}, -0.5, false);
      c.dispersive = dispersive;
      c.u = 0x1.fffffep-1f;
      const BsdfResult draw = run_sample_dielectric({c})[0];
      EXPECT_EQ(draw.transmitted, 0.0f);
      EXPECT_EQ(draw.pdf, 1.0f);
      for (const float weight : draw.value) EXPECT_EQ(weight, 1.0f);
      EXPECT_EQ(draw.wi[2], c.wo[2]);
    }
  });
}

}  // namespace
}  // namespace metamer::testing
