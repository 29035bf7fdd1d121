// From the film's XYZ to the linear colour of a display: its primaries, and what counts as white.
#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "engine/film/picture.h"
#include "engine/spectrum/color.h"
#include "systems/colour_match.h"

namespace metamer {

// The displays, by name: "srgb" (IEC 61966-2-1), "p3" (SMPTE RP 431-2 primaries, white D65: Display P3), "rec2020"
// (ITU-R BT.2020-2). Index i is the colour space of that name.
std::span<const std::string_view> display_names();
std::string_view display_name(ColorSpace display);
ColorSpace display_at(size_t index);

// CIE 1931 x, y of the display's primaries and white, as an EXR states them.
Chromaticities display_chromaticities(ColorSpace display);

// XYZ with Y = 1 of the light of a correlated colour temperature: CIE daylight from 4000 K, below it a black body.
inline constexpr double least_white_kelvin = 1000.0, most_white_kelvin = 25000.0;
Color3 white_of_temperature(double kelvin, Observer observer = Observer::cie1931);

// XYZ with Y = 1 of CIE illuminants D65, D50 and A, integrated with the 1 nm tables; `index` into white_names(): "d65",
// "d50", "a". What another observer than 1931's sees is led to XYZ by observer_to_xyz(), as pictures are.
std::span<const std::string_view> white_names();
Color3 white_at(size_t index, Observer observer = Observer::cie1931);

// XYZ to the display's linear colour. With `white` (XYZ, Y = 1) what has that colour becomes R = G = B of the same
// luminance; without, no adaptation. In double precision, rounded once.
ColourMatrix display_matrix(ColorSpace display, const std::optional<Color3>& white, Adaptation adaptation);

// What the display can show instead of a linear colour outside its gamut: that of the same luminance and hue (the line
// to grey in linear light) at which the most negative component is 0. Black where luminance is not above 0.
Color3 into_gamut(const Color3& rgb, ColorSpace display);

// "bradford", "cat16", in the order of Adaptation.
std::span<const std::string_view> adaptation_names();

// The exposure at which the geometric mean of luminance is 0.18 of white, over the pixels that are not black: the key
// of Reinhard et al. 2002, section 3.1. Linear colour of the display; 0 where all is black. Within [-100, 100].
float automatic_exposure_stops(const Picture& picture, ColorSpace display);

}  // namespace metamer
