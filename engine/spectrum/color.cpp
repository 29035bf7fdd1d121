#include "engine/spectrum/color.h"

#include <algorithm>

#include "engine/spectrum/lamps.h"
#include "engine/spectrum/sources.h"

namespace metamer {
namespace {

constexpr std::array<std::string_view, color_space_count> names = {"srgb", "dci-p3", "rec2020", "aces2065-1"};

// x, y of red, green, blue.
constexpr std::array<std::array<double, 6>, color_space_count> primaries = {{
    {0.64, 0.33, 0.30, 0.60, 0.15, 0.06},
    {0.680, 0.320, 0.265, 0.690, 0.150, 0.060},
    {0.708, 0.292, 0.170, 0.797, 0.131, 0.046},
    {0.73470, 0.26530, 0.0, 1.0, 0.00010, -0.07700},
}};

constexpr Matrix3 bradford = {{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
constexpr Matrix3 cat16 = {
    {{0.401288, 0.650173, -0.051461}, {-0.250268, 1.204414, 0.045854}, {-0.002079, 0.048952, 0.953127}}};

// X, Y, Z of red, green and blue as columns, of any length.
Matrix3 primary_columns(ColorSpace id) {
  if (id == ColorSpace::lamps) return lamps_to_tristimulus(Observer::cie1931);
  const auto& xy = primaries[static_cast<size_t>(id)];
  Matrix3 columns;
  for (size_t c = 0; c < 3; ++c) {
    columns[0][c] = xy[2 * c];
    columns[1][c] = xy[2 * c + 1];
    columns[2][c] = 1.0 - xy[2 * c] - xy[2 * c + 1];
  }
  return columns;
}

struct Space {
  Samples white_samples;
  Color3 white;
  Matrix3 to_xyz;
  Matrix3 from_xyz;
};

Space make_space(ColorSpace id) {
  Space space;
  space.white_samples = id == ColorSpace::aces2065_1 ? daylight(6000.0 * daylight_shift) : *cie_illuminant("D65");
  space.white = integrate_xyz(space.white_samples);
  const double y = space.white[1];
  for (double& component : space.white) component /= y;

  const Matrix3 columns = primary_columns(id);
  const Color3 scale = multiply(inverse(columns), space.white);
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) space.to_xyz[r][c] = columns[r][c] * scale[c];
  }
  space.from_xyz = inverse(space.to_xyz);
  return space;
}

const Space& space_of(ColorSpace space) {
  static const std::array<Space, color_space_count + 1> spaces = {
      make_space(ColorSpace::srgb), make_space(ColorSpace::dci_p3), make_space(ColorSpace::rec2020),
      make_space(ColorSpace::aces2065_1), make_space(ColorSpace::lamps)};
  return spaces[static_cast<size_t>(space)];
}

}  // namespace

Matrix3 multiply(const Matrix3& a, const Matrix3& b) {
  Matrix3 product{};
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) {
      for (size_t k = 0; k < 3; ++k) product[r][c] += a[r][k] * b[k][c];
    }
  }
  return product;
}

Color3 multiply(const Matrix3& a, const Color3& v) {
  Color3 product{};
  for (size_t r = 0; r < 3; ++r) product[r] = a[r][0] * v[0] + a[r][1] * v[1] + a[r][2] * v[2];
  return product;
}

Matrix3 inverse(const Matrix3& m) {
  const auto cofactor = [&](size_t r, size_t c) {
    const size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
  Matrix3 result;
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) result[c][r] = cofactor(r, c) / determinant;
  }
  return result;
}

std::span<const std::string_view> color_space_names() { return names; }

std::string_view color_space_name(ColorSpace space) {
  return space == ColorSpace::lamps ? "lamps" : names[static_cast<size_t>(space)];
}

std::optional<ColorSpace> find_color_space(std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<ColorSpace>(found - names.begin());
}

const Samples& white_illuminant(ColorSpace space) { return space_of(space).white_samples; }
const Color3& white_xyz(ColorSpace space) { return space_of(space).white; }
const Matrix3& rgb_to_xyz(ColorSpace space) { return space_of(space).to_xyz; }
const Matrix3& xyz_to_rgb(ColorSpace space) { return space_of(space).from_xyz; }

Color3 integrate_xyz(const Samples& spectrum, Observer observer) {
  const ObserverTable& table = observer_table(observer);
  return {integrate(spectrum, table.matching[0]), integrate(spectrum, table.matching[1]),
          integrate(spectrum, table.matching[2])};
}

std::array<double, 2> chromaticity(const Color3& xyz) {
  const double sum = xyz[0] + xyz[1] + xyz[2];
  return {xyz[0] / sum, xyz[1] / sum};
}

Color3 xyz_of_chromaticity(double x, double y) { return {x / y, 1.0, (1.0 - x - y) / y}; }

Matrix3 adaptation_matrix(Adaptation method, const Color3& from, const Color3& to) {
  const Matrix3& cone = method == Adaptation::bradford ? bradford : cat16;
  const Color3 cone_from = multiply(cone, from);
  const Color3 cone_to = multiply(cone, to);
  Matrix3 scaled = cone;
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) scaled[r][c] *= cone_to[r] / cone_from[r];
  }
  return multiply(inverse(cone), scaled);
}

}  // namespace metamer
