// Which wavelengths a path carries: a hero drawn in proportion to visible importance and three companions, one in each
// remaining quarter of the distribution. A. Wilkie et al., "Hero Wavelength Spectral Sampling", EGSR 2014.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/spectrum/samples.h"

namespace metamer {

inline constexpr size_t wavelength_segments = 1024;
inline constexpr size_t wavelengths_per_path = 4;

// The inverse distribution function, linear over segments of equal probability: within segment i the density is
// 1 / (wavelength_segments * width_nm[i]) per nm, exactly.
struct WavelengthTable {
  alignas(64) std::array<float, wavelength_segments> lower_nm;
  alignas(64) std::array<float, wavelength_segments> width_nm;
};

// The density is p = 0.97 w + 0.03 / 470 nm, where w is the norm of the sRGB matching functions, sqrt(r^2 + g^2 + b^2),
// averaged with a triangle of half-width 30 nm, and normalised. That norm is the density of least variance, summed over
// the channels of a developed picture, for one wavelength per path and an equal-energy white. Smoothing costs the hero
// little and evens out the sum of four equidistant in probability; the uniform part keeps the density from vanishing
// where another observer or a spectral picture still looks.
// Variance of R + G + B of a white under D65, in units of the white squared, for the hero alone and for the four:
//   uniform 22.8 and 1.47, sech^2(0.0072 (lambda - 538)) 14.6 and 0.365, xbar + ybar + zbar 10.5 and 0.191,
//   the norm itself 9.8 and 0.121, this density 10.2 and 0.035.
const WavelengthTable& wavelength_table();

// Density per nm over 360..830 nm; integrates to 1. Zero outside.
double wavelength_pdf(double lambda_nm);

struct WavelengthSample {
  std::array<double, wavelengths_per_path> lambda_nm;
  std::array<double, wavelengths_per_path> inv_pdf_nm;
};

// The double-precision twin of the kernel in wavelengths-inl.h. With r = floor(4 u_rotation), lambda_j is the inverse
// distribution function at (u + (j + r) mod 4) / 4: `u` alone stratifies the four together, and the hero, j = 0, is
// distributed by the density if both numbers are uniform in [0, 1). inv_pdf_nm[j] = 1 / p(lambda_j), so
//   integral of f  =  mean over j of f(lambda_j) inv_pdf_nm[j]  =  f(lambda_0) inv_pdf_nm[0]   in expectation.
WavelengthSample sample_wavelengths(double u, double u_rotation);

}  // namespace metamer
