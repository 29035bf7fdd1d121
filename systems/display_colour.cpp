#include "systems/display_colour.h"

#include <algorithm>
#include <array>

#include "engine/simd/portable_math.h"
#include "engine/spectrum/band_weights.h"
#include "engine/spectrum/lamps.h"
#include "engine/spectrum/sources.h"

namespace metamer {
namespace {

constexpr std::array<std::string_view, 4> displays = {"srgb", "p3", "rec2020", "lamps"};
constexpr std::array<std::string_view, 3> whites = {"d65", "d50", "a"};
constexpr std::array<std::string_view, 2> adaptations = {"bradford", "cat16"};

Color3 with_unit_luminance(Color3 xyz) {
  const double Y = xyz[1];
  for (double& v : xyz) v /= Y;
  return xyz;
}

Color3 seen_by(Observer observer, const Samples& light) {
  const Matrix3 to_xyz = observer_to_xyz(observer, *cie_illuminant("D65"));
  return with_unit_luminance(multiply(to_xyz, integrate_xyz(light, observer)));
}

std::array<float, 2> rounded_xy(const std::array<double, 2>& xy) {
  return {static_cast<float>(xy[0]), static_cast<float>(xy[1])};
}

}  // namespace

std::span<const std::string_view> display_names() { return displays; }
std::span<const std::string_view> white_names() { return whites; }
std::span<const std::string_view> adaptation_names() { return adaptations; }

ColorSpace display_at(size_t index) {
  constexpr std::array<ColorSpace, 4> spaces = {ColorSpace::srgb, ColorSpace::dci_p3, ColorSpace::rec2020,
                                                ColorSpace::lamps};
  return spaces[index];
}

std::string_view display_name(ColorSpace display) {
  for (size_t i = 0; i < displays.size(); ++i)
    if (display_at(i) == display) return displays[i];
  return color_space_name(display);
}

const Matrix3& display_to_xyz(ColorSpace display) {
  return display == ColorSpace::lamps ? lamps_to_tristimulus(Observer::cie1931) : rgb_to_xyz(display);
}

Color3 white_amounts(ColorSpace display) {
  if (display != ColorSpace::lamps) return {1, 1, 1};
  return lamp_amounts(white_xyz(display), Observer::cie1931);
}

Chromaticities display_chromaticities(ColorSpace display) {
  const auto primary = [&](size_t channel) {
    Color3 rgb = {};
    rgb[channel] = 1;
    return rounded_xy(chromaticity(multiply(rgb_to_xyz(display), rgb)));
  };
  return {primary(0), primary(1), primary(2), rounded_xy(chromaticity(white_xyz(display)))};
}

Chromaticities linear_chromaticities(ColorSpace display) {
  Chromaticities c = display_chromaticities(display);
  if (display == ColorSpace::lamps)
    c.white = rounded_xy(chromaticity(multiply(display_to_xyz(display), Color3{1, 1, 1})));
  return c;
}

float linear_white_luminance(ColorSpace display) {
  if (display != ColorSpace::lamps) return 1;
  return static_cast<float>(multiply(display_to_xyz(display), Color3{1, 1, 1})[1]);
}

NegativeAmounts negative_amounts(const Picture& picture) {
  NegativeAmounts negative;
  for (size_t i = 0; i < picture.pixel_count(); ++i) {
    const std::array<float, 3> rgb = {picture.r[i], picture.g[i], picture.b[i]};
    negative.pixels += std::min({rgb[0], rgb[1], rgb[2]}) < 0 ? 1 : 0;
    for (size_t c = 0; c < 3; ++c) negative.least[c] = std::min(negative.least[c], rgb[c]);
  }
  return negative;
}

Color3 white_of_temperature(double kelvin, Observer observer) {
  return seen_by(observer, kelvin < daylight_min_kelvin ? blackbody(kelvin) : daylight(kelvin));
}

Color3 white_at(size_t index, Observer observer) {
  constexpr std::array<std::string_view, 3> illuminants = {"D65", "D50", "A"};
  return seen_by(observer, *cie_illuminant(illuminants[index]));
}

Matrix3 exact_display_matrix(ColorSpace display, const std::optional<Color3>& white, Adaptation adaptation) {
  const Matrix3 matrix = display == ColorSpace::lamps ? inverse(display_to_xyz(display)) : xyz_to_rgb(display);
  if (!white || *white == white_xyz(display)) return matrix;
  return multiply(matrix, adaptation_matrix(adaptation, *white, white_xyz(display)));
}

ColourMatrix display_matrix(ColorSpace display, const std::optional<Color3>& white, Adaptation adaptation) {
  return rounded(exact_display_matrix(display, white, adaptation));
}

Color3 into_gamut(const Color3& rgb, ColorSpace display) {
  const double least = std::min({rgb[0], rgb[1], rgb[2]});
  if (least >= 0) return rgb;
  const double Y = multiply(rgb_to_xyz(display), rgb)[1];
  if (!(Y > 0)) return {0, 0, 0};
  const double keep = Y / (Y - least);
  Color3 mapped = {};
  for (size_t i = 0; i < 3; ++i) mapped[i] = std::max(0.0, Y + keep * (rgb[i] - Y));
  return mapped;
}

float automatic_exposure_stops(const Picture& picture, ColorSpace display) {
  constexpr double key = 0.18;
  const Color3& weights = display_to_xyz(display)[1];
  // One logarithm of a product of many: a float is within 1e-45..1e39, so the product stays a normal number.
  double sum = 0, product = 1;
  size_t lit = 0;
  for (size_t i = 0; i < picture.pixel_count(); ++i) {
    const double Y = weights[0] * picture.r[i] + weights[1] * picture.g[i] + weights[2] * picture.b[i];
    if (!(Y > 0)) continue;  // nor where it is not a number
    product *= Y;
    ++lit;
    if (product > 1e200 || product < 1e-200) {
      sum += portable::log(product);
      product = 1;
    }
  }
  if (lit == 0) return 0;
  sum += portable::log(product);
  const double mean = sum / static_cast<double>(lit);
  const double stops = (portable::log(key) - mean) / portable::log(2);
  return static_cast<float>(std::clamp(stops, -100.0, 100.0));
}

}  // namespace metamer
