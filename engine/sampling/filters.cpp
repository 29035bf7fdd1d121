#include "engine/sampling/filters.h"

#include <algorithm>
#include <cmath>
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

double sample_axis(FilterKind kind, const Column<float>& correction, double radius, double u) {
  switch (kind) {
    case FilterKind::box: return radius * (2 * u - 1);
    case FilterKind::triangle: return radius * tent_offset(u);
    case FilterKind::gaussian: break;
  }
  return radius * corrected(correction, tent_offset(u));
}

double axis_pdf(FilterKind kind, double radius, double sigma, double integral, double x) {
  if (std::fabs(x) > radius) return 0;
  switch (kind) {
    case FilterKind::box: return 0.5 / radius;
    case FilterKind::triangle: return (radius - std::fabs(x)) / (radius * radius);
    case FilterKind::gaussian: break;
  }
  return gaussian(x, radius, sigma) / integral;
}

}  // namespace

PixelFilter make_pixel_filter(FilterKind kind, double radius_x, double radius_y, double sigma) {
  PixelFilter filter{kind, static_cast<float>(radius_x), static_cast<float>(radius_y), sigma, 1, 1, {}, {}};
  if (kind == FilterKind::gaussian) {
    const GaussianTail tail_x(radius_x, sigma), tail_y(radius_y, sigma);
    filter.correction_x = make_correction(tail_x, radius_x);
    filter.correction_y = make_correction(tail_y, radius_y);
    filter.integral_x = 2 * tail_x.total();
    filter.integral_y = 2 * tail_y.total();
  }
  return filter;
}

double filter_pdf(const PixelFilter& filter, double x, double y) {
  return axis_pdf(filter.kind, static_cast<double>(filter.radius_x), filter.sigma, filter.integral_x, x) *
         axis_pdf(filter.kind, static_cast<double>(filter.radius_y), filter.sigma, filter.integral_y, y);
}

PointD2 sample_filter(const PixelFilter& filter, double u, double v) {
  return {sample_axis(filter.kind, filter.correction_x, static_cast<double>(filter.radius_x), u),
          sample_axis(filter.kind, filter.correction_y, static_cast<double>(filter.radius_y), v)};
}

}  // namespace metamer
