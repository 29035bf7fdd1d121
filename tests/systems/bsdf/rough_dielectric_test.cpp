// The rough dielectric: energy, chi-square, the limit of a smooth surface, and the kernels against their twins.
// Reciprocity: reciprocity_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
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
using reference::Direction;
using reference::Spectrum4;
constexpr double pi = std::numbers::pi;

reference::DielectricOptics glass(const BsdfCase& c) {
  reference::DielectricOptics optics;
  optics.eta = spectrum(c.eta);
  optics.schlick = c.schlick == 1;
  optics.dispersive = c.dispersive == 1;
  return optics;
}
BsdfCase view(double degrees, bool from_inside, float alpha_x, float alpha_y, float eta) {
  BsdfCase c;
  const double theta = degrees * pi / 180, phi = 0.7;
  c.wo[0] = float(std::sin(theta) * std::cos(phi)), c.wo[1] = float(std::sin(theta) * std::sin(phi));
  c.wo[2] = float((from_inside ? -1 : 1) * std::cos(theta));
  c.alpha_x = alpha_x, c.alpha_y = alpha_y;
  for (float& x : c.eta) x = eta;
  return c;
}

// eta away from 1 by 0.05 at least, alphas from 0.02 on.
std::vector<BsdfCase> random_rough_glass(size_t count) {
  Random random(31);
  std::vector<BsdfCase> cases(count);
  for (BsdfCase& c : cases) {
    random.direction(c.wo);
    random.direction(c.wi);
    c.u = random.uniform(), c.v = random.uniform(), c.choice = random.uniform();
    c.alpha_x = 0.02f + 0.98f * random.uniform() * random.uniform();
    c.alpha_y = random.uniform() < 0.5f ? c.alpha_x : 0.02f + 0.98f * random.uniform();
    const bool is_denser = random.uniform() < 0.7f;
    for (float& eta : c.eta) eta = is_denser ? 1.05f + 1.4f * random.uniform() : 0.95f - 0.5f * random.uniform();
    c.schlick = random.uniform() < 0.3f ? 1 : 0;
    c.dispersive = random.uniform() < 0.5f ? 1 : 0;
  }
  return cases;
}

// Largest relative difference, values below `floor` counting as that.
double relative(double a, double b, double floor) { return std::abs(a - b) / std::max(std::abs(b), floor); }

TEST(RoughDielectric, KernelsStayWithinTheirStatedErrors) {
  const std::vector<BsdfCase> cases = random_rough_glass(200000);
  for_each_target([&] {
    const std::vector<BsdfResult> values = run_eval_rough_dielectric(cases);
    const std::vector<BsdfResult> samples = run_sample_rough_dielectric(cases);
    double f_error = 0, pdf_error = 0, wi_error = 0, weight_error = 0, sample_pdf_error = 0;
    size_t mismatches = 0, transmitting = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
      const BsdfCase& c = cases[i];
      const auto value = reference::eval_rough_dielectric(direction(c.wo), roughness(c), glass(c), direction(c.wi));
      for (size_t j = 0; j < 4; ++j) {
        f_error = std::max(f_error, relative(values[i].value[j], value.f_cos[j], 1e-3));
        pdf_error = std::max(pdf_error, relative(values[i].pdfs[j], value.pdf[j], 1e-3));
      }
      if (c.wo[2] * c.wi[2] < 0 && value.f_cos[0] > 0) ++transmitting;
      const reference::BsdfSample sample =
          reference::sample_rough_dielectric(direction(c.wo), roughness(c), glass(c), c.choice, c.u, c.v);
      const bool drawn = samples[i].value[0] > 0;
      // A choice within rounding of its probability, or a draw at the horizon or the critical angle.
      if ((samples[i].transmitted == 1) != sample.transmitted || drawn != (sample.weight[0] > 0)) {
        ++mismatches;
        continue;
      }
      if (!drawn) continue;
      const Direction wi = direction(samples[i].wi);
      wi_error = std::max(
          {wi_error, std::abs(wi.x - sample.wi.x), std::abs(wi.y - sample.wi.y), std::abs(wi.z - sample.wi.z)});
      for (size_t j = 0; j < 4; ++j)
        weight_error = std::max(weight_error, std::abs(samples[i].value[j] - sample.weight[j]));
      sample_pdf_error = std::max(sample_pdf_error, relative(samples[i].pdf, sample.pdf, 1e-3));
    }
    EXPECT_GT(transmitting, cases.size() / 10);
    EXPECT_LT(f_error, 1e-2);
    EXPECT_LT(pdf_error, 3e-2);
    EXPECT_LT(wi_error, 1e-4);
    EXPECT_LT(weight_error, 1e-3);
    EXPECT_LT(sample_pdf_error, 1e-2);
    EXPECT_LT(mismatches, cases.size() / 2000);
  });
}

// In light that has come to rest, brighter inside by eta^2, a lossless surface shows what its facets do not scatter
// twice. Reflected and transmitted light together: at most 1, and nearly 1 where the facets are flat.
TEST(RoughDielectric, LosesOnlyWhatMeetsASecondFacet) {
  struct Row {
    double degrees, alpha, eta, least;
    bool from_inside;
  };
  for (const Row& row : {Row{0, 0.1, 1.5, 0.995, false},
                         {60, 0.1, 1.5, 0.99, false},
                         {30, 0.5, 1.5, 0.9, false},
                         {80, 0.5, 1.5, 0.75, false},
                         {0, 1.0, 1.33, 0.75, false},
                         {30, 0.2, 1.5, 0.9, true},
                         {60, 0.3, 1.5, 0.75, true},
                         {30, 0.3, 0.75, 0.85, false}}) {
    const BsdfCase c = view(row.degrees, row.from_inside, float(row.alpha), float(row.alpha), float(row.eta));
    const double eta = row.from_inside ? 1 / row.eta : row.eta;
    const auto seen = [&](double theta, double phi) {
      const double s = std::sin(theta);
      const Direction wi = {s * std::cos(phi), s * std::sin(phi), std::cos(theta)};
      const double light = wi.z * c.wo[2] < 0 ? eta * eta : 1;
      return s * light * reference::eval_rough_dielectric(direction(c.wo), roughness(c), glass(c), wi).f_cos[0];
    };
    const double albedo = integrate_rectangle(seen, 0, pi, -pi, pi, 160);
    EXPECT_LT(albedo, 1.0005) << row.degrees << " degrees, alpha " << row.alpha << ", eta " << row.eta;
    EXPECT_GT(albedo, row.least) << row.degrees << " degrees, alpha " << row.alpha << ", eta " << row.eta;
    // No draw gains, either, and the mean of the draws is the integral.
    std::vector<BsdfCase> draws(100000, c);
    Random random(3);
    for (BsdfCase& draw : draws) draw.u = random.uniform(), draw.v = random.uniform(), draw.choice = random.uniform();
    double mean = 0;
    for (const BsdfResult& draw : run_sample_rough_dielectric(draws)) {
      const double weight = draw.value[0] * (draw.transmitted == 1 ? eta * eta : 1);
      EXPECT_LE(weight, 1 + 1e-5);
      mean += weight / double(draws.size());
    }
    EXPECT_NEAR(mean, albedo, 0.004) << row.degrees << " degrees, alpha " << row.alpha << ", eta " << row.eta;
  }
}

TEST(RoughDielectric, DrawsItsPdfOnBothSides) {
  struct Row {
    double degrees;
    float alpha_x, alpha_y, eta;
    bool from_inside;
    int pieces = 8;
  };
  for (const Row& row : {Row{0, 0.3f, 0.3f, 1.5f, false},
                         {30, 0.6f, 0.6f, 1.5f, true},
                         {70, 0.3f, 0.3f, 1.5f, false},
                         {70, 0.5f, 0.5f, 1.5f, true},
                         {45, 1, 1, 2.4f, false},
                         {45, 0.2f, 0.7f, 1.33f, true},
                         {60, 0.7f, 0.2f, 0.75f, false},
                         {20, 0.4f, 0.4f, 0.75f, true},
                         {85, 0.4f, 0.4f, 1.2f, false, 24}}) {
    const BsdfCase c = view(row.degrees, row.from_inside, row.alpha_x, row.alpha_y, row.eta);
    Random random(19);
    std::vector<BsdfCase> cases(200000, c);
    for (BsdfCase& draw : cases) draw.u = random.uniform(), draw.v = random.uniform(), draw.choice = random.uniform();
    const auto pdf = [&](double x, double y, double z) {
      return reference::eval_rough_dielectric(direction(c.wo), roughness(c), glass(c), {x, y, z}).pdf[0];
    };
    for_each_target([&] {
      DirectionHistogram histogram;
      for (const BsdfResult& draw : run_sample_rough_dielectric(cases)) {
        if (draw.pdf > 0) {
          histogram.add(draw.wi[0], draw.wi[1], draw.wi[2]);
        } else {
          histogram.reject();
        }
      }
      const ChiSquare result = histogram.test(pdf, row.pieces);
      EXPECT_GT(result.p_value, chi_square_level) << row.degrees << " degrees, alpha " << row.alpha_x << " "
                                                  << row.alpha_y << ", eta " << row.eta << " " << row.from_inside;
      EXPECT_GT(result.degrees_of_freedom, 50);
    });
  }
}

// Each wavelength by itself: over all heroes, draws bring what eval says, on the reflected side with every wavelength
// of a draw and on the other with the hero alone.
TEST(RoughDielectric, DispersionLosesNoWavelength) {
  for (const bool from_inside : {false, true}) {
    BsdfCase c = view(40, from_inside, 0.3f, 0.3f, 1.5f);
    c.eta[0] = 1.45f, c.eta[1] = 1.5f, c.eta[2] = 1.6f, c.eta[3] = 1.7f;
    c.dispersive = 1;
    double seen[4] = {}, wanted[4] = {};
    for (size_t hero = 0; hero < 4; ++hero) {
      BsdfCase turned = c;
      for (size_t j = 0; j < 4; ++j) turned.eta[j] = c.eta[(hero + j) % 4];
      Random random(7);
      std::vector<BsdfCase> draws(100000, turned);
      for (BsdfCase& draw : draws) draw.u = random.uniform(), draw.v = random.uniform(), draw.choice = random.uniform();
      for (const BsdfResult& draw : run_sample_rough_dielectric(draws)) {
        EXPECT_EQ(draw.terminate_secondary, draw.transmitted);
        for (size_t j = 0; j < 4; ++j) {
          const float stands_for = draw.terminate_secondary == 1 && j == 0 ? 4 : 1;
          seen[(hero + j) % 4] += double{stands_for * draw.value[j]} / double(draws.size()) / 4;
        }
      }
    }
    for (size_t j = 0; j < 4; ++j) {
      const auto f_cos = [&](double z, double phi) {
        const double s = std::sqrt(std::max(0.0, 1 - z * z));
        const Direction wi = {s * std::cos(phi), s * std::sin(phi), z};
        return reference::eval_rough_dielectric(direction(c.wo), roughness(c), glass(c), wi).f_cos[j];
      };
      wanted[j] = integrate_rectangle(f_cos, -1, 1, -pi, pi, 100);
      EXPECT_NEAR(seen[j] / wanted[j], 1, 0.02) << "wavelength " << j << (from_inside ? " from inside" : "");
    }
  }
}

// With hardly any roughness the rough one refracts and reflects as the smooth one.
TEST(RoughDielectric, TendsToTheSmoothOne) {
  for_each_target([] {
    for (const double degrees : {5.0, 40.0, 70.0}) {
      for (const bool from_inside : {false, true}) {
        if (from_inside && degrees > 40) continue;  // total reflection is a mirror in both
        for (const float choice : {0.0f, 0.9f}) {
          BsdfCase c = view(degrees, from_inside, 0.001f, 0.001f, 1.5f);
          c.u = 0.3f, c.v = 0.4f, c.choice = choice;
          const BsdfResult rough = run_sample_rough_dielectric({c})[0];
          c.u = choice;
          const BsdfResult smooth = run_sample_dielectric({c})[0];
          EXPECT_EQ(rough.transmitted, smooth.transmitted);
          for (size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(rough.wi[axis], smooth.wi[axis], 6e-3);
          EXPECT_NEAR(rough.value[0], smooth.value[0], 2e-3);
        }
      }
    }
  });
}

TEST(RoughDielectric, AMatchedIndexIsNotThere) {
  for_each_target([] {
    for (const float dispersive : {0.0f, 1.0f}) {
      BsdfCase c = view(50, false, 0.4f, 0.2f, 1);
      c.dispersive = dispersive;
      c.u = 0.2f, c.v = 0.6f, c.choice = 0.5f;
      c.wi[0] = -c.wo[0], c.wi[1] = -c.wo[1], c.wi[2] = -c.wo[2];
      const BsdfResult draw = run_sample_rough_dielectric({c})[0], value = run_eval_rough_dielectric({c})[0];
      EXPECT_EQ(draw.transmitted, 1.0f);
      EXPECT_EQ(draw.pdf, 0.0f);
      EXPECT_EQ(draw.value[0], 1.0f);
      for (size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(draw.wi[axis], -c.wo[axis]);
      for (size_t j = 0; j < 4; ++j) {
        EXPECT_EQ(value.value[j], 0.0f);
        EXPECT_EQ(value.pdfs[j], 0.0f);
      }
    }
  });
}

}  // namespace
}  // namespace metamer::testing
