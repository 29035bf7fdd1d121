// Random arguments for the BSDF kernels, and the same arguments in the twins' types.
#pragma once
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "systems/bsdf/reference.h"
#include "tests/systems/support/bsdf_kernels.h"

namespace metamer::testing {

inline reference::Direction direction(const float w[3]) { return {w[0], w[1], w[2]}; }
inline reference::Spectrum4 spectrum(const float s[4]) { return {s[0], s[1], s[2], s[3]}; }
inline reference::Roughness roughness(const BsdfCase& c) { return {c.alpha_x, c.alpha_y}; }
inline reference::ConductorOptics metal(const BsdfCase& c) {
  return {spectrum(c.eta), spectrum(c.kappa), c.schlick == 1};
}

class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  // In [0, 1), a multiple of 2^-24.
  float uniform() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }
  void direction(float w[3]) {
    const float z = 2 * uniform() - 1, phi = 2 * std::numbers::pi_v<float> * uniform();
    const reference::Direction unit = reference::normalize(
        {std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z == 0 ? 0.5f : z});
    w[0] = float(unit.x), w[1] = float(unit.y), w[2] = float(unit.z);
  }

 private:
  std::mt19937 engine_;
};

// Directions over the whole sphere; alphas from smooth to 1, in half of the cases equal, in some 0.
inline std::vector<BsdfCase> random_metals(size_t count) {
  Random random(5);
  std::vector<BsdfCase> cases(count);
  for (BsdfCase& c : cases) {
    random.direction(c.wo);
    random.direction(c.wi);
    c.u = random.uniform(), c.v = random.uniform();
    c.alpha_x = std::pow(10.0f, -4 * random.uniform());
    c.alpha_y = random.uniform() < 0.5f ? c.alpha_x : std::pow(10.0f, -4 * random.uniform());
    if (random.uniform() < 0.05f) c.alpha_x = 0;
    for (int j = 0; j < 4; ++j) {
      c.albedo[j] = random.uniform();
      c.eta[j] = 0.05f + 4 * random.uniform();
      c.kappa[j] = 0.5f + 6 * random.uniform();
    }
    c.schlick = random.uniform() < 0.5f ? 1 : 0;
  }
  return cases;
}

}  // namespace metamer::testing
