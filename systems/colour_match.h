// Colour matching, the last step: the film's mean XYZ becomes linear colour of a display.
#pragma once
#include <array>

#include "engine/film/picture.h"
#include "engine/simd/column.h"
#include "engine/spectrum/color.h"

namespace metamer {

using ColourMatrix = std::array<std::array<float, 3>, 3>;  // [row][column]

ColourMatrix rounded(const Matrix3& matrix);

// rgb = m xyz for every row, with m[i][0] X + m[i][1] Y + m[i][2] Z summed from the left and each step rounded
// to float: equal bits on every instruction set. Relative error at most 3 2^-24 of the sum of the terms'
// magnitudes. X, Y, Z: cd/m^2, columns of one size, which r, g, b take on.
void colour_match(const ColourMatrix& xyz_to_rgb, const Column<float>& X, const Column<float>& Y,
                  const Column<float>& Z, Column<float>& r, Column<float>& g, Column<float>& b);

}  // namespace metamer
