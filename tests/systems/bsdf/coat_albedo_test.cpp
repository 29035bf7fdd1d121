// What a coat's surface reflects by itself, against published values and against integrals of the scalar BSDFs.
#include "systems/bsdf/coat_albedo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "systems/bsdf/limits.h"
#include "systems/bsdf/reference_coat.h"
#include "tests/support/chi_square.h"
#include "tests/systems/bsdf/cases.h"

namespace metamer::testing {
namespace {
constexpr double pi = std::numbers::pi;

// Walsh's closed form of the average over the hemisphere, from a thinner medium on one of relative index n (Duntley,
// JOSA 32, 61, 1942, equation 1).
double closed_form(double n) {
  const double n2 = n * n, n4 = n2 * n2;
  return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
         n2 * std::pow(n2 - 1, 2) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
         2 * n * n2 * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
         8 * n4 * (n4 + 1) / ((n2 + 1) * std::pow(n4 - 1, 2)) * std::log(n);
}

TEST(CoatAlbedo, TheSmoothAverageIsThePublishedOne) {
  EXPECT_NEAR(smooth_coat_average(1.5, false), 0.092, 5e-4);      // Duntley: 0.092 outside
  EXPECT_NEAR(smooth_coat_average(1 / 1.5, false), 0.596, 5e-4);  // and 0.596 inside
  for (const double n : {1.1, 1.333, 1.5, 2.4, 4.0})
    EXPECT_NEAR(smooth_coat_average(n, false), closed_form(n), 1e-6) << n;
  EXPECT_EQ(smooth_coat_average(1, false), 0);
}

// The same boundary is crossed either way: (1 - inside) n^2 = 1 - outside.
TEST(CoatAlbedo, BothSidesOfASmoothSurfacePassTheSame) {
  for (const bool schlick : {false, true})
    for (const double n : {1.02, 1.333, 1.5, 2.4})
      EXPECT_NEAR((1 - smooth_coat_average(1 / n, schlick)) * n * n, 1 - smooth_coat_average(n, schlick), 1e-5) << n;
}

// Schlick: F0 + (1 - F0) times the integral of 2 c (1 - c)^5, which is 1/21.
TEST(CoatAlbedo, SchlicksAverageIsATwentyFirstAboveItsFoot) {
  for (const double n : {1.2, 1.5, 2.4}) {
    const double f0 = std::pow((n - 1) / (n + 1), 2);
    EXPECT_NEAR(smooth_coat_average(n, true), f0 + (1 - f0) / 21, 1e-6) << n;
  }
}

TEST(CoatAlbedo, FresnelIsThatOfTheReference) {
  for (const double eta : {0.5, 0.99, 1.0, 1.5, 3.0})
    for (double c = 0.001; c <= 1; c += 0.0111) {
      EXPECT_NEAR(coat_fresnel(eta, c, false), reference::fresnel_dielectric(eta, c), 1e-12) << eta << " " << c;
      EXPECT_NEAR(coat_fresnel(eta, c, true), reference::schlick_dielectric(eta, c), 1e-12) << eta << " " << c;
    }
}

// The integral of the reference's GGX lobe over directions of light, not over facets.
double integrated(double alpha, double eta, bool schlick, double cos_o) {
  const reference::Direction wo = {std::sqrt(1 - cos_o * cos_o), 0, cos_o};
  const reference::Roughness roughness{alpha, alpha};
  const double lambda_o = reference::ggx_lambda(roughness, wo);
  // Facets by slope: theta_m with tan(theta_m) = alpha tan(x) spreads the peak evenly.
  const auto facet = [&](double x, double phi) {
    const double slope = alpha * std::tan(x), cos_m = 1 / std::sqrt(1 + slope * slope), sin_m = slope * cos_m;
    const reference::Direction m = {sin_m * std::cos(phi), sin_m * std::sin(phi), cos_m};
    const double cos_d = reference::dot(wo, m);
    if (cos_d <= 0) return 0.0;
    const reference::Direction wi = reference::reflect({-wo.x, -wo.y, -wo.z}, m);
    if (wi.z <= 0) return 0.0;
    const double g = 1 / (1 + lambda_o + reference::ggx_lambda(roughness, wi));
    const double f = schlick ? reference::schlick_dielectric(eta, cos_d) : reference::fresnel_dielectric(eta, cos_d);
    // f_cos d(wi) = D G F / (4 cos_o) 4 cos_d d(omega_m)
    const double jacobian = alpha / (std::cos(x) * std::cos(x)) * cos_m * cos_m * sin_m;
    return reference::ggx_d(roughness, m) * g * f * cos_d / cos_o * jacobian;
  };
  return integrate_rectangle(facet, 0, pi / 2 - 1e-9, -pi, pi, 150);
}

TEST(CoatAlbedo, TheRoughSurfaceReflectsTheIntegralOfItsLobe) {
  for (const double alpha : {0.02, 0.1, 0.4, 1.0})
    for (const double cos_o : {0.02, 0.1, 0.3, 0.6, 0.9, 1.0})
      for (const double eta : {1.333, 1.5, 0.75})
        EXPECT_NEAR(rough_coat_albedo(alpha, eta, false, cos_o), integrated(alpha, eta, false, cos_o), 2e-3)
            << alpha << " " << cos_o << " " << eta;
  EXPECT_NEAR(rough_coat_albedo(0.3, 1.5, true, 0.3), integrated(0.3, 1.5, true, 0.3), 1e-3);
}

TEST(CoatAlbedo, TheSmootherTheNearerToFresnel) {
  for (const double cos_o : {0.05, 0.2, 0.5, 1.0}) {
    const double smooth = coat_fresnel(1.5, cos_o, false);
    EXPECT_NEAR(rough_coat_albedo(0.001, 1.5, false, cos_o), smooth, 0.01) << cos_o;
    EXPECT_NEAR(rough_coat_albedo(1e-4, 1.5, false, cos_o), smooth, 0.002) << cos_o;
  }
}

// Table, with nodes between and etas between, against the functions that it interpolates.
TEST(CoatAlbedo, TheTableStaysWithinItsStatedError) {
  for (const double alpha : {0.0, 0.002, 0.05, 0.6})
    for (const bool schlick : {false, true}) {
      Column<float> table = {};
      table.push_back(9);  // rows need not begin at 0
      reference::CoatOptics optics;
      optics.alpha = alpha;
      optics.schlick = schlick;
      optics.rows = add_coat_rows({alpha, schlick, false, 0}, 1.45, 1.538, table);
      optics.table = table.data();
      EXPECT_GT(optics.rows.last_pair, 2u);
      double rough_error = 0, average_error = 0;
      for (double eta = 1.45; eta < 1.538; eta += 0.0043) {
        if (alpha == 0)
          average_error = std::max(average_error, std::abs(reference::coat_surface_average(optics, eta) -
                                                           smooth_coat_average(eta, schlick)));
        else
          for (double c = 1e-5; c < 1; c *= 1.17)
            rough_error = std::max(rough_error, std::abs(reference::coat_surface_albedo(optics, eta, c) -
                                                         rough_coat_albedo(alpha, eta, schlick, c)));
      }
      EXPECT_LT(average_error, 2e-5) << schlick;
      EXPECT_LT(rough_error, 1.5e-3) << alpha << " " << schlick;
    }
}

// The average is that of the interpolated albedo: integral of 2 c E dc.
TEST(CoatAlbedo, TheAverageBelongsToTheInterpolatedAlbedo) {
  Column<float> table;
  reference::CoatOptics optics;
  optics.alpha = 0.2;
  optics.rows = add_coat_rows({0.2, false, false, 0}, 1.5, 1.5, table);
  optics.table = table.data();
  double sum = 0;
  constexpr int cells = 200000;
  for (int k = 0; k < cells; ++k) {
    const double c = (k + 0.5) / cells;
    sum += 2 * c * reference::coat_surface_albedo(optics, 1.5, c) / cells;
  }
  EXPECT_NEAR(reference::coat_surface_average(optics, 1.5), sum, 2e-7);
}

}  // namespace
}  // namespace metamer::testing
