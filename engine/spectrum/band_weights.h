// Colour from bands: a curve through mean radiances, integrated with an observer's matching functions.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "engine/spectrum/color.h"

namespace metamer {

// The curve through N band means m, edges in nm, N + 1 and strictly ascending: continuous, a parabola over each band
// whose mean is the band's. With t from 0 to 1 across a band, e_l and e_r at its edges,
//   q(t) = e_l + (e_r - e_l) t + 6 (m - (e_l + e_r) / 2) t (1 - t),
// after P. Colella, P. R. Woodward, "The Piecewise Parabolic Method", J. Comput. Phys. 54, 1984, eq. 1.5. At an edge
// the value is that of the line through the two means beside it, at the first and last edge and beyond them the mean of
// the band there (as ASTM E308 extends spectra). It is linear in m, and local: between bands of 0 and 1 it undershoots
// by at most 1/6. Edges of higher order (the same paper's, splines) ring more and do worse on lamps with lines.
double band_curve(std::span<const double> edges_nm, std::span<const double> means, double lambda_nm);

// weights[c][b] for which sum over b of weights[c][b] m[b] is 683 times the integral over 360..830 nm of that curve
// with matching function c, both linear between their nodes' values: exact but for rounding.
std::array<std::vector<double>, 3> band_weights(std::span<const double> edges_nm, Observer observer);

// What an observer's three numbers are as XYZ of 1931 in which the light of `white` has the chromaticity that the 1931
// observer gives it, and the same Y as before: the observer's own XYZ are adapted by CAT16 from the observer's white;
// those of Stiles & Burch are first led to XYZ by stiles_burch_to_xyz(). Identity for cie1931.
Matrix3 observer_to_xyz(Observer observer, const Samples& white);

// The matrix M that minimises the sum over 390..730 nm, at 5 nm, of |M (rbar, gbar, bbar) - (xbar, ybar, zbar)|^2, the
// latter of 1931. The two observers are no linear transforms of each other: the root mean square of what remains is
// 0.0195 in xbar, 0.0190 in ybar and 0.0912 in zbar, whose maxima are 1.06, 1 and 1.78.
const Matrix3& stiles_burch_to_xyz();

}  // namespace metamer
