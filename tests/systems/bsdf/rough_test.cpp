// The rough material: the taught formula's values, where it breaks reciprocity and energy, and its normalised form's
// promises; kernels against twins and samplers against densities, on every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "systems/bsdf/reference.h"
#include "tests/support/chi_square.h"
#include "tests/support/each_target.h"
#include "tests/systems/bsdf/cases.h"
#include "tests/systems/support/bsdf_kernels.h"

namespace metamer::testing {
namespace {
using reference::Direction;
using reference::RoughOptics;
constexpr double pi = std::numbers::pi, degree = pi / 180;

RoughOptics optics(const BsdfCase& c) { return {spectrum(c.albedo), spectrum(c.ks), c.shininess, c.normalized == 1}; }
Direction at(double theta_degrees, double phi_degrees = 0) {
  const double t = theta_degrees * degree, p = phi_degrees * degree;
  return {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
}
void set(float to[3], const Direction& w) { to[0] = float(w.x), to[1] = float(w.y), to[2] = float(w.z); }

BsdfCase rough_case(double kd, double ks, double shininess, bool normalized) {
  BsdfCase c;
  for (float& x : c.albedo) x = float(kd);
  for (float& x : c.ks) x = float(ks);
  c.shininess = float(shininess), c.normalized = normalized ? 1 : 0;
  return c;
}

// Directions over the whole sphere, half of them near the glossy peak; both forms.
std::vector<BsdfCase> random_rough(size_t count, float largest_exponent) {
  Random random(31);
  std::vector<BsdfCase> cases = random_metals(count);
  for (BsdfCase& c : cases) {
    c.shininess = random.uniform() < 0.1f ? 0 : std::pow(largest_exponent, random.uniform()) - 1;
    c.normalized = random.uniform() < 0.5f ? 1 : 0;
    c.choice = random.uniform();
    for (float& ks : c.ks) ks = 2 * random.uniform();
    if (random.uniform() < 0.2f) std::fill(c.albedo, c.albedo + 4, 0.0f);
    if (random.uniform() < 0.2f) std::fill(c.ks, c.ks + 4, 0.0f);
    if (random.uniform() < 0.5f) continue;
    const float spread = std::sqrt(2 / (c.shininess + 2));
    const Direction h =
        reference::normalize({spread * (random.uniform() - 0.5f), spread * (random.uniform() - 0.5f), 1});
    const Direction wo = direction(c.wo);
    set(c.wi, reference::normalize(reference::reflect({-wo.x, -wo.y, -wo.z}, h)));
  }
  return cases;
}

// L / L_in = kd cos(theta_i) + ks cos^shininess(delta), by hand: in the plane of incidence delta is half of what the
// angles of light and viewer differ.
TEST(Rough, TheTaughtFormulaHasTheValuesOfPaperAndPencil) {
  struct Value {
    double theta_i, theta_o, kd, ks, shininess, radiance;
  };
  const Value values[] = {
      {0, 0, 0.2, 0.5, 10, 0.7},                                        // cos 0 = 1, delta = 0
      {60, -60, 0.2, 0.5, 10, 0.6},                                     // the mirror direction: 0.2 / 2 + 0.5
      {60, 0, 0, 1, 2, 0.75},                                           // delta = 30: cos^2 = 3/4
      {0, 60, 0, 1, 2, 0.75},                                           // and the same the other way round
      {60, 60, 0, 1, 2, 0.25},                                          // back towards the light: delta = 60
      {45, 45, 0, 1, 4, 0.25},                                          // cos^4(45) = 1/4
      {60, 30, 0.1, 2, 0, 0.05 + 2},                                    // exponent 0: the same everywhere
      {80, 0, 0.3, 0.25, 50, 0.3 * 0.173648178 + 0.25 * 1.6414966e-6},  // cos 40 = 0.766044443
      {85, -85, 0, 0.5, 1000, 0.5},                                     // grazing, and no cosine on the glossy term
  };
  for (const Value& v : values) {
    BsdfCase c = rough_case(v.kd, v.ks, v.shininess, false);
    set(c.wi, at(v.theta_i)), set(c.wo, at(v.theta_o));
    EXPECT_NEAR(reference::eval_rough(at(v.theta_o), optics(c), at(v.theta_i)).f_cos[0], v.radiance, 1e-7);
    for_each_target([&] {
      const BsdfResult value = run_eval_rough({c})[0];
      for (const float f_cos : value.value)
        EXPECT_NEAR(f_cos, v.radiance, 2e-6) << v.theta_i << " " << v.theta_o << " " << v.shininess;
    });
  }
}

TEST(Rough, LightFromBehindTheSurfaceGivesNothing) {
  for (const bool normalized : {false, true}) {
    std::vector<BsdfCase> cases;
    for (const double theta_i : {90.5, 100.0, 135.0, 179.0}) {
      cases.push_back(rough_case(0.2, 0.5, 3, normalized));
      set(cases.back().wi, at(theta_i)), set(cases.back().wo, at(-80));
    }
    for (const BsdfCase& c : cases)
      EXPECT_EQ(reference::eval_rough(direction(c.wo), optics(c), direction(c.wi)).pdf, 0);
    for_each_target([&] {
      for (const BsdfResult& value : run_eval_rough(cases)) {
        EXPECT_EQ(value.pdf, 0.0f);
        for (const float f_cos : value.value) EXPECT_EQ(f_cos, 0.0f);
      }
    });
  }
}

TEST(Rough, EvaluationStaysWithinItsStatedError) {
  for (const float largest : {1000.0f, 1e6f}) {
    const std::vector<BsdfCase> cases = random_rough(200000, largest);
    for_each_target([&] {
      const std::vector<BsdfResult> values = run_eval_rough(cases);
      double worst = 0;
      for (size_t i = 0; i < cases.size(); ++i) {
        const BsdfCase& c = cases[i];
        const Direction wo = direction(c.wo), wi = direction(c.wi);
        const reference::BsdfValue value = reference::eval_rough(wo, optics(c), wi);
        if (value.pdf == 0) {
          EXPECT_EQ(values[i].pdf, 0.0f) << i;
        }
        const Direction h = reference::normalize({wo.x + wi.x, wo.y + wi.y, wo.z + wi.z});
        const double x = -c.shininess * std::log(std::max(std::abs(h.z), 1e-300));
        const double stated = 2e-6 * (1 + x) + (c.shininess > 1000 ? 2e-7 * std::sqrt(c.shininess) * (1 + x) : 0);
        for (size_t j = 0; j < 5; ++j) {
          const double got = j < 4 ? values[i].value[j] : values[i].pdf, wanted = j < 4 ? value.f_cos[j] : value.pdf;
          if (wanted > 1e-30) worst = std::max(worst, std::abs(got / wanted - 1) / stated);
        }
      }
      EXPECT_LT(worst, 1) << largest;
    });
  }
}

TEST(Rough, SamplesStayWithinTheirStatedError) {
  const std::vector<BsdfCase> cases = random_rough(200000, 1e6f);
  for_each_target([&] {
    const std::vector<BsdfResult> draws = run_sample_rough(cases), values = [&] {
      std::vector<BsdfCase> there = cases;
      for (size_t i = 0; i < cases.size(); ++i) std::copy_n(run_sample_rough({cases[i]})[0].wi, 3, there[i].wi);
      return run_eval_rough(there);
    }();
    double error = 0, weight_error = 0;
    size_t other_lobe = 0, drawn = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
      const BsdfCase& c = cases[i];
      const reference::BsdfSample sample = reference::sample_rough(direction(c.wo), optics(c), c.choice, c.u, c.v);
      const Direction wi = direction(draws[i].wi);
      const double distance =
          std::max({std::abs(wi.x - sample.wi.x), std::abs(wi.y - sample.wi.y), std::abs(wi.z - sample.wi.z)});
      if (distance > 1e-3)
        ++other_lobe;  // the choice within rounding of the share
      else
        error = std::max(error, distance);
      EXPECT_EQ(draws[i].pdf, values[i].pdf);
      if (draws[i].pdf == 0) continue;
      ++drawn;
      for (size_t j = 0; j < 4; ++j)
        weight_error =
            std::max(weight_error, std::abs(draws[i].value[j] / (values[i].value[j] / double{values[i].pdf}) - 1));
    }
    EXPECT_LT(error, 1e-5);
    EXPECT_LT(weight_error, 3e-7);
    EXPECT_LT(other_lobe, 5u);
    EXPECT_GT(drawn, cases.size() / 2);
  });
}

TEST(Rough, DrawsItsPdfAtEveryAngleAndShininess) {
  for (const bool normalized : {false, true})
    for (const double shininess : {0.0, 1.0, 20.0, 300.0})
      for (const double theta : {0.0, 40.0, 80.0})
        for (const auto& [kd, ks] : {std::pair{0.1, 0.4}, {0.0, 0.3}}) {
          BsdfCase c = rough_case(kd, ks, shininess, normalized);
          const double side = shininess == 20 ? -1 : 1;
          Direction wo = at(theta, 25);
          wo.z *= side;
          set(c.wo, wo);
          Random random(17);
          std::vector<BsdfCase> cases(100000, c);
          for (BsdfCase& draw : cases)
            draw.u = random.uniform(), draw.v = random.uniform(), draw.choice = random.uniform();
          for_each_target([&] {
            DirectionHistogram histogram(32, 24);
            for (const BsdfResult& draw : run_sample_rough(cases)) {
              if (draw.pdf > 0)
                histogram.add(draw.wi[0], draw.wi[1], draw.wi[2]);
              else
                histogram.reject();
            }
            const auto pdf = [&](double x, double y, double z) {
              return reference::eval_rough(direction(c.wo), optics(c), {x, y, z}).pdf;
            };
            const ChiSquare result = histogram.test(pdf, 6);
            EXPECT_GT(result.p_value, chi_square_level)
                << normalized << " shininess " << shininess << " at " << theta << ", kd " << kd;
            EXPECT_GT(result.degrees_of_freedom, 10);
          });
        }
}

// What a surface in light of 1 from everywhere shows, by quadrature of the scalar twin; the polar angle is taken about
// the mirror direction's, so that narrow lobes are met.
double albedo(const BsdfCase& c, double theta_o) {
  const Direction wo = at(theta_o);
  return integrate_rectangle(
      [&](double theta, double phi) {
        const Direction wi = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
        return reference::eval_rough(wo, optics(c), wi).f_cos[0] * std::sin(theta);
      },
      0, pi / 2, 0, 2 * pi, 200);
}

// The energy at normal view in closed form; see rough-inl.h. And the sampler's weights average to it.
TEST(Rough, TheTaughtFormReflectsWhatTheWarningSays) {
  for (const double shininess : {0.0, 1.0, 10.0, 200.0}) {
    const BsdfCase c = rough_case(0.1, 0.3, shininess, false);
    const double s = shininess + 2;
    const double expected = pi * 0.1 + 8 * pi * 0.3 * (1 - std::pow(2, -s / 2)) / s;
    EXPECT_NEAR(albedo(c, 0), expected, 1e-6 * expected) << shininess;
    Random random(9);
    std::vector<BsdfCase> cases(200000, c);
    for (BsdfCase& draw : cases) draw.u = random.uniform(), draw.v = random.uniform(), draw.choice = random.uniform();
    for_each_target([&] {
      double sum = 0, squares = 0;
      const std::vector<BsdfResult> draws = run_sample_rough(cases);
      for (const BsdfResult& draw : draws) sum += draw.value[0], squares += double{draw.value[0]} * draw.value[0];
      const double n = double(draws.size()), mean = sum / n, deviation = std::sqrt((squares / n - mean * mean) / n);
      EXPECT_NEAR(mean, expected, 4.5 * deviation + 1e-6) << shininess;
      EXPECT_LT(deviation, 0.01 * expected);
    });
  }
}

// f = f_cos / cos(theta_i): with light at 0 and viewer at 80 degrees 1 / cos 80 = 5.76 times less than exchanged.
TEST(Rough, TheTaughtFormBreaksReciprocity) {
  const BsdfCase c = rough_case(0, 1, 10, false);
  const double there = reference::eval_rough(at(80), optics(c), at(0)).f_cos[0] / std::cos(0.0);
  const double back = reference::eval_rough(at(0), optics(c), at(80)).f_cos[0] / std::cos(80 * degree);
  EXPECT_NEAR(back / there, 5.7588, 1e-4);
}

// ks = 1 of a dull surface: 8 pi (1 - 2^-1.5) / 3 times the light of its surroundings at shininess 1.
TEST(Rough, TheTaughtFormCreatesEnergy) {
  EXPECT_NEAR(albedo(rough_case(0, 1, 1, false), 0), 5.41566, 1e-5);
  EXPECT_NEAR(albedo(rough_case(1, 0, 1, false), 60), pi, 1e-6);
}

TEST(Rough, NormalisedNeverReflectsMoreThanItsAlbedos) {
  for (const double shininess : {0.0, 1.0, 5.0, 50.0, 500.0}) {
    double largest = 0;
    for (double theta = 0; theta < 90; theta += 7.4) {
      const double got = albedo(rough_case(0.25, 0.75, shininess, true), theta);
      EXPECT_LE(got, 1 + 1e-6) << shininess << " at " << theta;
      EXPECT_GE(got, 0.25);
      largest = std::max(largest, got);
    }
    if (shininess == 500) {
      EXPECT_GT(largest, 0.98);  // a narrow lobe loses little
    }
  }
}

TEST(Rough, NormalisedDrawsWeighNoMoreThanTheAlbedosWhereWavelengthsAgree) {
  std::vector<BsdfCase> cases = random_rough(200000, 1e5f);
  for (BsdfCase& c : cases) {
    c.normalized = 1;
    std::fill(c.albedo, c.albedo + 4, c.albedo[0]);
    std::fill(c.ks, c.ks + 4, 1 - c.albedo[0]);
  }
  for_each_target([&] {
    for (const BsdfResult& draw : run_sample_rough(cases))
      for (const float weight : draw.value) EXPECT_LE(weight, 1 + 1e-6f);
  });
}

}  // namespace
}  // namespace metamer::testing
