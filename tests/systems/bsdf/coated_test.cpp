// The coated material: values by paper and pencil, what it owes to energy, its limits; kernels against twins and
// samplers against densities, on every instruction set. Reciprocity: reciprocity_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/support/chi_square.h"
#include "tests/support/each_target.h"
#include "tests/systems/bsdf/cases.h"
#include "tests/systems/support/coat_kernels.h"

namespace metamer::testing {
namespace {
using reference::Direction;
constexpr double pi = std::numbers::pi, degree = pi / 180;

Direction at(double theta_degrees, double phi_degrees = 0) {
  const double t = theta_degrees * degree, p = phi_degrees * degree;
  return {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
}
void set(float to[3], const Direction& w) { to[0] = float(w.x), to[1] = float(w.y), to[2] = float(w.z); }
BsdfCase seen_from(const Direction& wo, double albedo, double eta) {
  BsdfCase c;
  set(c.wo, wo);
  std::fill(c.albedo, c.albedo + 4, float(albedo));
  std::fill(c.eta, c.eta + 4, float(eta));
  return c;
}

// Directions over the whole sphere, a third of them near the mirror's; half of the cases disperse.
std::vector<BsdfCase> random_coats(size_t count, const Coat& coat) {
  Random random(41);
  std::vector<BsdfCase> cases = random_metals(count);
  const double range = coat.rows.rows_per_eta > 0 ? (coat.rows.last_pair + 1) / double{coat.rows.rows_per_eta} : 0;
  for (BsdfCase& c : cases) {
    c.choice = random.uniform();
    const bool disperses = random.uniform() < 0.5f;
    for (int j = 0; j < 4; ++j)
      c.eta[j] = j > 0 && !disperses ? c.eta[0] : float(coat.rows.eta_least + range * random.uniform());
    if (random.uniform() < 0.1f) std::fill(c.albedo, c.albedo + 4, random.uniform() < 0.5f ? 0.0f : 1.0f);
    if (random.uniform() < 0.67f) continue;
    const double spread = 2 * coat.alpha;
    const Direction h =
        reference::normalize({spread * (random.uniform() - 0.5f), spread * (random.uniform() - 0.5f), 1});
    const Direction wo = direction(c.wo);
    set(c.wi, reference::normalize(reference::reflect({-wo.x, -wo.y, -wo.z}, h)));
  }
  return cases;
}
std::vector<Coat> some_coats() {
  std::vector<Coat> coats;
  for (const double alpha : {0.0, 0.002, 0.1, 0.7}) coats.emplace_back(alpha, 1.3, 1.75, alpha == 0.1);
  coats.emplace_back(0.0, 0.6, 0.8);
  coats.emplace_back(0.3, 0.6, 0.8);
  coats.emplace_back(0.0, 1.45, 1.45, true);
  coats.emplace_back(0.0, 0.0, 1.3, 1.75, Coat::Layered{0.1, 5});
  coats.emplace_back(0.0, 0.0, 0.6, 0.8, Coat::Layered{0.02, 1});
  coats.emplace_back(0.1, 0.4, 1.3, 1.75, Coat::Layered{0.5, 20});
  return coats;
}

// The integral of f_cos over the hemisphere, the mirror's delta apart; wo has y = 0 and x >= 0. Cells gather at grazing
// angles and around the mirror direction.
double albedo_of(const Coat& coat, const BsdfCase& c) {
  return integrate_rectangle(
      [&](double x, double y) {
        const double theta = pi / 2 * (1 - x * x), phi = pi * (1 - y * y);
        const Direction wi = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
        const double f_cos = reference::eval_coated(direction(c.wo), coat.optics(c), wi).f_cos[0];
        return f_cos * std::sin(theta) * pi * x * 4 * pi * y;
      },
      0, 1, 0, 1, 48);
}

// Reflectance 0.8 under eta 1.5, cos(theta_o) = 0.8: F = 0.0439, F_mean = 0.0918, F_inside = 0.5963, so that
// (1 - F) 0.8 (1 - F_inside) / (1 - 0.8 F_inside) = 0.9561 * 0.3229 / 0.5229 = 0.590.
TEST(Coated, TheBodyShowsTheAlbedoOfPaperAndPencil) {
  const Coat coat(0, 1.5, 1.5);
  const double theta = std::acos(0.8) / degree;
  const BsdfCase c = seen_from(at(theta), 0.8, 1.5);
  EXPECT_NEAR(albedo_of(coat, c), 0.590, 5e-4);
  EXPECT_NEAR(coat_fresnel(1.5, 0.8, false), 0.0439, 5e-5);
  // And so do the kernel's draws: the mirror's and the body's, apart.
  Random random(3);
  std::vector<BsdfCase> cases(400000, c);
  for (BsdfCase& draw : cases) draw.u = random.uniform(), draw.v = random.uniform(), draw.choice = random.uniform();
  for_each_target([&] {
    double body = 0, mirror = 0;
    for (const BsdfResult& draw : run_sample_coated(coat, cases))
      (draw.delta == 1 ? mirror : body) += draw.value[0] / double(cases.size());
    EXPECT_NEAR(body, 0.590, 2e-3);
    EXPECT_NEAR(mirror, 0.0439, 1e-3);
  });
}

TEST(Coated, AWhiteBodyUnderASmoothCoatReturnsAllLightFromEveryDirectionAtEveryEta) {
  for (const bool schlick : {false, true})
    for (const double eta : {0.7, 1.0, 1.0003, 1.333, 1.5, 2.4}) {
      const Coat coat(0, eta, eta, schlick);
      for (const double theta : {0.0, 30.0, 60.0, 80.0, 89.0}) {
        const BsdfCase c = seen_from(at(theta), 1, eta);
        const double mirror = coat_fresnel(double{c.eta[0]}, std::cos(theta * degree), schlick);
        EXPECT_NEAR(albedo_of(coat, c) + mirror, 1, eta < 1 ? 3e-3 : 3e-5) << eta << " at " << theta << " " << schlick;
      }
    }
}

TEST(Coated, AWhiteBodyUnderARoughCoatReturnsAllLight) {
  for (const double alpha : {0.1, 0.4, 1.0})
    for (const double eta : {1.333, 1.5, 2.0, 0.8}) {
      const Coat coat(alpha, eta, eta);
      for (const double theta : {0.0, 30.0, 60.0, 80.0, 88.0})
        EXPECT_NEAR(albedo_of(coat, seen_from(at(theta), 1, eta)), 1, 2.5e-3) << alpha << " " << eta << " at " << theta;
    }
}

TEST(Coated, ADarkerBodyReflectsLessAndABlackOneOnlyItsSurface) {
  for (const double alpha : {0.0, 0.2}) {
    const Coat coat(alpha, 1.5, 1.5);
    const double surface = alpha == 0 ? 0 : rough_coat_albedo(alpha, 1.5, false, std::cos(50 * degree));
    double last = 2;
    for (const double albedo : {1.0, 0.9, 0.5, 0.1, 0.0}) {
      const double all = albedo_of(coat, seen_from(at(50), albedo, 1.5));
      EXPECT_LT(all, last);
      last = all;
    }
    EXPECT_NEAR(last, surface, 1e-3);
  }
}

// Light of one index with the surroundings: the body alone.
TEST(Coated, ACoatOfAirIsNotThere) {
  for (const double alpha : {0.0, 0.3}) {
    const Coat coat(alpha, 1, 1);
    BsdfCase c = seen_from(at(35), 0.6, 1);
    for (const double theta : {0.0, 40.0, 85.0}) {
      set(c.wi, at(theta, 130));
      for_each_target([&] {
        const BsdfResult value = run_eval_coated(coat, {c})[0];
        EXPECT_NEAR(value.value[0], 0.6 / pi * std::cos(theta * degree), 1e-6);
        EXPECT_NEAR(value.pdf, std::cos(theta * degree) / pi, 1e-6);
      });
    }
  }
}

// As the roughness goes to 0 the body's part goes to that of the smooth coat, and the lobe's albedo to F.
TEST(Coated, ARoughCoatBecomesTheSmoothOne) {
  const Coat smooth(0, 1.5, 1.5);
  double last = 1;
  for (const double alpha : {0.1, 0.03, 0.01, 0.0011}) {
    const Coat rough(alpha, 1.5, 1.5);
    double largest = 0;
    for (const double theta : {0.0, 40.0, 70.0}) {
      BsdfCase c = seen_from(at(theta), 0.7, 1.5);
      set(c.wi, at(55, 90));  // far from the mirror direction
      const double f = run_eval_coated(rough, {c})[0].value[0], limit = run_eval_coated(smooth, {c})[0].value[0];
      largest = std::max(largest, std::abs(f / limit - 1));
    }
    EXPECT_LT(largest, last);
    last = largest;
  }
  EXPECT_LT(last, 2e-3);
}

// What the surface reflects has the light's colour, whatever the body's; without dispersion the same on every
// wavelength.
TEST(Coated, TheSurfaceIsWhiteAndTheBodyColoured) {
  const Coat coat(0.05, 1.5, 1.5);
  BsdfCase c = seen_from(at(50), 0, 1.5);
  set(c.wi, at(-50));
  const float surface = run_eval_coated(coat, {c})[0].value[0];
  c.albedo[0] = 0.9f, c.albedo[1] = 0.3f;
  const BsdfResult value = run_eval_coated(coat, {c})[0];
  EXPECT_GT(surface, 1);
  EXPECT_EQ(value.value[2], surface);
  EXPECT_EQ(value.value[3], surface);
  const auto body = [&](size_t j) { return double{value.value[j]} - surface; };
  EXPECT_GT(body(0), 3 * body(1));  // internal reflections deepen the colour
  EXPECT_LT(body(0), 0.3);
}

// A coat of glass that disperses reflects more on short wavelengths, each by its own eta.
TEST(Coated, EachWavelengthHasItsOwnEta) {
  const Coat coat(0, 1.4, 2.0);
  BsdfCase c = seen_from(at(20), 0.5, 1.5);
  set(c.wi, at(60, 40));
  const float etas[4] = {1.45f, 1.6f, 1.75f, 1.95f};
  std::copy_n(etas, 4, c.eta);
  const BsdfResult together = run_eval_coated(coat, {c})[0];
  for (int j = 0; j < 4; ++j) {
    BsdfCase alone = c;
    std::fill(alone.eta, alone.eta + 4, etas[j]);
    EXPECT_EQ(together.value[j], run_eval_coated(coat, {alone})[0].value[j]);
    if (j > 0) {
      EXPECT_LT(together.value[j], together.value[j - 1]);
    }
  }
}

TEST(Coated, EvaluationStaysWithinItsStatedError) {
  for (const Coat& coat : some_coats()) {
    const std::vector<BsdfCase> cases = random_coats(100000, coat);
    for_each_target([&] {
      const std::vector<BsdfResult> values = run_eval_coated(coat, cases);
      double worst = 0;
      for (size_t i = 0; i < cases.size(); ++i) {
        const BsdfCase& c = cases[i];
        const auto near_critical = [&](float eta) {
          const auto near = [&](float z) { return std::abs(eta * eta - 1 + z * z) < 1e-3f; };
          return coat.alpha == 0 && (near(c.wo[2]) || near(c.wi[2]));
        };
        if (std::any_of(c.eta, c.eta + 4, near_critical)) continue;
        const reference::BsdfValue value = reference::eval_coated(direction(c.wo), coat.optics(c), direction(c.wi));
        for (size_t j = 0; j < 5; ++j) {
          const double got = j < 4 ? values[i].value[j] : values[i].pdf, wanted = j < 4 ? value.f_cos[j] : value.pdf;
          const double stated = coat.alpha == 0 ? 2e-5 : 2e-5 + (6e-5 + 6e-7 / coat.alpha) * wanted;
          worst = std::max(worst, std::abs(got - wanted) / stated);
        }
      }
      EXPECT_LT(worst, 1) << coat.alpha << " " << coat.rows.eta_least;
    });
  }
}

TEST(Coated, SamplesStayWithinTheirStatedError) {
  for (const Coat& coat : some_coats()) {
    const std::vector<BsdfCase> cases = random_coats(60000, coat);
    for_each_target([&] {
      const std::vector<BsdfResult> draws = run_sample_coated(coat, cases);
      std::vector<BsdfCase> there = cases;
      for (size_t i = 0; i < cases.size(); ++i) std::copy_n(draws[i].wi, 3, there[i].wi);
      const std::vector<BsdfResult> values = run_eval_coated(coat, there);
      double error = 0, weight_error = 0;
      size_t other_lobe = 0, drawn = 0;
      for (size_t i = 0; i < cases.size(); ++i) {
        const BsdfCase& c = cases[i];
        const reference::BsdfSample sample =
            reference::sample_coated(direction(c.wo), coat.optics(c), c.choice, c.u, c.v);
        const Direction wi = direction(draws[i].wi);
        const double distance =
            std::max({std::abs(wi.x - sample.wi.x), std::abs(wi.y - sample.wi.y), std::abs(wi.z - sample.wi.z)});
        if ((draws[i].delta == 1) != sample.delta || distance > 1e-2) {
          ++other_lobe;  // the choice within rounding of the share
          continue;
        }
        error = std::max(error, distance);
        if (draws[i].pdf == 0) continue;
        ++drawn;
        if (sample.delta) {
          EXPECT_NEAR(draws[i].pdf, sample.pdf, 3e-5);
          for (size_t j = 0; j < 4; ++j)
            EXPECT_NEAR(draws[i].value[j], sample.weight[j], 1e-3 * (1 + sample.weight[j]));
          continue;
        }
        EXPECT_EQ(draws[i].pdf, values[i].pdf);
        for (size_t j = 0; j < 4; ++j)
          weight_error =
              std::max(weight_error, std::abs(double{draws[i].value[j]} * values[i].pdf - values[i].value[j]) /
                                         (1e-30 + values[i].value[j]));
      }
      EXPECT_LT(error, coat.alpha == 0 ? 1e-6 : 3e-5);
      EXPECT_LT(weight_error, 4e-7);
      EXPECT_LT(other_lobe, 6u);
      EXPECT_GT(drawn, cases.size() / 3);
    });
  }
}

// Every draw: the body's and a rough surface's against the pdf, a mirror's counted against its probability.
TEST(Coated, DrawsItsPdfAtEveryAngleAndRoughness) {
  std::vector<std::pair<Coat, double>> coats;
  for (const double eta : {1.5, 0.8}) {
    for (const double alpha : {0.0, 0.15, 0.4, 1.0}) coats.emplace_back(Coat(alpha, eta, eta), eta);
    coats.emplace_back(Coat(0, 0, eta, eta, Coat::Layered{0.2, 5}), eta);
    coats.emplace_back(Coat(0.15, 0.5, eta, eta, Coat::Layered{0.2, 5}), eta);
  }
  for (const auto& [coat, eta] : coats)
    for (const double theta : {0.0, 45.0, 85.0}) {
      Direction wo = at(theta, 25);
      if (eta < 1) wo.z = -wo.z;
      const BsdfCase c = seen_from(wo, 0.5, eta);
      Random random(17);
      std::vector<BsdfCase> cases(100000, c);
      for (BsdfCase& draw : cases) draw.u = random.uniform(), draw.v = random.uniform(), draw.choice = random.uniform();
      const double share = coat_fresnel(eta, std::cos(theta * degree), false);
      for_each_target([&] {
        DirectionHistogram histogram(32, 24);
        double mirrored = 0;
        for (const BsdfResult& draw : run_sample_coated(coat, cases)) {
          if (draw.delta == 1) {
            ++mirrored;
            EXPECT_NEAR(draw.value[0] * draw.pdf, share, 2e-3);
            histogram.reject();
          } else if (draw.pdf > 0) {
            histogram.add(draw.wi[0], draw.wi[1], draw.wi[2]);
          } else {
            histogram.reject();
          }
        }
        const auto pdf = [&](double x, double y, double z) {
          return reference::eval_coated(direction(c.wo), coat.optics(c), {x, y, z}).pdf;
        };
        if (mirrored == double(cases.size())) return;  // all is totally reflected
        const ChiSquare result = histogram.test(pdf, 6);
        EXPECT_GT(result.p_value, chi_square_level) << coat.alpha << " " << eta << " at " << theta;
        EXPECT_GT(result.degrees_of_freedom, 10);
      });
    }
}

TEST(Coated, BothSidesAreAlikeAndWhatIsSeenEdgeOnReflectsNothing) {
  for (const Coat& coat : some_coats()) {
    const std::vector<BsdfCase> cases = random_coats(5000, coat);
    std::vector<BsdfCase> below = cases, edge_on = cases;
    for (BsdfCase& c : below) c.wo[2] = -c.wo[2], c.wi[2] = -c.wi[2];
    for (BsdfCase& c : edge_on) c.wo[0] = 1, c.wo[1] = 0, c.wo[2] = 0;
    for_each_target([&] {
      for (const auto run : {run_eval_coated, run_sample_coated}) {
        const std::vector<BsdfResult> up = run(coat, cases), down = run(coat, below);
        for (size_t i = 0; i < cases.size(); ++i) {
          for (size_t j = 0; j < 4; ++j) EXPECT_EQ(up[i].value[j], down[i].value[j]);
          EXPECT_EQ(up[i].pdf, down[i].pdf);
          EXPECT_EQ(up[i].wi[2], -down[i].wi[2]);
        }
        for (const BsdfResult& result : run(coat, edge_on)) {
          for (const float value : result.value) EXPECT_EQ(value, 0.0f);
          EXPECT_EQ(result.pdf, 0.0f);
        }
      }
    });
  }
}

// Each case among lanes of rubbish and alone: the same bits.
TEST(Coated, LanesDoNotSeeEachOther) {
  for (const Coat& coat : some_coats()) {
    const std::vector<BsdfCase> cases = random_coats(600, coat);
    std::vector<BsdfCase> mixed;
    for (const BsdfCase& c : cases) {
      mixed.push_back(c);
      BsdfCase rubbish = c;
      rubbish.wo[2] = std::nanf(""), rubbish.eta[1] = -std::nanf(""), rubbish.albedo[0] = 1e38f;
      mixed.push_back(rubbish);
      rubbish.wo[2] = 1e30f, rubbish.eta[1] = 1e38f, rubbish.eta[2] = -1e38f;
      mixed.push_back(rubbish);
    }
    for_each_target([&] {
      for (const auto run : {run_eval_coated, run_sample_coated}) {
        const std::vector<BsdfResult> clean = run(coat, cases), among = run(coat, mixed);
        for (size_t i = 0; i < cases.size(); ++i) {
          const BsdfResult alone = run(coat, {cases[i]})[0];
          for (size_t j = 0; j < 4; ++j) {
            EXPECT_EQ(clean[i].value[j], among[3 * i].value[j]);
            EXPECT_EQ(clean[i].value[j], alone.value[j]);
          }
          EXPECT_EQ(clean[i].pdf, among[3 * i].pdf);
          EXPECT_EQ(clean[i].pdf, alone.pdf);
        }
      }
    });
  }
}

}  // namespace
}  // namespace metamer::testing
