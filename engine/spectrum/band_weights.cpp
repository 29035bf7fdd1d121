#include "engine/spectrum/band_weights.h"

#include <algorithm>
#include <cmath>

namespace metamer {
namespace {

// The value at edge i: `below` m[i - 1] + `above` m[i].
struct EdgeValue {
  double below, above;
};
EdgeValue edge_value(std::span<const double> edges_nm, size_t i) {
  const size_t band_count = edges_nm.size() - 1;
  if (i == 0) return {0, 1};
  if (i == band_count) return {1, 0};
  const double below_nm = edges_nm[i] - edges_nm[i - 1], above_nm = edges_nm[i + 1] - edges_nm[i];
  return {above_nm / (below_nm + above_nm), below_nm / (below_nm + above_nm)};
}

// What the two edges and the mean contribute to the curve at t.
std::array<double, 3> shape(double t) {
  const double bulge = 3 * t * (1 - t);
  return {1 - t - bulge, t - bulge, 2 * bulge};
}

// Integrals over [from, to] of the matching functions times `terms` functions of lambda that are at most parabolas.
// Matching functions are linear between whole nanometres, so Simpson's rule over pieces of those is exact.
template <size_t terms, class F>
std::array<std::array<double, terms>, 3> integrals(Observer observer, double from_nm, double to_nm, F&& functions) {
  std::array<std::array<double, terms>, 3> sums{};
  from_nm = std::max(from_nm, double{lambda_min_nm});
  to_nm = std::min(to_nm, double{lambda_max_nm});
  while (from_nm < to_nm) {
    const double end_nm = std::min(to_nm, std::floor(from_nm) + 1), step_nm = end_nm - from_nm;
    for (const auto& [at, weight] : {std::pair(0.0, 1.0 / 6), {0.5, 4.0 / 6}, {1.0, 1.0 / 6}}) {
      const double lambda_nm = from_nm + at * step_nm;
      const std::array<double, 3> matching = observer_value(observer, lambda_nm);
      const std::array<double, terms> values = functions(lambda_nm);
      for (size_t c = 0; c < 3; ++c)
        for (size_t k = 0; k < terms; ++k) sums[c][k] += weight * step_nm * matching[c] * values[k];
    }
    from_nm = end_nm;
  }
  return sums;
}

Matrix3 fit_stiles_burch() {
  const auto& rgb = observer_table(Observer::stiles_burch1955).matching;
  const auto& xyz = observer_table(Observer::cie1931).matching;
  Matrix3 normal{}, right{};  // of the normal equations
  for (size_t i = 390 - lambda_min_nm; i <= 730 - lambda_min_nm; i += 5)
    for (size_t r = 0; r < 3; ++r)
      for (size_t c = 0; c < 3; ++c) {
        normal[r][c] += rgb[r][i] * rgb[c][i];
        right[r][c] += xyz[r][i] * rgb[c][i];
      }
  return multiply(right, inverse(normal));
}

}  // namespace

double band_curve(std::span<const double> edges_nm, std::span<const double> means, double lambda_nm) {
  if (lambda_nm <= edges_nm.front()) return means.front();
  if (lambda_nm >= edges_nm.back()) return means.back();
  const auto above = std::upper_bound(edges_nm.begin(), edges_nm.end(), lambda_nm);
  const auto b = static_cast<size_t>(above - edges_nm.begin()) - 1;
  const auto edge = [&](size_t i) {
    const EdgeValue e = edge_value(edges_nm, i);
    return (i > 0 ? e.below * means[i - 1] : 0) + (i < means.size() ? e.above * means[i] : 0);
  };
  const std::array<double, 3> s = shape((lambda_nm - edges_nm[b]) / (edges_nm[b + 1] - edges_nm[b]));
  return s[0] * edge(b) + s[1] * edge(b + 1) + s[2] * means[b];
}

std::array<std::vector<double>, 3> band_weights(std::span<const double> edges_nm, Observer observer) {
  const size_t band_count = edges_nm.size() - 1;
  std::array<std::vector<double>, 3> weights;
  for (std::vector<double>& row : weights) row.resize(band_count);
  const auto one = [](double) { return std::array<double, 1>{1}; };
  const auto below = integrals<1>(observer, lambda_min_nm, edges_nm.front(), one);
  const auto beyond = integrals<1>(observer, edges_nm.back(), lambda_max_nm, one);
  for (size_t c = 0; c < 3; ++c) {
    weights[c].front() += luminous_efficacy * below[c][0];
    weights[c].back() += luminous_efficacy * beyond[c][0];
  }
  for (size_t b = 0; b < band_count; ++b) {
    const double from_nm = edges_nm[b], to_nm = edges_nm[b + 1];
    const auto parts = integrals<3>(observer, from_nm, to_nm,
                                    [&](double lambda_nm) { return shape((lambda_nm - from_nm) / (to_nm - from_nm)); });
    const EdgeValue left = edge_value(edges_nm, b), right = edge_value(edges_nm, b + 1);
    for (size_t c = 0; c < 3; ++c) {
      const double k = luminous_efficacy;
      if (b > 0) weights[c][b - 1] += k * parts[c][0] * left.below;
      weights[c][b] += k * (parts[c][0] * left.above + parts[c][1] * right.below + parts[c][2]);
      if (b + 1 < band_count) weights[c][b + 1] += k * parts[c][1] * right.above;
    }
  }
  return weights;
}

const Matrix3& stiles_burch_to_xyz() {
  static const Matrix3 matrix = fit_stiles_burch();
  return matrix;
}

Matrix3 observer_to_xyz(Observer observer, const Samples& white) {
  constexpr Matrix3 identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  if (observer == Observer::cie1931) return identity;
  const Matrix3& to_xyz = observer == Observer::stiles_burch1955 ? stiles_burch_to_xyz() : identity;
  const auto with_unit_luminance = [](Color3 xyz) { return Color3{xyz[0] / xyz[1], 1, xyz[2] / xyz[1]}; };
  const Color3 from = with_unit_luminance(multiply(to_xyz, integrate_xyz(white, observer)));
  const Color3 to = with_unit_luminance(integrate_xyz(white));
  return multiply(adaptation_matrix(Adaptation::cat16, from, to), to_xyz);
}

}  // namespace metamer
