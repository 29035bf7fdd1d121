// Samplers draw what their pdfs say: chi-square at many angles and roughnesses, normalisation, weight = f_cos / pdf.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "systems/bsdf/limits.h"
#include "systems/bsdf/reference.h"
#include "tests/support/chi_square.h"
#include "tests/support/each_target.h"
#include "tests/systems/bsdf/cases.h"
#include "tests/systems/support/bsdf_kernels.h"

namespace metamer::testing {
namespace {
using reference::Direction;
constexpr double pi = std::numbers::pi;

struct Setting {
  double theta_degrees;
  float alpha_x, alpha_y;
};
std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const double theta : {0.0, 30.0, 70.0, 85.0, 89.5}) {
    for (const auto& [x, y] : {std::pair{0.0015f, 0.0015f},
                               {0.05f, 0.05f},
                               {0.4f, 0.4f},
                               {1.0f, 1.0f},
                               {0.03f, 0.5f},
                               {0.6f, 0.1f},
                               {0.0f, 0.2f}}) {
      all.push_back({theta, x, y});
    }
  }
  return all;
}
BsdfCase view_from(const Setting& setting, double side) {
  BsdfCase c;
  const double theta = setting.theta_degrees * pi / 180, phi = 0.7;
  c.wo[0] = float(std::sin(theta) * std::cos(phi)), c.wo[1] = float(std::sin(theta) * std::sin(phi));
  c.wo[2] = float(side * std::cos(theta));
  c.alpha_x = setting.alpha_x, c.alpha_y = setting.alpha_y;
  for (float& kappa : c.kappa) kappa = 1e8f;  // F = 1
  return c;
}
std::vector<BsdfCase> with_random_numbers(const BsdfCase& c, size_t count) {
  Random random(17);
  std::vector<BsdfCase> cases(count, c);
  for (BsdfCase& draw : cases) draw.u = random.uniform(), draw.v = random.uniform();
  return cases;
}

// Bins in which every lobe is broad. In the space where the microsurface is a hemisphere (x / alpha_x, y / alpha_y),
// its normals are projected along the viewing direction: visible normals fill part of the unit disk evenly.
class VisibleNormalGrid {
 public:
  explicit VisibleNormalGrid(const BsdfCase& c)
      : alpha_x_(std::max(c.alpha_x, least_alpha)),
        alpha_y_(std::max(c.alpha_y, least_alpha)),
        side_(c.wo[2] < 0 ? -1 : 1),
        wo_(reference::normalize({c.wo[0], c.wo[1], c.wo[2] * side_})),
        w_(reference::normalize({alpha_x_ * wo_.x, alpha_y_ * wo_.y, wo_.z})) {
    if (w_.x != 0 || w_.y != 0) t_ = reference::normalize({-w_.y, w_.x, 0});
    b_ = {w_.y * t_.z - w_.z * t_.y, w_.z * t_.x - w_.x * t_.z, w_.x * t_.y - w_.y * t_.x};
  }
  size_t bin(const Direction& wi) const {
    const Direction n =
        reference::normalize({(wo_.x + wi.x) / alpha_x_, (wo_.y + wi.y) / alpha_y_, wo_.z + wi.z * side_});
    const auto cell = [](double x) { return std::min(size_t((x + 1) / 2 * across), across - 1); };
    return cell(reference::dot(n, t_)) * across + cell(reference::dot(n, b_));
  }
  // The integral over one bin of a function of wi that is given per solid angle of wi.
  template <class Integrand>
  double integral(const Integrand& integrand, size_t index, int pieces) const {
    const double width = 2.0 / across;
    const double a = -1 + width * double(index / across), b = -1 + width * double(index % across);
    return integrate_rectangle([&](double x, double y) { return at(integrand, x, y); }, a, a + width, b, b + width,
                               pieces);
  }
  static constexpr size_t across = 20, bins = across * across;

 private:
  template <class Integrand>
  double at(const Integrand& integrand, double a, double b) const {
    if (a * a + b * b >= 1) return 0;
    const double c = std::sqrt(1 - a * a - b * b);
    const Direction n = {a * t_.x + b * b_.x + c * w_.x, a * t_.y + b * b_.y + c * w_.y,
                         a * t_.z + b * b_.z + c * w_.z};
    if (n.z <= 0) return 0;
    const Direction m = reference::normalize({alpha_x_ * n.x, alpha_y_ * n.y, n.z});
    const double cos_d = reference::dot(wo_, m);
    const Direction wi = reference::reflect({-wo_.x, -wo_.y, -wo_.z}, m);
    if (wi.z <= 0) return 0;
    // d(omega_i) = 4 cos_d d(omega_m), d(omega_m) = ax ay (m.z / n.z)^3 d(omega_n), d(omega_n) = da db / c.
    const double squeeze = m.z / n.z;
    const double measure = 4 * cos_d * alpha_x_ * alpha_y_ * squeeze * squeeze * squeeze / c;
    return integrand(Direction{wi.x, wi.y, wi.z * side_}) * measure;
  }
  double alpha_x_, alpha_y_, side_;
  Direction wo_, w_, t_ = {1, 0, 0}, b_;
};

TEST(BsdfSampling, DiffuseDrawsTheCosine) {
  for_each_target([] {
    for (const float side : {1.0f, -1.0f}) {
      BsdfCase c;
      c.wo[0] = 0.6f, c.wo[2] = 0.8f * side;
      DirectionHistogram histogram;
      for (const BsdfResult& draw : run_sample_diffuse(with_random_numbers(c, 400000))) {
        histogram.add(draw.wi[0], draw.wi[1], draw.wi[2]);
      }
      const auto pdf = [&](double x, double y, double z) {
        return reference::eval_diffuse(direction(c.wo), {1, 1, 1, 1}, {x, y, z}).pdf;
      };
      EXPECT_GT(histogram.test(pdf).p_value, chi_square_level) << side;
    }
  });
}

TEST(BsdfSampling, ConductorDrawsItsPdfAtEveryAngleAndRoughness) {
  size_t number = 0;
  for (const Setting& setting : settings()) {
    const BsdfCase c = view_from(setting, number++ % 2 == 0 ? 1 : -1);
    const VisibleNormalGrid grid(c);
    const Direction wo = reference::normalize(direction(c.wo));
    const auto pdf = [&](const Direction& wi) { return reference::eval_conductor(wo, roughness(c), metal(c), wi).pdf; };
    constexpr size_t bins = VisibleNormalGrid::bins;
    const double draws = 100000;
    std::vector<double> expected(bins + 1);
    double total = 0;
    for (size_t bin = 0; bin < bins; ++bin) total += expected[bin] = draws * grid.integral(pdf, bin, 12);
    expected[bins] = std::max(0.0, draws - total);  // void draws, below the surface
    EXPECT_LT(total / draws, 1 + 1e-3);
    const std::vector<BsdfCase> cases = with_random_numbers(c, size_t(draws));
    for_each_target([&] {
      std::vector<double> observed(bins + 1, 0.0);
      for (const BsdfResult& draw : run_sample_conductor(cases)) {
        observed[draw.pdf > 0 ? grid.bin(direction(draw.wi)) : bins] += 1;
      }
      const ChiSquare result = chi_square_test(observed, expected);
      EXPECT_GT(result.p_value, chi_square_level)
          << setting.theta_degrees << " degrees, alpha " << setting.alpha_x << " " << setting.alpha_y;
      EXPECT_GT(result.degrees_of_freedom, 50);
    });
  }
}

// Heitz 2014, equation 3: the projected area of the microsurface is 1. And the distribution of visible normals, which
// is what is sampled, integrates to 1 (equation 16): no light is lost in the choice of the normal.
TEST(BsdfSampling, TheDistributionOfNormalsIsNormalised) {
  for (const Setting& setting : settings()) {
    if (setting.alpha_x < 0.01f) continue;  // the polar grid below does not resolve it
    const reference::Roughness alpha = {setting.alpha_x, setting.alpha_y};
    const Direction wo = reference::normalize(direction(view_from(setting, 1).wo));
    const double g1 = 1 / (1 + reference::ggx_lambda(alpha, wo));
    double area = 0, visible = 0;
    // tan(theta) = s / (1 - s) spreads the peak.
    const auto both = [&](double s, double phi, bool seen) {
      const double tan_theta = s / (1 - s), cos_theta = 1 / std::sqrt(1 + tan_theta * tan_theta);
      const double sin_theta = tan_theta * cos_theta;
      const Direction m = {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta};
      const double measure = sin_theta * cos_theta * cos_theta / ((1 - s) * (1 - s));
      const double d = reference::ggx_d(alpha, m) * measure;
      return seen ? d * g1 * std::max(0.0, reference::dot(wo, m)) / wo.z : d * cos_theta;
    };
    area = integrate_rectangle([&](double s, double p) { return both(s, p, false); }, 0, 1, 0, 2 * pi, 150);
    visible = integrate_rectangle([&](double s, double p) { return both(s, p, true); }, 0, 1, 0, 2 * pi, 150);
    EXPECT_NEAR(area, 1, 1e-4) << setting.alpha_x << " " << setting.alpha_y;
    EXPECT_NEAR(visible, 1, 1e-3) << setting.theta_degrees << " " << setting.alpha_x << " " << setting.alpha_y;
  }
}

TEST(BsdfSampling, TheAlbedoOfAWhiteConductorIsTheSameByQuadratureAndBySampling) {
  size_t number = 0;
  for (const Setting& setting : settings()) {
    const BsdfCase c = view_from(setting, number++ % 2 == 0 ? 1 : -1);
    const VisibleNormalGrid grid(c);
    const Direction wo = reference::normalize(direction(c.wo));
    double albedo = 0;
    for (size_t bin = 0; bin < VisibleNormalGrid::bins; ++bin) {
      const auto f_cos = [&](const Direction& wi) {
        return reference::eval_conductor(wo, roughness(c), metal(c), wi).f_cos[0];
      };
      albedo += grid.integral(f_cos, bin, 6);
    }
    EXPECT_LT(albedo, 1 + 1e-3);
    const std::vector<BsdfCase> cases = with_random_numbers(c, 100000);
    for_each_target([&] {
      double sum = 0, squares = 0;
      for (const BsdfResult& draw : run_sample_conductor(cases)) {
        sum += draw.value[0], squares += draw.value[0] * draw.value[0];
        EXPECT_LE(draw.value[0], 1.0f);
      }
      const double count = double(cases.size()), mean = sum / count;
      const double error = std::sqrt(std::max(0.0, squares / count - mean * mean) / count);
      EXPECT_NEAR(mean, albedo, 4.5 * error + 5e-4)
          << setting.theta_degrees << " degrees, alpha " << setting.alpha_x << " " << setting.alpha_y;
    });
  }
}

TEST(BsdfSampling, WeightsAndPdfsOfDrawsAreThoseOfEvaluation) {
  const std::vector<BsdfCase> cases = random_metals(200000);
  for_each_target([&] {
    const std::vector<BsdfResult> draws = run_sample_conductor(cases);
    std::vector<BsdfCase> again = cases;
    for (size_t i = 0; i < cases.size(); ++i) std::copy_n(draws[i].wi, 3, again[i].wi);
    const std::vector<BsdfResult> values = run_eval_conductor(again);
    double pdf_error = 0, weight_error = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
      // alpha times the lobe's sharpness is what single precision directions resolve.
      if (draws[i].delta == 1 || draws[i].pdf == 0 || std::min(cases[i].alpha_x, cases[i].alpha_y) < 0.01f) continue;
      pdf_error = std::max(pdf_error, double(std::abs(values[i].pdf / draws[i].pdf - 1)));
      for (size_t j = 0; j < 4; ++j) {
        const double weight = double(values[i].value[j]) / values[i].pdf;
        weight_error = std::max(weight_error, std::abs(weight - draws[i].value[j]));
      }
    }
    EXPECT_LT(pdf_error, 2e-3);
    EXPECT_LT(weight_error, 1e-5);
  });
}

}  // namespace
}  // namespace metamer::testing
