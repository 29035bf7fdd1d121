// Light may travel either way through every BSDF but the taught Phong-Blinn, whose breach Rough.TheTaughtFormBreaks-
// Reciprocity and Rough.TheTaughtFormCreatesEnergy (rough_test.cpp) put in numbers. Kernels, on every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "tests/support/each_target.h"
#include "tests/systems/bsdf/cases.h"
#include "tests/systems/support/coat_kernels.h"

namespace metamer::testing {
namespace {

using reference::Direction;
using Cases = std::vector<BsdfCase>;
using Evaluate = std::function<std::vector<BsdfResult>(const Cases&)>;

// What each kernel's cases need beside what random_metals sets; it is called in the order of the cases.
using Prepare = std::function<void(BsdfCase&, Random&)>;
void keep(BsdfCase&, Random&) {}
void normalise(BsdfCase& c, Random& random) {
  for (float& ks : c.ks) ks = random.uniform();
  c.shininess = random.uniform() < 0.1f ? 0 : std::pow(1000.0f, random.uniform()) - 1;
  c.normalized = 1;
}
void let_through(BsdfCase& c, Random& random) {
  for (float& transmittance : c.ks) transmittance = random.uniform();
}
// Indices of coats from `least` to `most`; in half of the cases all wavelengths share one.
Prepare cover(float least, float most) {
  return [=](BsdfCase& c, Random& random) {
    const bool disperses = random.uniform() < 0.5f;
    for (int j = 0; j < 4; ++j) c.eta[j] = j > 0 && !disperses ? c.eta[0] : least + (most - least) * random.uniform();
  };
}
void fill_with_air_or_glass(BsdfCase& c, Random& random) {
  const bool is_denser = random.uniform() < 0.7f;
  for (float& eta : c.eta) eta = is_denser ? 1.05f + 1.4f * random.uniform() : 0.95f - 0.5f * random.uniform();
  c.alpha_x = 0.02f + 0.98f * random.uniform() * random.uniform();
  c.alpha_y = random.uniform() < 0.5f ? c.alpha_x : 0.02f + 0.98f * random.uniform();
  c.schlick = random.uniform() < 0.3f ? 1 : 0;
  c.dispersive = random.uniform() < 0.5f ? 1 : 0;
}
void polish(BsdfCase& c, Random&) { c.alpha_x = c.alpha_y = 0; }

// Directions over the whole sphere, in half of the cases about a mirror's or, past the surface, nearly straight on.
Cases random_cases(size_t count, const Prepare& prepare) {
  Random random(43);
  Cases cases = random_metals(count);
  for (BsdfCase& c : cases) {
    prepare(c, random);
    if (random.uniform() < 0.5f) continue;
    const float spread = random.uniform() * random.uniform(), side = random.uniform() < 0.5f ? 1.0f : -1.0f;
    const Direction h =
        reference::normalize({spread * (random.uniform() - 0.5f), spread * (random.uniform() - 0.5f), 1});
    const Direction wo = direction(c.wo);
    const Direction wi = reference::normalize(reference::reflect({-wo.x, -wo.y, -wo.z}, h));
    c.wi[0] = float(wi.x), c.wi[1] = float(wi.y), c.wi[2] = float(side * wi.z);
  }
  return cases;
}
double larger(double error, double worst) { return error <= worst ? worst : error; }  // NaN stays
double index(const BsdfCase& c, size_t j, float z) { return z < 0 ? double{c.eta[c.dispersive == 1 ? j : 0]} : 1; }

// f(wo, wi) / n_o^2 = f(wi, wo) / n_i^2 with the index n on the side of each direction: Veach, Robust Monte Carlo
// Methods for Light Transport Simulation, 1997, equation 5.14. On one side of the surface f is symmetric.
TEST(Reciprocity, OfEveryLobeThatSpreads) {
  struct Row {
    const char* name;
    Evaluate eval;
    Prepare prepare;
    double tolerance, floor;  // relative to f, and to this where f is smaller
    bool transmits = false, is_sheet = false;
  };
  const Coat smooth(0, 1.3, 1.7), smooth_schlick(0, 1.3, 1.7, true), smooth_thin(0, 0.6, 0.8);
  const Coat fine(0.002, 1.3, 1.7), rough(0.1, 1.3, 1.7), dull_schlick(0.7, 1.3, 1.7, true), rough_thin(0.3, 0.6, 0.8);
  const Coat layered(0, 0, 1.3, 1.7, Coat::Layered{0.1, 5});
  const Coat uneven(0.1, 0.3, 1.3, 1.7, Coat::Layered{0.1, 5});
  const auto covered = [](const Coat& coat) { return [&](const Cases& c) { return run_eval_coated(coat, c); }; };
  const Prepare dense = cover(1.3f, 1.7f), thin = cover(0.6f, 0.8f);
  const Row rows[] = {{"diffuse", run_eval_diffuse, keep, 3e-6, 1e-24},
                      {"sheet", run_eval_sheet, let_through, 3e-6, 1e-24, false, true},
                      {"coat over a layer", covered(layered), dense, 4e-6, 1e-24},
                      {"rough coat over a layer, anisotropic", covered(uneven), dense, 4e-6, 1e-24},
                      {"rough, normalised", run_eval_rough, normalise, 3e-6, 1e-24},
                      {"conductor", run_eval_conductor, keep, 3e-6, 1e-24},
                      {"smooth coat's body", covered(smooth), dense, 4e-6, 1e-24},
                      {"smooth coat's body, Schlick", covered(smooth_schlick), dense, 4e-6, 1e-24},
                      {"smooth coat's body, thinner than air", covered(smooth_thin), thin, 4e-6, 1e-24},
                      {"coat of fine roughness", covered(fine), dense, 4e-6, 1e-24},
                      {"rough coat", covered(rough), dense, 4e-6, 1e-24},
                      {"rough coat, thinner than air", covered(rough_thin), thin, 4e-6, 1e-24},
                      {"dull coat, Schlick", covered(dull_schlick), dense, 4e-6, 1e-24},
                      {"rough dielectric", run_eval_rough_dielectric, fill_with_air_or_glass, 1e-2, 1e-2, true}};
  for (const Row& row : rows) {
    const Cases cases = random_cases(50000, row.prepare);
    Cases swapped = cases;
    for (BsdfCase& c : swapped) std::swap_ranges(c.wo, c.wo + 3, c.wi);
    for_each_target([&] {
      const std::vector<BsdfResult> there = row.eval(cases), back = row.eval(swapped);
      size_t reflecting = 0, across = 0;
      double worst = 0;
      for (size_t i = 0; i < cases.size(); ++i)
        for (size_t j = 0; j < 4; ++j) {
          const BsdfCase& c = cases[i];
          const double n_o = row.transmits ? index(c, j, c.wo[2]) : 1, n_i = row.transmits ? index(c, j, c.wi[2]) : 1;
          const double f = there[i].value[j] / std::abs(double{c.wi[2]}) / (n_o * n_o);
          const double b = back[i].value[j] / std::abs(double{c.wo[2]}) / (n_i * n_i);
          worst = larger(std::abs(f - b) / std::max({f, b, row.floor}), worst);
          if (f > 0) ++(c.wo[2] * c.wi[2] > 0 ? reflecting : across);
        }
      EXPECT_LT(worst, row.tolerance) << row.name;
      EXPECT_GT(reflecting, cases.size() / 4) << row.name;
      if (row.transmits || row.is_sheet) {
        EXPECT_GT(across, cases.size() / 4) << row.name;
      } else {
        EXPECT_EQ(across, 0u) << row.name;
      }
    });
  }
}

// A delta lobe of a share S leads back to where it came from. Along a beam n^2 cos(theta) d omega stays the same, with
// which Veach's equation becomes S(wo) n_i^2 / n_o^2 = S(wi) n_o^2 / n_i^2; for mirrors S is symmetric. (The
// thin plate's kernel is given |cos(theta_o)| alone: it has no way to tell the two ways apart.)
TEST(Reciprocity, OfEveryLobeOfOneDirection) {
  struct Row {
    const char* name;
    Evaluate sample;
    Prepare prepare;
    bool refracts = false;
  };
  const Coat coat(0, 1.3, 1.7);
  const auto covered = [&](const Cases& c) { return run_sample_coated(coat, c); };
  const Row rows[] = {{"mirror", run_sample_conductor, polish},
                      {"smooth coat's mirror", covered, cover(1.3f, 1.7f)},
                      {"dielectric", run_sample_dielectric, fill_with_air_or_glass, true}};
  for (const Row& row : rows) {
    Cases cases = random_cases(50000, row.prepare);
    for (size_t i = 0; i < cases.size(); ++i) {
      cases[i].choice = 0;
      cases[i].u = i % 2 == 0 ? 0 : 0x1.fffffep-1f;  // each lobe wherever there are two
    }
    for_each_target([&] {
      const std::vector<BsdfResult> there = row.sample(cases);
      Cases reversed = cases;
      for (size_t i = 0; i < cases.size(); ++i) std::copy_n(there[i].wi, 3, reversed[i].wo);
      const std::vector<BsdfResult> back = row.sample(reversed);
      double worst_share = 0, worst_direction = 0;
      size_t compared = 0, across = 0;
      for (size_t i = 0; i < cases.size(); ++i) {
        const BsdfCase& c = cases[i];
        // At grazing angles and near the critical one a rounding of the direction is a large step of F.
        if (std::min(std::abs(c.wo[2]), std::abs(there[i].wi[2])) < 0.05f) continue;
        if (there[i].pdf == 0 || there[i].transmitted != back[i].transmitted) continue;
        ++compared;
        if (there[i].transmitted == 1) ++across;
        for (int axis = 0; axis < 3; ++axis)
          worst_direction = larger(std::abs(double{back[i].wi[axis]} - double{c.wo[axis]}), worst_direction);
        const auto squared = [&](float z) { return row.refracts ? std::pow(index(c, 0, z), 2) : 1; };
        const double n_o2 = squared(c.wo[2]), n_i2 = squared(there[i].wi[2]);
        for (size_t j = 0; j < 4; ++j) {
          const double s = double{there[i].value[j]} * double{there[i].pdf} * n_i2 / n_o2;
          const double b = double{back[i].value[j]} * double{back[i].pdf} * n_o2 / n_i2;
          worst_share = larger(std::abs(s - b), worst_share);
        }
      }
      EXPECT_LT(worst_share, 2e-4) << row.name;
      EXPECT_LT(worst_direction, 2e-5) << row.name;
      EXPECT_GT(compared, cases.size() * 3 / 4) << row.name;
      if (row.refracts) {
        EXPECT_GT(across, cases.size() / 4) << row.name;
      } else {
        EXPECT_EQ(across, 0u) << row.name;
      }
    });
  }
}

}  // namespace
}  // namespace metamer::testing
