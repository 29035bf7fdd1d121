// pbrt's coat where light is followed at random: the kernel's estimates and draws against the scalar walks that define
// it, the delta lobe by paper and pencil, on every instruction set.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/each_target.h"
#include "tests/systems/support/layered_kernels.h"

namespace metamer::testing {
namespace {
using reference::Direction;

Direction at(double theta, double phi = 0) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

struct Setting {
  const char* name;
  bool conductor;
  double surface_x, surface_y, base;
  double thickness, albedo, asymmetry;
  int max_depth;
};
constexpr Setting settings[] = {{"rough metal under a smooth coat", true, 0, 0, 0.2, 0.01, 0, 0, 10},
                                {"mirror under a rough coat", true, 0.2, 0.2, 0, 0.01, 0, 0, 10},
                                {"rough metal under a rough coat", true, 0.2, 0.4, 0.3, 0.1, 0, 0, 10},
                                {"mirror under a smooth coat that scatters", true, 0, 0, 0, 0.5, 0.8, 0.3, 20},
                                {"paint under a smooth coat that scatters", false, 0, 0, 0, 0.5, 0.8, 0.3, 20},
                                {"paint under a rough coat that scatters", false, 0.3, 0.3, 0, 1, 0.9, -0.5, 30},
                                {"rough metal under one that scatters", true, 0.3, 0.3, 0.3, 0.5, 0.7, 0.6, 16}};
LayeredWalk walk_of(const Setting& s) {
  LayeredWalk walk;
  walk.conductor = s.conductor;
  walk.reflectance = 0.7;
  walk.n = 0.2;
  walk.kappa = 2.5;
  walk.surface = {s.surface_x, s.surface_y};
  walk.base = {s.base, s.base};
  walk.thickness = s.thickness;
  walk.albedo = s.albedo;
  walk.asymmetry = s.asymmetry;
  walk.max_depth = s.max_depth;
  return walk;
}

struct Mean {
  double sum = 0, squares = 0;
  size_t count = 0;
  void add(double x) { sum += x, squares += x * x, ++count; }
  double mean() const { return sum / double(count); }
  double variance() const { return std::max(0.0, squares / double(count) - mean() * mean()) / double(count); }
};
void expect_same(const Mean& a, const Mean& b, double visible, const char* what) {
  const double deviation = std::sqrt(a.variance() + b.variance());
  EXPECT_LT(std::abs(a.mean() - b.mean()), 4.5 * deviation + 2e-4 * std::abs(a.mean())) << what << " " << a.mean();
  EXPECT_LT(6 * deviation, visible * a.mean() + 5e-3) << what << ": too few samples";
}

double surface_f(const LayeredWalk& walk, const Direction& wo, const Direction& wi) {
  if (reference::is_smooth(walk.surface)) return 0;
  const Direction h = reference::normalize({wo.x + wi.x, wo.y + wi.y, wo.z + wi.z});
  const double g = 1 / (1 + reference::ggx_lambda(walk.surface, wo) + reference::ggx_lambda(walk.surface, wi));
  return reference::ggx_d(walk.surface, h) * g * reference::fresnel_dielectric(walk.eta, reference::dot(wo, h)) /
         (4 * wo.z * wi.z);
}

TEST(Layered, EstimatesHaveTheMeanOfTheWalks) {
  for (const Setting& s : settings)
    for (const auto& [wo, wi] : {std::pair{at(0.6), at(0.7, 2.9)}, std::pair{at(1.2, 0.3), at(0.3, 2)}}) {
      LayeredWalk walk = walk_of(s);
      Mean walks;
      for (int i = 0; i < 60000; ++i) walks.add(walk.inner_f(wo, wi) + surface_f(walk, wo, wi));
      for_each_target([&] {
        Mean kernel;
        for (const BsdfResult& result : run_eval_layered(walk, wo, wi, 60000)) kernel.add(result.value[0] / wi.z);
        expect_same(kernel, walks, 0.3, s.name);
      });
    }
}

// Draws, over several parts of the hemisphere.
TEST(Layered, DrawsHaveTheMeansOfTheWalks) {
  const std::function<double(const Direction&)> tests[] = {[](const Direction&) { return 1.0; },
                                                           [](const Direction& w) { return w.x < -0.3 ? 1.0 : 0.0; },
                                                           [](const Direction& w) { return w.z * w.z; }};
  for (const Setting& s : settings) {
    LayeredWalk walk = walk_of(s);
    const Direction wo = at(0.6, 0.2);
    Mean walks[3];
    for (int i = 0; i < 100000; ++i) {
      const LayeredWalk::Sample sample = walk.sample(wo);
      for (int k = 0; k < 3; ++k) walks[k].add(sample.weight * tests[k](sample.wi));
    }
    for_each_target([&] {
      Mean kernel[3];
      for (const BsdfResult& draw : run_sample_layered(walk, wo, 100000))
        for (int k = 0; k < 3; ++k)
          kernel[k].add(double{draw.value[0]} * tests[k]({draw.wi[0], draw.wi[1], draw.wi[2]}));
      for (int k = 0; k < 3; ++k) expect_same(kernel[k], walks[k], 0.1, s.name);
    });
  }
}

// eval and sample agree on the function that stands in for the density: multiple importance sampling needs no more.
TEST(Layered, DrawsCarryThePdfOfEvaluation) {
  for (const Setting& s : settings) {
    const LayeredWalk walk = walk_of(s);
    const Direction wo = at(0.6, 0.2);
    for_each_target([&] {
      int compared = 0;
      for (const BsdfResult& draw : run_sample_layered(walk, wo, 400)) {
        if (draw.pdf == 0) continue;
        const Direction wi = {draw.wi[0], draw.wi[1], draw.wi[2]};
        EXPECT_NEAR(run_eval_layered(walk, wo, wi, 1)[0].pdf / draw.pdf, 1, 1e-3) << s.name;
        ++compared;
      }
      EXPECT_GT(compared, 50) << s.name;
    });
  }
}

// A mirror under a smooth coat at normal incidence, F = 0.04 and the metal's reflectance R against the layer's index:
// F + (1 - F)^2 T^2 R (1 + F T^2 R + ...) with T = exp(-t), as many terms as half of max_depth.
TEST(Layered, MirrorsUnderASmoothCoatAreSummedByPaperAndPencil) {
  LayeredWalk walk;
  walk.conductor = true;
  walk.n = 0.2;
  walk.kappa = 2.5;
  walk.thickness = 0.1;
  const double f = 0.04, r = reference::fresnel_conductor(0.2, 2.5, 1) * std::exp(-0.2);
  for (const int max_depth : {0, 1, 2, 5, 6}) {
    walk.max_depth = max_depth;
    double expected = f, term = (1 - f) * (1 - f) * r;
    for (int k = 0; k < max_depth / 2; ++k, term *= f * r) expected += term;
    for_each_target([&] {
      for (const BsdfResult& draw : run_sample_layered(walk, at(0), 20)) {
        EXPECT_NEAR(draw.value[0], expected, 2e-5) << max_depth;
        EXPECT_EQ(draw.pdf, 0) << "a delta lobe";
        EXPECT_NEAR(draw.wi[2], 1, 1e-6);
      }
      EXPECT_EQ(run_eval_layered(walk, at(0.5), at(0.5, 3.1), 1)[0].value[0], 0);
    });
  }
}

// Each lane alone and among others: the same bits.
TEST(Layered, LanesDoNotSeeEachOther) {
  const LayeredWalk walk = walk_of(settings[6]);
  for_each_target([&] {
    const std::vector<BsdfResult> many = run_sample_layered(walk, at(0.6), 100);
    for (size_t count = 1; count < 20; ++count) {
      const std::vector<BsdfResult> few = run_sample_layered(walk, at(0.6), count);
      EXPECT_EQ(few.back().value[0], many[count - 1].value[0]);
      EXPECT_EQ(few.back().wi[0], many[count - 1].wi[0]);
    }
  });
}

TEST(Layered, NothingIsReflectedToTheOtherSideOrSeenEdgeOn) {
  const LayeredWalk walk = walk_of(settings[2]);
  for_each_target([&] {
    EXPECT_EQ(run_eval_layered(walk, at(0.5), {0.6, 0, -0.8}, 1)[0].value[0], 0);
    EXPECT_EQ(run_eval_layered(walk, at(0.5), {0.6, 0, -0.8}, 1)[0].pdf, 0);
    for (const BsdfResult& draw : run_sample_layered(walk, {1, 0, 0}, 50)) EXPECT_EQ(draw.value[0], 0);
    for (const BsdfResult& draw : run_sample_layered(walk, {0.6, 0, -0.8}, 50)) {
      if (draw.value[0] == 0) continue;
      EXPECT_LT(draw.wi[2], 0) << "the side that is looked at";
    }
  });
}

}  // namespace
}  // namespace metamer::testing
