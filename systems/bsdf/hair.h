// What the author says of hair as the numbers that its BSDF needs (hair-inl.h), and how colours become absorption.
// Calculated when a world is built, in double precision from portable functions. Sources: hair-inl.h.
#pragma once

namespace metamer {

inline constexpr int hair_series_terms = 20;  // of I_0 up to 12

struct HairShape {
  double variance = 0;                        // of M_0
  double width = 0;                           // s of N_p
  double sin_tilt[3] = {}, cos_tilt[3] = {};  // of the tilt, twice and four times it
};
// beta_m and beta_n from 0 to 1: roughness along and around the fibre; the scales' tilt in degrees.
HairShape hair_shape(double beta_m, double beta_n, double tilt_deg);

// Absorption per radius of hair that has this colour in numbers, reflectance in (0, 1]: Chiang et al., equation 9.
double hair_absorption_of_reflectance(double reflectance, double beta_n);
// The square of this times the logarithm of the reflectance is that.
double hair_absorption_of_log(double beta_n);

}  // namespace metamer
