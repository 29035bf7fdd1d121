// A colour as a wavelength: where the line from white through it meets the spectrum.
#pragma once
#include <array>

#include "engine/spectrum/color.h"

namespace metamer {

// CIE 15:2018, 8.2 and 8.3, in the CIE 1931 x, y diagram.
struct DominantWavelength {
  // The wavelength on the spectrum locus at which the half-line from white through the colour leaves the diagram. Where
  // it leaves through the purples, the complementary one: where the opposite half-line leaves.
  double lambda_nm = 0;
  bool is_complementary = false;
  // Distance of the colour from white as a part of the boundary's, on the same half-line: 0 white, 1 monochromatic (or
  // on the line of purples).
  double purity = 0;
};

// `white` must lie inside the spectrum locus. A colour that differs from it by less than 1e-9 in x and y has purity 0
// and wavelength 0.
DominantWavelength dominant_wavelength(const std::array<double, 2>& xy, const std::array<double, 2>& white);

}  // namespace metamer
