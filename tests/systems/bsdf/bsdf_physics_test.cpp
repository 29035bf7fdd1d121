// What every BSDF owes to physics and to its neighbours: energy, mirrors that mirror, wavelengths and lanes that do not
// see each other. Reciprocity: reciprocity_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "systems/bsdf/reference.h"
#include "tests/support/each_target.h"
#include "tests/systems/bsdf/cases.h"
#include "tests/systems/support/bsdf_kernels.h"

namespace metamer::testing {
namespace {

struct Kernel {
  const char* name;
  std::vector<BsdfResult> (*run)(const std::vector<BsdfCase>&);
};
const Kernel kernels[] = {{"eval_diffuse", run_eval_diffuse},
                          {"sample_diffuse", run_sample_diffuse},
                          {"eval_conductor", run_eval_conductor},
                          {"sample_conductor", run_sample_conductor},
                          {"sample_dielectric", run_sample_dielectric},
                          {"eval_rough", run_eval_rough},
                          {"sample_rough", run_sample_rough}};

// For the rough kernels, beside what random_metals sets.
std::vector<BsdfCase> random_reflectors(size_t count) {
  Random random(29);
  std::vector<BsdfCase> cases = random_metals(count);
  for (BsdfCase& c : cases) {
    for (float& ks : c.ks) ks = random.uniform();
    c.shininess = 200 * random.uniform() * random.uniform();
    c.normalized = random.uniform() < 0.5f ? 1 : 0;
    c.choice = random.uniform();
  }
  return cases;
}

bool same_bytes(const BsdfResult& a, const BsdfResult& b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }

TEST(BsdfPhysics, NoDrawReflectsMoreThanItReceives) {
  const std::vector<BsdfCase> cases = random_metals(200000);
  for_each_target([&] {
    for (const Kernel& kernel : {kernels[1], kernels[3]}) {
      for (const BsdfResult& draw : kernel.run(cases)) {
        for (const float weight : draw.value) EXPECT_TRUE(weight >= 0 && weight <= 1) << kernel.name << " " << weight;
      }
    }
  });
}

TEST(BsdfPhysics, AWhiteMirrorReturnsExactlyWhatItReceives) {
  std::vector<BsdfCase> cases = random_metals(10000);
  for (BsdfCase& c : cases) {
    c.alpha_x = c.alpha_y = 0.0009f;  // just smooth
    for (float& kappa : c.kappa) kappa = 1e8f;
  }
  for_each_target([&] {
    const std::vector<BsdfResult> draws = run_sample_conductor(cases), values = run_eval_conductor(cases);
    for (size_t i = 0; i < cases.size(); ++i) {
      EXPECT_EQ(draws[i].wi[0], -cases[i].wo[0]);
      EXPECT_EQ(draws[i].wi[1], -cases[i].wo[1]);
      EXPECT_EQ(draws[i].wi[2], cases[i].wo[2]);
      for (const float weight : draws[i].value) EXPECT_EQ(weight, 1.0f);
      EXPECT_EQ(draws[i].pdf, 1.0f);
      EXPECT_EQ(draws[i].delta, 1.0f);
      for (const float f_cos : values[i].value) EXPECT_EQ(f_cos, 0.0f);
      EXPECT_EQ(values[i].pdf, 0.0f);
    }
  });
}

TEST(BsdfPhysics, BothSidesOfAReflectorAreAlike) {
  const std::vector<BsdfCase> cases = random_reflectors(20000);
  std::vector<BsdfCase> below = cases;
  for (BsdfCase& c : below) c.wo[2] = -c.wo[2], c.wi[2] = -c.wi[2];
  for_each_target([&] {
    for (const size_t k : {0u, 1u, 2u, 3u, 5u, 6u}) {
      const std::vector<BsdfResult> up = kernels[k].run(cases);
      std::vector<BsdfResult> down = kernels[k].run(below);
      for (size_t i = 0; i < cases.size(); ++i) {
        if (k == 1 || k == 3 || k == 6) down[i].wi[2] = -down[i].wi[2];
        EXPECT_TRUE(same_bytes(up[i], down[i])) << kernels[k].name;
      }
    }
  });
}

TEST(BsdfPhysics, WhatIsSeenEdgeOnReflectsNothing) {
  std::vector<BsdfCase> cases = random_reflectors(1000);
  for (BsdfCase& c : cases) c.wo[0] = 1, c.wo[1] = 0, c.wo[2] = 0;
  for_each_target([&] {
    for (const Kernel& kernel : {kernels[0], kernels[2], kernels[3], kernels[5], kernels[6]}) {
      for (const BsdfResult& result : kernel.run(cases)) {
        for (const float value : result.value) EXPECT_EQ(value, 0.0f) << kernel.name;
        EXPECT_EQ(result.pdf, 0.0f) << kernel.name;
      }
    }
  });
}

TEST(BsdfPhysics, WavelengthsDoNotSeeEachOther) {
  const std::vector<BsdfCase> cases = random_metals(20000);
  std::vector<BsdfCase> changed = cases;
  for (BsdfCase& c : changed) c.eta[2] = 0.3f, c.kappa[2] = 9, c.albedo[2] = 0.123f;
  for_each_target([&] {
    for (size_t k = 0; k < 4; ++k) {
      const std::vector<BsdfResult> a = kernels[k].run(cases);
      std::vector<BsdfResult> b = kernels[k].run(changed);
      size_t differing = 0;
      for (size_t i = 0; i < cases.size(); ++i) {
        if (a[i].value[2] != b[i].value[2]) ++differing;
        b[i].value[2] = a[i].value[2];
        EXPECT_TRUE(same_bytes(a[i], b[i])) << kernels[k].name;
      }
      EXPECT_GT(differing, 0u) << kernels[k].name;
    }
  });
}

TEST(BsdfPhysics, LanesDoNotSeeEachOther) {
  std::vector<BsdfCase> cases = random_reflectors(5000);
  Random random(23);
  for (BsdfCase& c : cases) c.dispersive = random.uniform() < 0.5f ? 1 : 0;
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  std::vector<BsdfCase> among_garbage;
  for (const BsdfCase& c : cases) {
    among_garbage.push_back(c);
    // One to three dead lanes of all sorts after each live one, so that live ones meet every lane.
    for (int dead = 0; dead < 1 + int(3 * random.uniform()); ++dead) {
      BsdfCase garbage;
      float fields[sizeof(BsdfCase) / sizeof(float)];
      for (float& field : fields) {
        const float kind = random.uniform();
        field = kind < 0.3f ? nan : kind < 0.5f ? -infinity : kind < 0.7f ? 0 : kind < 0.9f ? 1 : 1e38f;
      }
      std::memcpy(&garbage, fields, sizeof(garbage));
      garbage.v = -1;
      among_garbage.push_back(garbage);
    }
  }
  for_each_target([&] {
    for (const Kernel& kernel : kernels) {
      const std::vector<BsdfResult> clean = kernel.run(cases), mixed = kernel.run(among_garbage);
      size_t row = 0;
      for (size_t i = 0; i < cases.size(); ++i, ++row) {
        while (among_garbage[row].v == -1) ++row;
        ASSERT_TRUE(same_bytes(clean[i], mixed[row])) << kernel.name << " case " << i;
        // Alone, too: shared short cuts over a whole vector must not show.
        if (i >= 500) continue;
        ASSERT_TRUE(same_bytes(clean[i], kernel.run({cases[i]})[0])) << kernel.name << " case " << i;
      }
    }
  });
}

}  // namespace
}  // namespace metamer::testing
