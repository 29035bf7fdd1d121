#include "engine/spectrum/samples.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace metamer {
namespace {

struct Curve {
  std::span<const double> lambda_nm;
  std::span<const double> values;
  Extend extend;

  // Outside the range of a curve that ends at zero the value jumps; at the end points themselves it does not.
  double operator()(double lambda) const {
    if (lambda < lambda_nm.front()) return extend == Extend::zero ? 0.0 : values.front();
    if (lambda > lambda_nm.back()) return extend == Extend::zero ? 0.0 : values.back();
    const size_t upper = std::max<size_t>(
        1, static_cast<size_t>(std::lower_bound(lambda_nm.begin(), lambda_nm.end(), lambda) - lambda_nm.begin()));
    const double width = lambda_nm[upper] - lambda_nm[upper - 1];
    const double fraction = (lambda - lambda_nm[upper - 1]) / width;
    return values[upper - 1] * (1.0 - fraction) + values[upper] * fraction;
  }
};

// Whether the curve has an interval shorter than 1 nm that overlaps the open range (center - 1, center + 1).
bool finer_than_1nm_around(const Curve& curve, double center) {
  const auto first = std::upper_bound(curve.lambda_nm.begin(), curve.lambda_nm.end(), center - 1.0);
  for (size_t i = std::max<size_t>(1, static_cast<size_t>(first - curve.lambda_nm.begin()));
       i < curve.lambda_nm.size() && curve.lambda_nm[i - 1] < center + 1.0; ++i) {
    if (curve.lambda_nm[i] - curve.lambda_nm[i - 1] < 1.0 - 1e-6) return true;
  }
  return false;
}

// Integral of curve times hat over [a, b], on which both are linear: Simpson's rule is exact for their product.
double integrate_piece(const Curve& curve, double center, double a, double b) {
  const auto f = [&](double lambda) { return curve(lambda) * (1.0 - std::abs(lambda - center)); };
  return (b - a) / 6.0 * (f(a) + 4.0 * f(0.5 * (a + b)) + f(b));
}

double hat_mean(const Curve& curve, double center) {
  std::vector<double> knots = {center - 1.0, center, center + 1.0};
  const auto first = std::upper_bound(curve.lambda_nm.begin(), curve.lambda_nm.end(), center - 1.0);
  for (auto knot = first; knot != curve.lambda_nm.end() && *knot < center + 1.0; ++knot) knots.push_back(*knot);
  std::sort(knots.begin(), knots.end());
  double sum = 0.0;
  for (size_t i = 1; i < knots.size(); ++i) {
    // A curve cut off at zero is not continuous at its ends: outside pieces contribute nothing.
    const double middle = 0.5 * (knots[i - 1] + knots[i]);
    const bool outside = middle < curve.lambda_nm.front() || middle > curve.lambda_nm.back();
    if (outside && curve.extend == Extend::zero) continue;
    sum += integrate_piece(curve, center, knots[i - 1], knots[i]);
  }
  return sum;
}

}  // namespace

double interpolate(const Samples& samples, double lambda_nm) {
  const double position = std::clamp(lambda_nm - lambda_min_nm, 0.0, static_cast<double>(lambda_count - 1));
  const size_t lower = std::min(static_cast<size_t>(position), lambda_count - 2);
  const double fraction = position - static_cast<double>(lower);
  return samples[lower] * (1.0 - fraction) + samples[lower + 1] * fraction;
}

Samples resample(std::span<const double> lambda_nm, std::span<const double> values, Extend extend) {
  const Curve curve{lambda_nm, values, extend};
  Samples samples;
  for (size_t i = 0; i < lambda_count; ++i) {
    const double lambda = lambda_min_nm + static_cast<double>(i);
    samples[i] = finer_than_1nm_around(curve, lambda) ? hat_mean(curve, lambda) : curve(lambda);
  }
  return samples;
}

Samples resample(const DataTable& table, size_t column, Extend extend) {
  std::vector<double> lambda_nm(table.rows());
  std::vector<double> values(table.rows());
  for (size_t row = 0; row < table.rows(); ++row) {
    lambda_nm[row] = table.at(row, 0);
    values[row] = table.at(row, column);
  }
  return resample(lambda_nm, values, extend);
}

double integrate(const Samples& a, const Samples& b) {
  double sum = 0.0;
  for (size_t i = 0; i < lambda_count; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace metamer
