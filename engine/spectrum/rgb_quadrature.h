// How a reflectance becomes linear RGB under a colour space's white illuminant, as weighted sums.
#pragma once
#include <span>

#include "engine/spectrum/color.h"

namespace metamer {

// rgb += weight * reflectance(t), t as in rgb_fit.h. The weights of each channel sum to 1: white stays white.
struct QuadratureNode {
  double t;
  Color3 weight;
};

// The CIE sums over 1 nm (CIE 1931): 471 nodes.
std::span<const QuadratureNode> full_quadrature(ColorSpace space);

// The same sums for reflectances that a cubic through every four neighbours of 5 nm meets: 95 nodes. For the sigmoids
// of sRGB colours the two differ by less than 3e-5 (tested).
std::span<const QuadratureNode> reduced_quadrature(ColorSpace space);

}  // namespace metamer
