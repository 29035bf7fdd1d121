// From the film's XYZ to the linear colour of a display: its primaries, and what counts as white.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "engine/film/picture.h"
#include "engine/spectrum/color.h"
#include "systems/colour_match.h"

namespace metamer {

// The displays, by name: "srgb" (IEC 61966-2-1), "p3" (SMPTE RP 431-2 primaries, white D65: Display P3), "rec2020"
// (ITU-R BT.2020-2), "lamps" (three monochromatic lamps, see lamps.h). Index i is the colour space of that name.
std::span<const std::string_view> display_names();
std::string_view display_name(ColorSpace display);
ColorSpace display_at(size_t index);

// A picture's linear colour to X Y Z in cd/m^2. For all but lamps the display's own: R = G = B = 1 is its white, of
// 1 cd/m^2. Of lamps, the amounts of lamps.h times 683: one is 1/683 W m^-2 sr^-1 of the lamp.
const Matrix3& display_to_xyz(ColorSpace display);
// R, G and B of the display's white of 1 cd/m^2 in that unit: 1, 1 and 1 for all but lamps.
Color3 white_amounts(ColorSpace display);

// CIE 1931 x, y of the display's primaries and white: what its codes mean.
Chromaticities display_chromaticities(ColorSpace display);
// The same with R = G = B = 1 of a picture's linear colour as white, as an EXR states them, and the luminance of that.
Chromaticities linear_chromaticities(ColorSpace display);
float linear_white_luminance(ColorSpace display);

// Pixels with a negative component, and the most negative values of the three, 0 where there are none.
struct NegativeAmounts {
  size_t pixels = 0;
  std::array<float, 3> least = {};
};
NegativeAmounts negative_amounts(const Picture& picture);

// XYZ with Y = 1 of the light of a correlated colour temperature: CIE daylight from 4000 K, below it a black body.
inline constexpr double least_white_kelvin = 1000.0, most_white_kelvin = 25000.0;
Color3 white_of_temperature(double kelvin, Observer observer = Observer::cie1931);

// XYZ with Y = 1 of CIE illuminants D65, D50 and A, integrated with the 1 nm tables; `index` into white_names(): "d65",
// "d50", "a". What another observer than 1931's sees is led to XYZ by observer_to_xyz(), as pictures are.
std::span<const std::string_view> white_names();
Color3 white_at(size_t index, Observer observer = Observer::cie1931);

// XYZ to a picture's linear colour (display_to_xyz). With `white` (XYZ, Y = 1) what has that colour becomes R = G = B
// of the same luminance; without, no adaptation. In double precision, which display_matrix rounds once.
Matrix3 exact_display_matrix(ColorSpace display, const std::optional<Color3>& white, Adaptation adaptation);
ColourMatrix display_matrix(ColorSpace display, const std::optional<Color3>& white, Adaptation adaptation);

// What the display can show instead of a linear colour (R = G = B = 1 being white) outside its gamut: that of the same
// luminance and hue (the line to grey in linear light) at which the most negative component is 0. Black where luminance
// is not above 0.
Color3 into_gamut(const Color3& rgb, ColorSpace display);

// "bradford", "cat16", in the order of Adaptation.
std::span<const std::string_view> adaptation_names();

// The exposure at which the geometric mean of luminance is 0.18 of white, over the pixels that are not black: the key
// of Reinhard et al. 2002, section 3.1. Linear colour of the display; 0 where all is black. Within [-100, 100].
float automatic_exposure_stops(const Picture& picture, ColorSpace display);

}  // namespace metamer
