// pbrt's coat over a diffuse base in closed form: the number of pbrt itself, limits by paper and pencil, and the random
// walks that define it.
#include "systems/bsdf/coat_layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "systems/bsdf/coat_albedo.h"
#include "tests/support/chi_square.h"
#include "tests/systems/support/coat_kernels.h"
#include "tests/systems/support/layered_walk.h"

namespace metamer::testing {
namespace {
using reference::Direction;
constexpr double pi = std::numbers::pi;

Direction at(double theta, double phi = 0) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}
reference::CoatOptics optics_of(const Coat& coat, double albedo, double eta) {
  BsdfCase c;
  for (int j = 0; j < 4; ++j) c.albedo[j] = float(albedo), c.eta[j] = float(eta);
  return coat.optics(c);
}
double inner_f(const reference::CoatOptics& optics, const Direction& wo, const Direction& wi) {
  const double black = [&] {
    reference::CoatOptics surface = optics;
    surface.albedo = {};
    return reference::eval_coated(wo, surface, wi).f_cos[0];
  }();
  return (reference::eval_coated(wo, optics, wi).f_cos[0] - black) / wi.z;
}
// The share of light from wo that the base sends back.
double inner_albedo(const reference::CoatOptics& optics, const Direction& wo) {
  return integrate_rectangle(
      [&](double t, double) { return 2 * pi * inner_f(optics, wo, at(t)) * std::sin(t) * std::cos(t); }, 0, pi / 2, 0,
      1, 64);
}

// The number that pbrt's own walks give, and that of our coat without a layer.
TEST(CoatLayer, ShowsTheAlbedoThatPbrtDoes) {
  const Coat pbrt(0, 0, 1.5, 1.5, Coat::Layered{0.01, 5}), native(0, 1.5, 1.5);
  const Direction wo = at(std::acos(0.8));
  EXPECT_NEAR(inner_albedo(optics_of(pbrt, 0.8, 1.5), wo), 0.542, 5e-4);
  EXPECT_NEAR(inner_albedo(optics_of(native, 0.8, 1.5), wo), 0.590, 5e-4);
}

// Without thickness and end it is the coat without a layer.
TEST(CoatLayer, WithoutThicknessAndEndItIsOurOwnCoat) {
  const Coat native(0, 1.4, 1.6), endless(0, 0, 1.4, 1.6, Coat::Layered{0, 400});
  for (const double eta : {1.4, 1.5, 1.6})
    for (const double albedo : {0.2, 0.9, 1.0})
      EXPECT_NEAR(inner_f(optics_of(endless, albedo, eta), at(0.3), at(1.1, 2)) /
                      inner_f(optics_of(native, albedo, eta), at(0.3), at(1.1, 2)),
                  1, 1e-4)
          << eta << " " << albedo;
  EXPECT_NEAR(layer_return(0, 1.5, 0), smooth_coat_average(1 / 1.5, false), 1e-5);
}

// One hit of the base at normal incidence: (1 - F)^2 exp(-2 t) a / (pi eta^2), F = 0.04. Every further one is a K times
// the last.
TEST(CoatLayer, OneHitByPaperAndPencil) {
  const double t = 0.3, one = 0.96 * 0.96 * std::exp(-2 * t) * 0.5 / (pi * 2.25);
  const auto f = [&](int hits) {
    return inner_f(optics_of(Coat(0, 0, 1.5, 1.5, Coat::Layered{t, hits}), 0.5, 1.5), at(0), at(0));
  };
  const double again = 0.5 * layer_return(0, 1.5, t);
  EXPECT_NEAR(f(1) / one, 1, 1e-5);
  EXPECT_NEAR(f(2) / one, 1 + again, 1e-5);
  EXPECT_NEAR(f(3) / one, 1 + again + again * again, 1e-5);
  EXPECT_EQ(f(0), 0);
}

// Light at cos_theta_i goes exp(-t / cos_theta_t) through the layer, sin_theta_i = eta sin_theta_t.
TEST(CoatLayer, ObliqueLightGoesFurtherThroughTheLayer) {
  const Coat thin(0, 0, 1.5, 1.5, Coat::Layered{0, 1}), thick(0, 0, 1.5, 1.5, Coat::Layered{0.2, 1});
  for (const double theta : {0.0, 0.6, 1.2, 1.5}) {
    const double inside = std::sqrt(1 - std::pow(std::sin(theta) / 1.5, 2));
    const double ratio = inner_f(optics_of(thick, 0.5, 1.5), at(theta), at(theta, 1)) /
                         inner_f(optics_of(thin, 0.5, 1.5), at(theta), at(theta, 1));
    EXPECT_NEAR(ratio, std::exp(-0.4 / inside), 1e-5) << theta;
  }
}

struct Setting {
  double alpha_x, alpha_y, eta, thickness;
  int max_depth;
};
constexpr Setting settings[] = {{0, 0, 1.5, 0.01, 10},           {0, 0, 1.33, 0.5, 4},      {0, 0, 0.8, 0.05, 6},
                                {0.0011, 0.0011, 1.5, 0.01, 10}, {0.1, 0.1, 1.5, 0.01, 10}, {0.3, 0.3, 1.5, 0.3, 10},
                                {0.6, 0.6, 1.8, 0.01, 20},       {0.3, 0.3, 0.8, 0.01, 6},  {0.1, 0.4, 1.5, 0.01, 10}};

LayeredWalk walk_of(const Setting& s, double reflectance) {
  LayeredWalk walk;
  walk.eta = s.eta;
  walk.surface = {s.alpha_x, s.alpha_y};
  walk.reflectance = reflectance;
  walk.thickness = s.thickness;
  walk.max_depth = s.max_depth;
  return walk;
}

// Tables are good to 2e-3; one width for two is good to two per cent.
double tolerance(const Setting& s) { return s.alpha_x != s.alpha_y ? 2e-2 : 2.5e-3; }

TEST(CoatLayer, ReflectsWhatWalksFollowedFromTheViewerBring) {
  for (const Setting& s : settings) {
    const Coat coat(s.alpha_x, s.alpha_y, s.eta, s.eta, Coat::Layered{s.thickness, s.max_depth / 2});
    LayeredWalk walk = walk_of(s, 0.8);
    const Direction wo = at(0.9, 0.4);
    double sum = 0, squares = 0;
    constexpr int count = 100000;
    for (int i = 0; i < count; ++i) {
      const LayeredWalk::Sample sample = walk.sample(wo);
      const double weight = sample.mirrored ? 0 : sample.weight;
      sum += weight / count;
      squares += weight * weight / count;
    }
    const double error = std::sqrt((squares - sum * sum) / count);
    EXPECT_NEAR(inner_albedo(optics_of(coat, 0.8, s.eta), wo), sum, 4.5 * error + tolerance(s))
        << s.alpha_x << " " << s.alpha_y << " " << s.eta << " " << s.thickness;
    EXPECT_LT(4.5 * error, 0.01);
  }
}

TEST(CoatLayer, IsTheValueThatWalksFromBothSidesFind) {
  for (const Setting& s : settings) {
    const Coat coat(s.alpha_x, s.alpha_y, s.eta, s.eta, Coat::Layered{s.thickness, s.max_depth / 2});
    LayeredWalk walk = walk_of(s, 0.8);
    for (const auto& [wo, wi] : {std::pair{at(0.2), at(0.9, 2)}, std::pair{at(1.2), at(1.35, -2)}}) {
      double sum = 0, squares = 0;
      constexpr int count = 60000;
      for (int i = 0; i < count; ++i) {
        const double f = walk.inner_f(wo, wi);
        sum += f / count;
        squares += f * f / count;
      }
      const double error = std::sqrt(std::max(0.0, squares - sum * sum) / count);
      EXPECT_NEAR(inner_f(optics_of(coat, 0.8, s.eta), wo, wi), sum, 4.5 * error + 2 * tolerance(s) * sum)
          << s.alpha_x << " " << s.alpha_y << " " << s.eta << " " << s.thickness;
      EXPECT_LT(4.5 * error, 0.02 * sum + 1e-3);
    }
  }
}

}  // namespace
}  // namespace metamer::testing
