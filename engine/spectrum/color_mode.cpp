#include "engine/spectrum/color_mode.h"

#include <algorithm>

namespace metamer {
namespace {

constexpr std::array<std::string_view, 3> names = {"spectral", "rgb", "lamps"};

CoefficientSpace make_rgb() {
  return {{611.0, 549.0, 464.0}, rgb_to_xyz(ColorSpace::srgb), xyz_to_rgb(ColorSpace::srgb)};
}

CoefficientSpace make_lamps() {
  CoefficientSpace space;
  for (size_t c = 0; c < 3; ++c) {
    constexpr std::array<double, 3> wavenumber_per_cm = {15500.0, 19000.0, 22500.0};
    space.lambda_nm[c] = 1e7 / wavenumber_per_cm[c];
    const Color3 xyz = observer_value(Observer::cie1931, space.lambda_nm[c]);
    for (size_t r = 0; r < 3; ++r) space.to_xyz[r][c] = xyz[r];
  }
  const Color3 scale = multiply(inverse(space.to_xyz), white_xyz(ColorSpace::srgb));
  for (auto& row : space.to_xyz)
    for (size_t c = 0; c < 3; ++c) row[c] *= scale[c];
  space.from_xyz = inverse(space.to_xyz);
  return space;
}

}  // namespace

std::span<const std::string_view> color_mode_names() { return names; }
std::string_view color_mode_name(ColorMode mode) { return names[static_cast<size_t>(mode)]; }
std::optional<ColorMode> find_color_mode(std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<ColorMode>(found - names.begin());
}

const CoefficientSpace& coefficient_space(ColorMode mode) {
  static const CoefficientSpace rgb = make_rgb(), lamps = make_lamps();
  return mode == ColorMode::lamps ? lamps : rgb;
}

Color3 light_coefficients(ColorMode mode, const Samples& spectrum) {
  Color3 xyz = integrate_xyz(spectrum);
  for (double& component : xyz) component *= luminous_efficacy;
  return multiply(coefficient_space(mode).from_xyz, xyz);
}

Color3 factor_coefficients(ColorMode mode, const Samples& spectrum) {
  const Samples& white = white_illuminant(ColorSpace::srgb);
  Samples lit;
  for (size_t i = 0; i < lambda_count; ++i) lit[i] = spectrum[i] * white[i];
  const double white_level = integrate(white, observer_table(Observer::cie1931).matching[1]);
  Color3 color = multiply(coefficient_space(mode).from_xyz, integrate_xyz(lit));
  for (double& c : color) c = std::max(c / white_level, 0.0);
  return color;
}

Color3 albedo_coefficients(ColorMode mode, const Samples& spectrum) {
  Color3 color = factor_coefficients(mode, spectrum);
  for (double& c : color) c = std::min(c, 1.0);
  return color;
}

Color3 index_coefficients(ColorMode mode, const Samples& spectrum) {
  Color3 index;
  for (size_t c = 0; c < 3; ++c) index[c] = interpolate(spectrum, coefficient_space(mode).lambda_nm[c]);
  return index;
}

Matrix3 image_to_coefficients(ColorMode mode, ColorSpace image) {
  Matrix3 to_xyz = rgb_to_xyz(image);
  const Color3 &from = white_xyz(image), &to = white_xyz(ColorSpace::srgb);
  if (from != to) to_xyz = multiply(adaptation_matrix(Adaptation::cat16, from, to), to_xyz);
  return multiply(coefficient_space(mode).from_xyz, to_xyz);
}

}  // namespace metamer
