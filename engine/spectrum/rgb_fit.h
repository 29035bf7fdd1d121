// RGB to smooth spectra: sigmoids of quadratic polynomials, W. Jakob and J. Hanika, "A Low-Dimensional Function Space
// for Efficient Spectral Upsampling", Computer Graphics Forum 38(2), 2019. The solver is our own.
#pragma once
#include "engine/spectrum/color.h"
#include "engine/spectrum/rgb_quadrature.h"

namespace metamer {

// Spectra are S(c0 t^2 + c1 t + c2) with t = (lambda - 595 nm) / 235 nm, that is -1..1 over 360..830 nm, and
// S(x) = 1/2 + x / (2 sqrt(1 + x^2)).
inline constexpr double sigmoid_center_nm = 595.0;
inline constexpr double sigmoid_half_range_nm = 235.0;
// For c = (0, 0, +-sigmoid_saturated), S is exactly 1 or 0 in single and in double precision.
inline constexpr double sigmoid_saturated = 1e18;
// Coefficients past this would be steps narrower than 1 nm tables can tell from one another; none is fitted.
inline constexpr double largest_sigmoid_coefficient = 2e4;

using SigmoidCoefficients = std::array<double, 3>;

double sigmoid(double x);
double sigmoid_polynomial(const SigmoidCoefficients& c, double lambda_nm);

struct SigmoidFit {
  SigmoidCoefficients c;
  double error;  // largest difference of a linear channel between the colour asked for and the spectrum's
};

// The reflectance in 0..1 whose colour under the space's white illuminant (CIE 1931, 1 nm) is `rgb`, each channel in
// 0..1. Greys are flat (c0 = c1 = 0), black and white saturated. For every sRGB colour the error is below 1e-6. Colours
// that no such reflectance has (they exist in wide colour spaces only) get the nearest found, and `error` says how far
// off it is. Takes about 0.2 ms, for impossible colours 1 ms. For many colours at once see rgb_columns.h.
SigmoidFit fit_sigmoid(ColorSpace space, const Color3& rgb);

// The flat reflectance `grey` in 0..1.
SigmoidCoefficients grey_sigmoid(double grey);

// Linear RGB of a sigmoid reflectance under the space's white illuminant.
Color3 sigmoid_rgb(ColorSpace space, const SigmoidCoefficients& c);

// Levenberg-Marquardt from `c` for the colour by the given sums, to an error of 1e-8 of min(largest channel, 1 -
// smallest). True if it got there; if not, c is the best found.
bool refine_sigmoid(std::span<const QuadratureNode> nodes, const Color3& rgb, SigmoidCoefficients& c);

}  // namespace metamer
