// Whether light travels on wavelengths or as three coefficients: what the coefficients of a spectrum are. See
// docs/rgb-mode.md.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "engine/spectrum/color.h"

namespace metamer {

// spectral: four sampled wavelengths per path. The others carry three coefficients, multiplied componentwise:
// rgb on the primaries of sRGB, lamps on three monochromatic lamps of 645.16, 526.32 and 444.44 nm.
enum class ColorMode : uint32_t { spectral, rgb, lamps };
std::span<const std::string_view> color_mode_names();  // in the order of ColorMode
std::string_view color_mode_name(ColorMode mode);
std::optional<ColorMode> find_color_mode(std::string_view name);

// The linear colour space of the coefficients. R = G = B = 1 is white_xyz(srgb), that is D65 of Y = 1, in both modes.
struct CoefficientSpace {
  // Of red, green and blue, nm: where indices of refraction are taken. rgb: 611, 549, 464 (DESIGN.md, section 1).
  std::array<double, 3> lambda_nm;
  // CIE 1931. rgb: that of sRGB. lamps: the columns are observer_value() at the lamps' wavelengths (Stiles & Burch
  // 1955, 15500, 19000 and 22500 cm^-1), each scaled so that the three sum to white.
  Matrix3 to_xyz, from_xyz;
};
// Kernels tell the channel of a wavelength by these bounds: red above 600 nm, blue below 500 nm.
inline constexpr double red_above_nm = 600.0, blue_below_nm = 500.0;

// `mode` is not spectral.
const CoefficientSpace& coefficient_space(ColorMode mode);

// The coefficients of a spectrum by its role, in double precision.
// A light: the colour of the light itself, in the unit times cd/m^2 per W m^-2 sr^-1 (683): white of 1 cd/m^2 is 1.
// Colours outside the gamut keep their negative coefficients, so that the light seen directly has the XYZ it has
// spectrally.
Color3 light_coefficients(ColorMode mode, const Samples& spectrum);
// What reflects or transmits: the colour it has under D65, 1 where the spectrum is 1. Negative coefficients become 0:
// no reflection may make light negative.
Color3 factor_coefficients(ColorMode mode, const Samples& spectrum);
// An albedo: the same, at most 1.
Color3 albedo_coefficients(ColorMode mode, const Samples& spectrum);
// n, kappa: the spectrum at the three wavelengths.
Color3 index_coefficients(ColorMode mode, const Samples& spectrum);

// Linear RGB of an image to coefficients; its white becomes 1 (adapted by CAT16 where it is not D65).
Matrix3 image_to_coefficients(ColorMode mode, ColorSpace image);

}  // namespace metamer
