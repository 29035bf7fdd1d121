// Maps from the unit square to the domains that are sampled, area-preserving and continuous where the domain
// allows it, so that stratification of the points survives. Double precision; the SIMD twins are in warps-inl.h.
// Numbers u, v lie in [0, 1).
#pragma once
#include <algorithm>
#include <cmath>

#include "engine/simd/portable_math.h"

namespace metamer {

struct PointD2 {
  double x, y;
};
struct PointD3 {
  double x, y, z;
};
struct Barycentric {
  double b0, b1, b2;  // sum to 1
};

namespace warps {

inline constexpr double pi = 3.14159265358979323846;

// Uniform on the unit disk, pdf 1 / pi. Squares about the centre become circles.
// Shirley and Chiu, "A Low Distortion Map Between Disk and Square", 1997.
inline PointD2 concentric_disk(double u, double v) {
  const double a = 2 * u - 1, b = 2 * v - 1;
  const bool wide = std::fabs(a) > std::fabs(b);
  const double r = wide ? a : b;
  if (r == 0) return {0, 0};
  const double angle = pi / 4 * ((wide ? b : a) / r);
  const double c = r * portable::cos(angle), s = r * portable::sin(angle);
  return wide ? PointD2{c, s} : PointD2{s, c};
}
inline constexpr double disk_pdf = 1 / pi;  // per area

// Proportional to cos(theta) about +z, theta <= pi/2. Malley's method.
inline PointD3 cosine_hemisphere(double u, double v) {
  const PointD2 p = concentric_disk(u, v);
  return {p.x, p.y, std::sqrt(std::max(0.0, 1 - p.x * p.x - p.y * p.y))};
}
inline double cosine_hemisphere_pdf(double cos_theta) { return std::max(0.0, cos_theta) / pi; }  // per solid angle

// Uniform on a triangle, pdf 1 / its area. Heitz, "A Low-Distortion Map Between Triangle and Square", 2019.
inline Barycentric uniform_triangle(double u, double v) {
  const bool low = v < u;
  const double b0 = low ? u - v / 2 : u / 2;
  const double b1 = low ? v / 2 : v - u / 2;
  return {b0, b1, 1 - b0 - b1};
}

// Uniform on the unit sphere; u runs from +z to -z.
inline PointD3 uniform_sphere(double u, double v) {
  const double r = 2 * std::sqrt(u * (1 - u));
  return {r * portable::cos(2 * pi * v), r * portable::sin(2 * pi * v), 1 - 2 * u};
}
inline constexpr double uniform_sphere_pdf = 1 / (4 * pi);  // per solid angle

// 1 - cos(theta) from sin^2(theta), without cancellation for small angles; theta <= pi/2.
inline double one_minus_cos(double sin2_theta) { return sin2_theta / (1 + std::sqrt(std::max(0.0, 1 - sin2_theta))); }

// Uniform in the cone of half angle theta_max about +z, given 1 - cos(theta_max) in (0, 2]: accurate for the
// smallest cones, where the cosine itself is 1.
inline PointD3 uniform_cone(double u, double v, double one_minus_cos_max) {
  const double t = u * one_minus_cos_max;
  const double r = std::sqrt(t * (2 - t));
  return {r * portable::cos(2 * pi * v), r * portable::sin(2 * pi * v), 1 - t};
}
inline double uniform_cone_pdf(double one_minus_cos_max) { return 1 / (2 * pi * one_minus_cos_max); }

}  // namespace warps
}  // namespace metamer
