// The twin of phase-inl.h, by the textbook's formulas: M. Pharr, W. Jakob, G. Humphreys, Physically Based Rendering,
// 4th ed., 2023, section 11.3.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/bsdf/reference.h"

namespace metamer::reference {

double eval_phase(double cos_theta, double g) {
  const double square = 1 + g * g - 2 * g * cos_theta;
  return (1 - g * g) / (4 * std::numbers::pi * square * std::sqrt(square));
}

Direction sample_phase(double g, double u, double v) {
  const double x = 2 * u - 1, s = (1 - g * g) / (1 + g * x);
  const double cos_theta = std::abs(g) < 1e-6 ? x : std::clamp((1 + g * g - s * s) / (2 * g), -1.0, 1.0);
  const double sin_theta = std::sqrt(1 - cos_theta * cos_theta), phi = 2 * std::numbers::pi * v;
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta};
}

double eval_phase(double cos_theta, const PhaseLobes& lobes) {
  return (1 - lobes.g2_share) * eval_phase(cos_theta, lobes.g) + lobes.g2_share * eval_phase(cos_theta, lobes.g2);
}

Direction sample_phase(const PhaseLobes& lobes, double choice, double u, double v) {
  return sample_phase(choice < lobes.g2_share ? lobes.g2 : lobes.g, u, v);
}

}  // namespace metamer::reference
