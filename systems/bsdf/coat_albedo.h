// How much a coat's surface reflects by itself: the tables that the coated BSDF needs to conserve energy. Calculated
// when a world is built, in double precision from + - * / and sqrt (and portable sines), the same on every machine.
//
// E(cos_theta) is the directional albedo of the surface of a coat of relative index eta: the share of light from that
// direction that it reflects at once. Smooth: Fresnel's reflectance. Rough: the integral of the GGX reflection's f_cos
// over the hemisphere, which is less than all that does not enter, for light that meets two facets is not counted as
// reflected: it goes to what is underneath. Its average over the hemisphere is the integral of 2 cos_theta E d
// cos_theta.
#pragma once
#include <cstdint>

#include "engine/simd/column.h"

namespace metamer {

// A row of the table holds, for one eta: the average, and for a rough surface E at cos_theta = (k / (coat_nodes -
// 1))^4, k = 0 ... coat_nodes - 1, between which E is linear in k. (The average is that of the interpolated E, so that
// only the reflection itself can miss the table.) The fourth power puts nodes where E bends: at grazing angles.
inline constexpr uint32_t coat_nodes = 128;

// The rows of one material: etas from `eta_least` on in equal steps, between which everything is linear in eta.
struct CoatRows {
  uint32_t first = 0;      // float of the table with which the first row begins
  uint32_t stride = 0;     // floats from a row to the next; 0: there is one only
  uint32_t last_pair = 0;  // the last row that has one behind it
  float eta_least = 1, rows_per_eta = 0;
};

// Fresnel's reflectance of unpolarised light, exact or Schlick's, between transparent media; eta > 0, cos_theta in
// [0, 1]. The formulas of fresnel-inl.h.
double coat_fresnel(double eta, double cos_theta, bool schlick);

// The average of a smooth surface's E, to 1e-6; eta > 0.
double smooth_coat_average(double eta, bool schlick);

// E of a rough surface; alpha at least least_alpha, to 2e-3.
double rough_coat_albedo(double alpha, double eta, bool schlick, double cos_theta);

// A surface, and whether a layer as in coat_layer.h is under it, which has an optical thickness.
struct CoatSurface {
  double alpha = 0;
  bool schlick = false;
  bool layered = false;  // not with schlick
  double thickness = 0;
};

// The one width in a table's place for two: the root of their mean square, at least smooth_alpha. What enters an
// anisotropic surface then is right to 2 %.
double coat_table_alpha(double alpha_x, double alpha_y);

// Appends the rows for etas in [eta_least, eta_most], eta_least > 0, to the table: at most 0.02 apart, and at most 64.
// alpha < smooth_alpha: smooth, rows of the average alone. Largest errors of interpolation: average 2e-5, E 1.5e-3,
// where the etas are not on both sides of 1.
CoatRows add_coat_rows(const CoatSurface& surface, double eta_least, double eta_most, Column<float>& table);

}  // namespace metamer
