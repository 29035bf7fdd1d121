#include "engine/spectrum/lab.h"

#include <cmath>

#include "engine/simd/portable_math.h"

namespace metamer {
namespace {

// Cube root with the straight piece that CIE puts near black.
double lightness_curve(double t) {
  constexpr double knee = 216.0 / 24389.0, slope = 24389.0 / 27.0 / 116.0;
  return t > knee ? portable::pow(t, 1.0 / 3.0) : slope * t + 16.0 / 116.0;
}

}  // namespace

Color3 lab_of_xyz(const Color3& xyz, const Color3& white) {
  const double fx = lightness_curve(xyz[0] / white[0]), fy = lightness_curve(xyz[1] / white[1]),
               fz = lightness_curve(xyz[2] / white[2]);
  return {116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)};
}

double delta_e_1976(const Color3& lab, const Color3& other) {
  double sum = 0;
  for (size_t i = 0; i < 3; ++i) sum += (lab[i] - other[i]) * (lab[i] - other[i]);
  return std::sqrt(sum);
}

}  // namespace metamer
