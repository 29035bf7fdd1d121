#include "engine/spectrum/color_difference.h"

#include <algorithm>
#include <cmath>

#include "engine/simd/portable_math.h"

namespace metamer {
namespace {

using portable::atan2, portable::cos, portable::exp, portable::sin;
constexpr double pi = 3.14159265358979323846;
// The inverse of CIE 15:2018, equations 8.6 to 8.8.
double inverse_lightness_curve(double f) {
  constexpr double knee = 6.0 / 29.0;
  return f > knee ? f * f * f : 3 * knee * knee * (f - 4.0 / 29.0);
}

double radians(double degrees) { return degrees * (pi / 180); }

// In degrees, 0 to 360; 0 of a grey.
double hue_degrees(double a, double b) {
  if (a == 0 && b == 0) return 0;
  const double degrees = atan2(b, a) * (180 / pi);
  return degrees < 0 ? degrees + 360 : degrees;
}

// sqrt(C^7 / (C^7 + 25^7)).
double chroma_share(double chroma) {
  const double ratio = 25.0 / chroma;
  return chroma > 0 ? 1 / std::sqrt(1 + portable::pow(ratio, 7.0)) : 0;
}

// Equations 10 and 14: how far apart two hues are, and the one in between. Of a grey the other's hue counts.
struct Hues {
  double difference, mean;
};
Hues compare_hues(double h1, double h2, bool is_grey) {
  if (is_grey) return {0, h1 + h2};
  const double difference = h2 - h1, sum = h1 + h2;
  if (std::abs(difference) <= 180) return {difference, sum / 2};
  return {difference > 180 ? difference - 360 : difference + 360, sum < 360 ? (sum + 360) / 2 : (sum - 360) / 2};
}

}  // namespace

Color3 xyz_of_lab(const Color3& lab, const Color3& white) {
  const double fy = (lab[0] + 16) / 116;
  return {white[0] * inverse_lightness_curve(fy + lab[1] / 500), white[1] * inverse_lightness_curve(fy),
          white[2] * inverse_lightness_curve(fy - lab[2] / 200)};
}

double delta_e_2000(const Color3& lab, const Color3& other) {
  const auto chroma = [](double a, double b) { return std::sqrt(a * a + b * b); };
  const double mean_ab = (chroma(lab[1], lab[2]) + chroma(other[1], other[2])) / 2;
  const double stretch = 1 + 0.5 * (1 - chroma_share(mean_ab));
  const double a1 = stretch * lab[1], a2 = stretch * other[1];
  const double c1 = chroma(a1, lab[2]), c2 = chroma(a2, other[2]);
  const Hues hues = compare_hues(hue_degrees(a1, lab[2]), hue_degrees(a2, other[2]), c1 * c2 == 0);
  const double delta_lightness = other[0] - lab[0], delta_chroma = c2 - c1;
  const double delta_hue = 2 * std::sqrt(c1 * c2) * sin(radians(hues.difference / 2));

  const double lightness = (lab[0] + other[0]) / 2 - 50, mean_chroma = (c1 + c2) / 2;
  const double t = 1 - 0.17 * cos(radians(hues.mean - 30)) + 0.24 * cos(radians(2 * hues.mean)) +
                   0.32 * cos(radians(3 * hues.mean + 6)) - 0.20 * cos(radians(4 * hues.mean - 63));
  const double from_blue = (hues.mean - 275) / 25;
  const double turn = 30 * exp(-from_blue * from_blue);
  const double s_lightness = 1 + 0.015 * lightness * lightness / std::sqrt(20 + lightness * lightness);
  const double s_chroma = 1 + 0.045 * mean_chroma, s_hue = 1 + 0.015 * mean_chroma * t;
  const double rotation = -sin(radians(2 * turn)) * 2 * chroma_share(mean_chroma);
  const double l = delta_lightness / s_lightness, c = delta_chroma / s_chroma, h = delta_hue / s_hue;
  return std::sqrt(std::max(l * l + c * c + h * h + rotation * c * h, 0.0));
}

}  // namespace metamer
