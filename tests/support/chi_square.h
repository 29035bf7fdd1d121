// Pearson's chi-square test of a sampler against the density it claims. Header only; for any room's tests.
//
//   std::vector<double> observed(bins), expected(bins);   // counts; expected = draws * probability of the bin
//   EXPECT_GT(chi_square_test(observed, expected).p_value, chi_square_level);
//
// Seeds in tests are fixed, so a passing test stays passing; the level is the chance that a right sampler fails
// when the seed is first chosen.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace metamer {

inline constexpr double chi_square_level = 1e-4;

// Regularised upper incomplete gamma function Q(a, x), a > 0, x >= 0; relative error about 1e-13.
// Series below x = a + 1, continued fraction (modified Lentz) above; DLMF 8.11.4 and 8.9.2.
inline double incomplete_gamma_q(double a, double x) {
  if (!(x > 0)) return 1;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (double n = 1; term > sum * 1e-16 && n < 1e6; n += 1) sum += term *= x / (a + n);
    return std::max(0.0, 1 - front * sum);
  }
  const double tiny = 1e-300;
  double b = x + 1 - a, c = 1 / tiny, d = 1 / b, fraction = d;
  for (double n = 1; n < 1e6; n += 1) {
    const double numerator = -n * (n - a);
    b += 2;
    d = numerator * d + b;
    c = b + numerator / c;
    d = 1 / (std::fabs(d) < tiny ? tiny : d);
    if (std::fabs(c) < tiny) c = tiny;
    fraction *= d * c;
    if (std::fabs(d * c - 1) < 1e-15) break;
  }
  return front * fraction;
}

// The chance that a chi-square variable of that many degrees of freedom is at least `statistic`.
inline double chi_square_p_value(double statistic, double degrees_of_freedom) {
  return incomplete_gamma_q(degrees_of_freedom / 2, statistic / 2);
}

struct ChiSquare {
  double statistic = 0;
  double degrees_of_freedom = 0;
  double p_value = 0;
};

// Bins expecting fewer than `least_expected` are pooled, in ascending order of expectation. A draw in a bin that
// expects none, and a density that does not integrate to the number of draws, make the p-value 0. Where only one
// pool is left there is nothing to test, and the p-value is 1.
inline ChiSquare chi_square_test(std::span<const double> observed, std::span<const double> expected,
                                 double least_expected = 10) {
  std::vector<size_t> order(expected.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });
  ChiSquare result;
  double pooled_observed = 0, pooled_expected = 0, total_observed = 0, total_expected = 0, pools = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    const size_t bin = order[i];
    if (!(expected[bin] > 0) && observed[bin] > 0) return {std::numeric_limits<double>::infinity(), 0, 0};
    total_observed += observed[bin], total_expected += expected[bin];
    pooled_observed += observed[bin], pooled_expected += expected[bin];
    if (pooled_expected < least_expected && i + 1 < order.size()) continue;
    if (!(pooled_expected > 0)) continue;
    const double difference = pooled_observed - pooled_expected;
    result.statistic += difference * difference / pooled_expected;
    pools += 1;
    pooled_observed = pooled_expected = 0;
  }
  // The expectations come from quadrature: allow them an error a test of this many draws could not see.
  if (!(std::fabs(total_observed - total_expected) <= std::sqrt(total_observed))) return {result.statistic, 0, 0};
  result.degrees_of_freedom = pools - 1;
  result.p_value = pools > 1 ? chi_square_p_value(result.statistic, result.degrees_of_freedom) : 1;
  return result;
}

// Integral of f over [x0, x1] x [y0, y1]: 4 x 4 Gauss points in each of pieces x pieces cells.
template <class F>
double integrate_rectangle(const F& f, double x0, double x1, double y0, double y1, int pieces) {
  constexpr std::array<double, 4> node = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                          0.8611363115940526};
  constexpr std::array<double, 4> weight = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                            0.3478548451374538};
  const double hx = (x1 - x0) / pieces, hy = (y1 - y0) / pieces;
  double sum = 0;
  for (int i = 0; i < pieces; ++i) {
    for (int j = 0; j < pieces; ++j) {
      for (size_t a = 0; a < 4; ++a) {
        for (size_t b = 0; b < 4; ++b) {
          sum += weight[a] * weight[b] * f(x0 + hx * (i + 0.5 + node[a] / 2), y0 + hy * (j + 0.5 + node[b] / 2));
        }
      }
    }
  }
  return sum * hx * hy / 4;
}

// Directions drawn against their density per solid angle. A grid of bins in cos(theta) and phi about z, so that
// a bin's solid angle is the product of its sides. Draws that the sampler rejects are added to `rejected`; their
// probability is what is missing of the density's integral.
class DirectionHistogram {
 public:
  explicit DirectionHistogram(size_t cos_bins = 24, size_t phi_bins = 24)
      : cos_bins_(cos_bins), phi_bins_(phi_bins), counts_(cos_bins * phi_bins, 0.0) {}

  void add(double x, double y, double z) {
    const double phi = std::atan2(y, x);
    const auto cell = [](double t, size_t bins) {
      return std::min(static_cast<size_t>(std::max(0.0, t * static_cast<double>(bins))), bins - 1);
    };
    counts_[cell((z + 1) / 2, cos_bins_) * phi_bins_ + cell((phi + pi) / (2 * pi), phi_bins_)] += 1;
    draws_ += 1;
  }
  void reject() {
    rejected_ += 1;
    draws_ += 1;
  }

  // pdf(x, y, z): per solid angle. `pieces`: how finely a bin is integrated; raise it for sharp lobes.
  template <class Pdf>
  ChiSquare test(const Pdf& pdf, int pieces = 4) const {
    std::vector<double> observed = counts_, expected(counts_.size());
    const double dz = 2.0 / static_cast<double>(cos_bins_), dphi = 2 * pi / static_cast<double>(phi_bins_);
    double total = 0;
    for (size_t i = 0; i < cos_bins_; ++i) {
      for (size_t j = 0; j < phi_bins_; ++j) {
        const double z = -1 + dz * static_cast<double>(i), phi = -pi + dphi * static_cast<double>(j);
        const auto density = [&](double c, double p) {
          const double s = std::sqrt(std::max(0.0, 1 - c * c));
          return static_cast<double>(pdf(s * std::cos(p), s * std::sin(p), c));
        };
        expected[i * phi_bins_ + j] = draws_ * integrate_rectangle(density, z, z + dz, phi, phi + dphi, pieces);
        total += expected[i * phi_bins_ + j];
      }
    }
    if (rejected_ > 0) {
      observed.push_back(rejected_);
      expected.push_back(std::max(0.0, draws_ - total));
    }
    return chi_square_test(observed, expected);
  }

 private:
  static constexpr double pi = 3.14159265358979323846;
  size_t cos_bins_, phi_bins_;
  std::vector<double> counts_;
  double draws_ = 0, rejected_ = 0;
};

}  // namespace metamer
