// The colour-matching experiment of W. S. Stiles and J. M. Burch, "Interim report to the CIE on colour-matching",
// Optica Acta 2, 1955: a light on one half of a field, a mixture of three monochromatic lamps on the other.
#pragma once
#include <array>

#include "engine/spectrum/color.h"

namespace metamer {

// Wavenumbers of 15500, 19000 and 22500 cm^-1, as nanometres are stated for them: the red, green and blue lamp.
inline constexpr std::array<double, 3> lamp_nm = {645.16, 526.32, 444.44};

// The observer's tristimulus values of one unit of radiance of each lamp, as columns. Of stiles_burch1955, whose unit
// lamps these are, the identity.
const Matrix3& lamps_to_tristimulus(Observer observer);

// How much of each lamp looks to the observer like the light, in the light's own unit of radiance (W m^-2 sr^-1 for a
// spectrum per nm); negative where the lamp has to be added to the light instead.
Color3 lamp_amounts(const Color3& tristimulus, Observer observer);
// Of a spectrum per nm, summed over 1 nm as integrate_xyz does.
Color3 lamp_amounts(const Samples& light, Observer observer);
// Of one unit of radiance at a wavelength within 360..830 nm; zero where the observer's table has nothing.
Color3 lamp_amounts_of_line(double lambda_nm, Observer observer);

// CIE 1931 X Y Z (Y = 683 lm/W left out) of amounts of the lamps.
Color3 xyz_of_lamps(const Color3& amounts);

}  // namespace metamer
