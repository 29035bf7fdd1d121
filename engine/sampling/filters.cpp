#include "engine/sampling/filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/simd/portable_math.h"

namespace metamer {
namespace {

// exp(-x^2 / (2 sigma^2)) - exp(-radius^2 / (2 sigma^2)), without its cancellation near the radius.
double gaussian(double x, double radius, double sigma) {
  const double half = (radius * radius - x * x) / (4 * sigma * sigma);
  const double mean = (radius * radius + x * x) / (4 * sigma * sigma);
  if (half > 0.1) return portable::exp(half - mean) - portable::exp(-half - mean);
  // 2 sinh(half) by its series, to 1e-14.
  const double z = half * half;
  return portable::exp(-mean) * 2 * half * (1 + z / 6 * (1 + z / 20 * (1 + z / 42 * (1 + z / 72))));
}

// The one-dimensional gaussian on [0, radius] and its tail integral, from Simpson's rule on a fine grid.
class GaussianTail {
 public:
  GaussianTail(double radius, double sigma) : radius_(radius), sigma_(sigma), tail_(cells + 1, 0.0) {
    for (int i = cells - 1; i >= 0; --i) {
      const double x0 = at(i), x1 = at(i + 1);
      tail_[static_cast<size_t>(i)] = tail_[static_cast<size_t>(i) + 1] + integral(x0, x1);
    }
  }
  double value(double x) const { return gaussian(x, radius_, sigma_); }
  double total() const { return tail_[0]; }
  // The x whose tail integral is `fraction` of the whole.
  double invert(double fraction) const {
    const double wanted = fraction * total();
    // tail_ falls: the last grid point whose tail is at least what is wanted.
    const auto above = std::partition_point(tail_.begin(), tail_.end(), [&](double t) { return t >= wanted; });
    const int cell = std::clamp(static_cast<int>(above - tail_.begin()) - 1, 0, cells - 1);
    double low = at(cell), high = at(cell + 1);
    const double beyond = tail_[static_cast<size_t>(cell) + 1];
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (beyond + integral(middle, at(cell + 1)) >= wanted ? low : high) = middle;
    }
    return low;
  }

 private:
  static constexpr int cells = 4096;
  double at(int i) const { return radius_ * i / cells; }
  double integral(double a, double b) const { return (b - a) / 6 * (value(a) + 4 * value((a + b) / 2) + value(b)); }
  double radius_, sigma_;
  std::vector<double> tail_;
};

Column<float> make_correction(const GaussianTail& tail, double radius) {
  Column<float> correction(filter_table_cells + 1);
  for (uint32_t i = 0; i <= filter_table_cells; ++i) {
    const double rest = 1 - static_cast<double>(i) / filter_table_cells;
    correction[i] = static_cast<float>(tail.invert(rest * rest) / radius);
  }
  correction[0] = 0;
  correction[filter_table_cells] = 1;
  return correction;
}

double tent_offset(double u) { return u < 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u); }

double corrected(const Column<float>& correction, double t) {
  const double position = std::fabs(t) * filter_table_cells;
  const auto cell = std::min(static_cast<size_t>(position), size_t{filter_table_cells - 1});
  const double a = static_cast<double>(correction[cell]), b = static_cast<double>(correction[cell + 1]);
  return std::copysign(a + (b - a) * (position - static_cast<double>(cell)), t);
}

// pbrt-v4's Mitchell1D at 2 x / radius.
double mitchell(double x, double radius, double b, double c) {
  x = std::fabs(2 * x / radius);
  if (x <= 1) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
  if (x > 2) return 0;
  return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) / 6;
}

double sinc(double x) {
  const double angle = std::numbers::pi * x;
  return std::fabs(angle) < 1e-5 ? 1 : portable::sin(angle) / angle;
}

double signed_value(FilterKind kind, const FilterParameters& parameters, double radius, double x) {
  if (kind == FilterKind::mitchell)
    return mitchell(x, radius, static_cast<double>(parameters.b), static_cast<double>(parameters.c));
  return sinc(x) * sinc(x / static_cast<double>(parameters.tau));
}

// The tables of one axis: cells of equal integrals of the magnitude, and what they weigh. Returns the integral from
// -radius to radius.
double make_signed_tables(FilterKind kind, const FilterParameters& parameters, double radius, Column<float>& correction,
                          Column<float>& weights) {
  constexpr size_t steps = size_t{1} << 16;  // midpoints
  const double width = radius / steps;
  std::vector<double> magnitudes(steps + 1, 0.0), integrals(steps + 1, 0.0);  // from 0 up to each step
  for (size_t i = 0; i < steps; ++i) {
    const double value = signed_value(kind, parameters, radius, (static_cast<double>(i) + 0.5) * width) * width;
    magnitudes[i + 1] = magnitudes[i] + std::fabs(value);
    integrals[i + 1] = integrals[i] + value;
  }
  correction.resize(filter_table_cells + 1);
  weights.resize(filter_table_cells);
  size_t step = 0;
  double before = 0;
  for (uint32_t cell = 0; cell < filter_table_cells; ++cell) {
    const double wanted = magnitudes[steps] * (cell + 1) / filter_table_cells;
    while (step + 1 < steps && magnitudes[step + 1] < wanted) ++step;
    const double height = magnitudes[step + 1] - magnitudes[step];
    const double share = height > 0 ? std::clamp((wanted - magnitudes[step]) / height, 0.0, 1.0) : 1;
    const double until = integrals[step] + share * (integrals[step + 1] - integrals[step]);
    correction[cell + 1] = static_cast<float>((static_cast<double>(step) + share) / steps);
    weights[cell] = static_cast<float>((until - before) * filter_table_cells / integrals[steps]);
    before = until;
  }
  correction[0] = 0;
  correction[filter_table_cells] = 1;
  return 2 * integrals[steps];
}

// The cell of |t|, t uniform from -1 to 1.
size_t signed_cell(double u) {
  return std::min(static_cast<size_t>(std::fabs(2 * u - 1) * filter_table_cells), size_t{filter_table_cells - 1});
}

double sample_axis(FilterKind kind, const Column<float>& correction, double radius, double u) {
  switch (kind) {
    case FilterKind::box: return radius * (2 * u - 1);
    case FilterKind::triangle: return radius * tent_offset(u);
    case FilterKind::gaussian: return radius * corrected(correction, tent_offset(u));
    case FilterKind::mitchell:
    case FilterKind::sinc: break;
  }
  return radius * corrected(correction, 2 * u - 1);
}

double axis_value(FilterKind kind, double radius, const FilterParameters& parameters, double integral, double x) {
  if (std::fabs(x) > radius) return 0;
  switch (kind) {
    case FilterKind::box: return 0.5 / radius;
    case FilterKind::triangle: return (radius - std::fabs(x)) / (radius * radius);
    case FilterKind::gaussian: return gaussian(x, radius, static_cast<double>(parameters.sigma)) / integral;
    case FilterKind::mitchell:
    case FilterKind::sinc: break;
  }
  return signed_value(kind, parameters, radius, x) / integral;
}

}  // namespace

PixelFilter make_pixel_filter(FilterKind kind, double radius_x, double radius_y, const FilterParameters& parameters) {
  PixelFilter filter;
  filter.kind = kind;
  filter.radius_x = static_cast<float>(radius_x);
  filter.radius_y = static_cast<float>(radius_y);
  filter.parameters = parameters;
  if (kind == FilterKind::gaussian) {
    const double sigma = static_cast<double>(parameters.sigma);
    const GaussianTail tail_x(radius_x, sigma), tail_y(radius_y, sigma);
    filter.correction_x = make_correction(tail_x, radius_x);
    filter.correction_y = make_correction(tail_y, radius_y);
    filter.integral_x = 2 * tail_x.total();
    filter.integral_y = 2 * tail_y.total();
  }
  if (filter.is_signed()) {
    filter.integral_x = make_signed_tables(kind, parameters, radius_x, filter.correction_x, filter.weights_x);
    filter.integral_y = make_signed_tables(kind, parameters, radius_y, filter.correction_y, filter.weights_y);
  }
  return filter;
}

double filter_value(const PixelFilter& filter, double x, double y) {
  const double radius_x = static_cast<double>(filter.radius_x), radius_y = static_cast<double>(filter.radius_y);
  return axis_value(filter.kind, radius_x, filter.parameters, filter.integral_x, x) *
         axis_value(filter.kind, radius_y, filter.parameters, filter.integral_y, y);
}

PointD2 sample_filter(const PixelFilter& filter, double u, double v) {
  return {sample_axis(filter.kind, filter.correction_x, static_cast<double>(filter.radius_x), u),
          sample_axis(filter.kind, filter.correction_y, static_cast<double>(filter.radius_y), v)};
}

double filter_weight(const PixelFilter& filter, double u, double v) {
  if (!filter.is_signed()) return 1;
  return static_cast<double>(filter.weights_x[signed_cell(u)]) * static_cast<double>(filter.weights_y[signed_cell(v)]);
}

}  // namespace metamer
