// The spectra of light sources and the refractive indices of media as 1 nm samples.
#pragma once
#include <optional>
#include <string_view>

#include "engine/spectrum/samples.h"

namespace metamer {

// Spectral radiance of a black body, W m^-2 sr^-1 nm^-1, by Planck's law with the constants of the SI (2019).
// temperature_kelvin > 0; underflows to zero where the law does.
double planck_radiance(double temperature_kelvin, double lambda_nm);
Samples blackbody(double temperature_kelvin);

// CIE daylight of a correlated colour temperature from 4000 to 25000 K, 100 at 560 nm (CIE 15:2018, 4.1.2, with M1 and
// M2 rounded to three decimals as there). D65 is 6500 K times 1.4388/1.4380 and so on: `daylight_shift`.
inline constexpr double daylight_min_kelvin = 4000.0;
inline constexpr double daylight_max_kelvin = 25000.0;
inline constexpr double daylight_shift = 1.4388 / 1.4380;
std::array<double, 2> daylight_chromaticity(double cct_kelvin);
Samples daylight(double cct_kelvin);

// A CIE illuminant by the name of its data file ("A", "D65", "FL11", "LED-B1", ...) or "E", relative power as CIE
// tabulates it (E: 100). Where the table ends at 780 nm, A goes on by its formula, D50 and D65 by the daylight
// components, the others as zero.
std::optional<Samples> cie_illuminant(std::string_view name);

// Refractive index of a transparent medium of data/dispersion ("N-BK7") by its Sellmeier formula.
std::optional<Samples> dispersion_index(std::string_view medium);
double sellmeier_index(const DataTable& coefficients, double lambda_nm);

// Complex index n + i kappa of a metal of data/nk ("Au").
struct ComplexIndex {
  Samples eta;
  Samples kappa;
};
std::optional<ComplexIndex> metal_index(std::string_view metal);

}  // namespace metamer
