#include "engine/spectrum/metamers.h"

#include <algorithm>
#include <cmath>

#include "engine/simd/portable_math.h"
#include "engine/spectrum/lab.h"

namespace metamer {
namespace {

constexpr size_t n = metamer_points;
constexpr double roughness_price = 1000.0;

// Rows: X, Y, Z that one unit at each point adds, white having Y = 1.
using Weights = std::array<MetamerCurve, 3>;

Weights weights_of(const Viewing& viewing) {
  Weights weights{};
  for (size_t point = 0; point < n; ++point) {
    MetamerCurve unit{};
    unit[point] = 1;
    const Color3 xyz = seen_xyz(metamer_samples(unit), viewing);
    for (size_t row = 0; row < 3; ++row) weights[row][point] = xyz[row];
  }
  return weights;
}

Color3 xyz_of(const Weights& weights, const MetamerCurve& curve) {
  Color3 xyz{};
  for (size_t row = 0; row < 3; ++row)
    for (size_t point = 0; point < n; ++point) xyz[row] += weights[row][point] * curve[point];
  return xyz;
}

Color3 white_of(const Weights& weights) {
  MetamerCurve ones;
  ones.fill(1);
  return xyz_of(weights, ones);
}

// Solves a x = b in place by Gaussian elimination with row pivoting; a is regular.
constexpr size_t unknowns = n + 3;
using System = std::array<std::array<double, unknowns + 1>, unknowns>;
void solve(System& a) {
  for (size_t column = 0; column < unknowns; ++column) {
    size_t pivot = column;
    for (size_t row = column + 1; row < unknowns; ++row)
      if (std::fabs(a[row][column]) > std::fabs(a[pivot][column])) pivot = row;
    std::swap(a[column], a[pivot]);
    for (size_t row = 0; row < unknowns; ++row) {
      if (row == column) continue;
      const double factor = a[row][column] / a[column][column];
      for (size_t k = column; k <= unknowns; ++k) a[row][k] -= factor * a[column][k];
    }
  }
  for (size_t row = 0; row < unknowns; ++row) a[row][unknowns] /= a[row][row];
}

// The d of metamers.h before it is made longer: (1000 D'D + 1) d + W' v = g, W d = 0, D taking third differences.
MetamerCurve steepest_black(const Weights& same, const MetamerCurve& gradient) {
  constexpr std::array<double, 4> third_difference = {-1, 3, -3, 1};
  System system{};
  for (size_t first = 0; first + 4 <= n; ++first)
    for (size_t i = 0; i < 4; ++i)
      for (size_t k = 0; k < 4; ++k)
        system[first + i][first + k] += roughness_price * third_difference[i] * third_difference[k];
  for (size_t point = 0; point < n; ++point) {
    system[point][point] += 1;
    system[point][unknowns] = gradient[point];
    for (size_t row = 0; row < 3; ++row) system[point][n + row] = system[n + row][point] = same[row][point];
  }
  solve(system);
  MetamerCurve black;
  for (size_t point = 0; point < n; ++point) black[point] = system[point][unknowns];
  return black;
}

// How a step at each point moves a colour along cos(hue) a* + sin(hue) b*.
MetamerCurve hue_gradient(const Weights& weights, const MetamerCurve& base, double hue) {
  constexpr double step = 1e-5;
  const Color3 white = white_of(weights), at = xyz_of(weights, base);
  MetamerCurve gradient{};
  for (size_t row = 0; row < 3; ++row) {
    Color3 above = at, below = at;
    above[row] += step;
    below[row] -= step;
    const Color3 more = lab_of_xyz(above, white), less = lab_of_xyz(below, white);
    const double slope =
        (portable::cos(hue) * (more[1] - less[1]) + portable::sin(hue) * (more[2] - less[2])) / (2 * step);
    for (size_t point = 0; point < n; ++point) gradient[point] += slope * weights[row][point];
  }
  return gradient;
}

std::array<MetamerCurve, 2> as_far_as_bounds_allow(const MetamerCurve& base, const MetamerCurve& black) {
  double length = 1e30;
  for (size_t point = 0; point < n; ++point) {
    const double room = std::min(base[point] - metamer_least, metamer_most - base[point]);
    if (black[point] != 0) length = std::min(length, room / std::fabs(black[point]));
  }
  std::array<MetamerCurve, 2> pair = {base, base};
  for (size_t point = 0; point < n; ++point) {
    pair[0][point] = std::clamp(base[point] + length * black[point], metamer_least, metamer_most);
    pair[1][point] = std::clamp(base[point] - length * black[point], metamer_least, metamer_most);
  }
  return pair;
}

double difference(const Weights& weights, const std::array<MetamerCurve, 2>& pair) {
  const Color3 white = white_of(weights);
  return delta_e_1976(lab_of_xyz(xyz_of(weights, pair[0]), white), lab_of_xyz(xyz_of(weights, pair[1]), white));
}

}  // namespace

Samples metamer_samples(const MetamerCurve& curve) {
  MetamerCurve lambda_nm;
  for (size_t point = 0; point < n; ++point) lambda_nm[point] = metamer_lambda_nm(point);
  return resample(lambda_nm, curve, Extend::constant);
}

std::array<MetamerCurve, 2> make_metamers(const Samples& base, const Viewing& same,
                                          const std::array<Viewing, 2>& apart) {
  MetamerCurve middle;
  for (size_t point = 0; point < n; ++point)
    middle[point] = std::clamp(interpolate(base, metamer_lambda_nm(point)), metamer_least, metamer_most);
  const Weights alike = weights_of(same);
  const std::array<Weights, 2> other = {weights_of(apart[0]), weights_of(apart[1])};
  std::array<MetamerCurve, 2> best = {middle, middle};
  double best_difference = 0;
  for (const Weights& weights : other)
    for (int direction = 0; direction < 12; ++direction) {
      const MetamerCurve gradient = hue_gradient(weights, middle, M_PI / 12 * direction);
      const std::array<MetamerCurve, 2> pair = as_far_as_bounds_allow(middle, steepest_black(alike, gradient));
      const double smaller = std::min(difference(other[0], pair), difference(other[1], pair));
      if (smaller <= best_difference) continue;
      best_difference = smaller;
      best = pair;
    }
  return best;
}

Color3 seen_xyz(const Samples& reflectance, const Viewing& viewing) {
  Samples reflected;
  for (size_t i = 0; i < lambda_count; ++i) reflected[i] = reflectance[i] * viewing.light[i];
  const double white = integrate(viewing.light, observer_table(viewing.observer).matching[1]);
  Color3 xyz = integrate_xyz(reflected, viewing.observer);
  for (double& v : xyz) v /= white;
  return xyz;
}

double seen_difference(const Samples& a, const Samples& b, const Viewing& viewing) {
  Samples perfect;
  perfect.fill(1);
  const Color3 white = seen_xyz(perfect, viewing);
  return delta_e_1976(lab_of_xyz(seen_xyz(a, viewing), white), lab_of_xyz(seen_xyz(b, viewing), white));
}

}  // namespace metamer
