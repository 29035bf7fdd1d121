// Constructs metamers: two reflectances that look alike in one light to one observer, and differ in another light and
// to another observer.
#pragma once
#include <array>

#include "engine/spectrum/color.h"

namespace metamer {

// A light and who looks.
struct Viewing {
  Samples light{};
  Observer observer = Observer::cie1931;
};

// Reflectances are straight lines between these wavelengths and constant beyond.
inline constexpr size_t metamer_points = 41;
constexpr double metamer_lambda_nm(size_t point) { return 380.0 + 10.0 * static_cast<double>(point); }
using MetamerCurve = std::array<double, metamer_points>;
// Every value stays within these: real paints are neither black nor white.
inline constexpr double metamer_least = 0.01, metamer_most = 0.99;

Samples metamer_samples(const MetamerCurve& curve);

// base + d and base - d, `base` being taken at the points above and clamped to the bounds. d is a metameric black for
// `same` (G. Wyszecki, 1953): it adds nothing to any of the three tristimulus values. Among those, d maximises
//   g.d - 1000 |third differences of d|^2 / 2 - |d|^2 / 2
// with g the gradient of a hue direction in CIELAB for one of `apart`, in closed form by Lagrange multipliers, and is
// then made as long as the bounds allow. Of 12 directions for each of `apart` it is the one by which the smaller of the
// two colour differences becomes largest. The differences of tristimulus values for `same` are rounding, 1e-14 of
// white.
std::array<MetamerCurve, 2> make_metamers(const Samples& base, const Viewing& same,
                                          const std::array<Viewing, 2>& apart);

// X Y Z of a reflectance with that of the light itself, which is white, Y = 1.
Color3 seen_xyz(const Samples& reflectance, const Viewing& viewing);
// CIE 1976 colour difference of two reflectances in a light.
double seen_difference(const Samples& a, const Samples& b, const Viewing& viewing);

}  // namespace metamer
