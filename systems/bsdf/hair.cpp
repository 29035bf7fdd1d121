#include "systems/bsdf/hair.h"

#include <algorithm>
#include <cmath>

#include "engine/simd/portable_math.h"

namespace metamer {

HairShape hair_shape(double beta_m, double beta_n, double tilt_deg) {
  constexpr double pi = 3.14159265358979323846, least = 1e-2;
  const double m = std::clamp(beta_m, least, 1.0), n = std::clamp(beta_n, least, 1.0);
  const auto square = [](double x) { return x * x; };
  HairShape shape;
  shape.variance = square(0.726 * m + 0.812 * m * m + 3.7 * portable::pow(m, 20));
  shape.width = std::sqrt(pi / 8) * (0.265 * n + 1.194 * n * n + 5.372 * portable::pow(n, 22));
  for (int k = 0; k < 3; ++k) {
    const double angle = tilt_deg * pi / 180 * (1 << k);
    shape.sin_tilt[k] = portable::sin(angle);
    shape.cos_tilt[k] = portable::cos(angle);
  }
  return shape;
}

double hair_absorption_of_log(double beta_n) {
  const double b = beta_n, b2 = b * b;
  return 1 / (5.969 - 0.215 * b + 2.532 * b2 - 10.73 * b2 * b + 5.574 * b2 * b2 + 0.245 * b2 * b2 * b);
}

double hair_absorption_of_reflectance(double reflectance, double beta_n) {
  const double root = portable::log(std::clamp(reflectance, 1e-6, 1.0)) * hair_absorption_of_log(beta_n);
  return root * root;
}

}  // namespace metamer
