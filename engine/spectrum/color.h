// Linear RGB colour spaces and chromatic adaptation, all in double precision for the CIE 1931 observer.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "engine/spectrum/observers.h"

namespace metamer {

using Color3 = std::array<double, 3>;                  // X Y Z or R G B
using Matrix3 = std::array<std::array<double, 3>, 3>;  // row-major

Matrix3 multiply(const Matrix3& a, const Matrix3& b);
Color3 multiply(const Matrix3& a, const Color3& v);
// The matrix must be invertible.
Matrix3 inverse(const Matrix3& m);

// dci_p3 has the primaries of SMPTE RP 431-2 and the white of D65 (that is "Display P3"). lamps, which only displays
// use, has the lamps of lamps.h as primaries and the white of D65.
enum class ColorSpace : uint8_t { srgb, dci_p3, rec2020, aces2065_1, lamps };
inline constexpr size_t color_space_count = 4;  // without lamps: those that scenes may name

// "srgb", "dci-p3", "rec2020", "aces2065-1"; `color_space_name` also "lamps".
std::span<const std::string_view> color_space_names();
std::string_view color_space_name(ColorSpace space);
std::optional<ColorSpace> find_color_space(std::string_view name);

// The illuminant whose colour is R = G = B: D65 for sRGB, P3 and Rec. 2020; daylight of 6000 K (times
// `daylight_shift`) for ACES, whose published white (0.32168, 0.33767) it meets within 0.0002.
const Samples& white_illuminant(ColorSpace space);

// XYZ of that illuminant integrated with the CIE 1931 1 nm tables, scaled to Y = 1.
const Color3& white_xyz(ColorSpace space);

// Linear RGB to XYZ of the same Y and back: R = G = B = 1 is exactly `white_xyz`, so that white light of the space's
// illuminant is exactly neutral. Primaries: IEC 61966-2-1, SMPTE RP 431-2, ITU-R BT.2020-2, SMPTE ST 2065-1. The
// derivation is Lindbloom's: columns are the primaries' XYZ, each scaled so that they sum to white.
const Matrix3& rgb_to_xyz(ColorSpace space);
const Matrix3& xyz_to_rgb(ColorSpace space);

// XYZ of a spectrum, without the factor 683: sums over 1 nm of S xbar and so on.
Color3 integrate_xyz(const Samples& spectrum, Observer observer = Observer::cie1931);
std::array<double, 2> chromaticity(const Color3& xyz);
// XYZ with Y = 1 of a chromaticity; y > 0.
Color3 xyz_of_chromaticity(double x, double y);

enum class Adaptation : uint8_t { bradford, cat16 };

// Maps XYZ seen under white `from` to XYZ that looks alike under white `to` (complete adaptation; both with the same
// Y). Bradford: Lam 1985 in its linear form (ICC.1:2010, annex E). CAT16: Li et al., Color Res. Appl. 42(6), 2017.
Matrix3 adaptation_matrix(Adaptation method, const Color3& from, const Color3& to);

}  // namespace metamer
