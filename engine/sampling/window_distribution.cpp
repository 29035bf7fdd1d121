#include "engine/sampling/window_distribution.h"

#include <algorithm>
#include <cmath>

namespace metamer {
namespace {

constexpr double mean_of_cells = 4096;

double usable(double weight) { return weight > 0 && std::isfinite(weight) ? std::min(weight, 1e300) : 0; }

// The cells that an interval touches, and how much of the first and the last; of one cell only the first part counts.
struct Cells {
  int32_t first, last;
  float start, end;  // the interval, in cells
  float first_part, last_part;
};
Cells cells_of(float from, float to, uint32_t count) {
  Cells cells;
  const float n = static_cast<float>(count);
  cells.start = std::max(0.0f, std::min(from, 1.0f)) * n;
  cells.end = std::max(0.0f, std::min(to, 1.0f)) * n;
  cells.first = std::min(static_cast<int32_t>(cells.start), static_cast<int32_t>(count) - 1);
  cells.last = std::min(static_cast<int32_t>(cells.end), static_cast<int32_t>(count) - 1);
  const bool one = cells.first == cells.last;
  cells.first_part = (one ? cells.end : static_cast<float>(cells.first + 1)) - cells.start;
  cells.last_part = one ? 0 : cells.end - static_cast<float>(cells.last);
  return cells;
}

struct Sums {
  const int32_t* data;
  int32_t stride;
  explicit Sums(const WindowDistribution& d) : data(d.sums.data()), stride(static_cast<int32_t>(d.width) + 1) {}
  float rectangle(int32_t x0, int32_t x1, int32_t y0, int32_t y1) const {
    const int32_t *upper = data + y0 * stride, *lower = data + y1 * stride;
    return static_cast<float>((lower[x1] - lower[x0]) - (upper[x1] - upper[x0]));
  }
  // Columns [x0, x1) within the rows' interval.
  float strip(int32_t x0, int32_t x1, const Cells& rows) const {
    const float inner = rectangle(x0, x1, std::min(rows.first + 1, rows.last), rows.last);
    const float upper = std::fma(rows.first_part, rectangle(x0, x1, rows.first, rows.first + 1), inner);
    return std::fma(rows.last_part, rectangle(x0, x1, rows.last, rows.last + 1), upper);
  }
  // Of the window left of column `x`, which is not left of the first.
  float before(int32_t x, const Cells& columns, const Cells& rows) const {
    if (x <= columns.first) return 0;
    return std::fma(columns.first_part, strip(columns.first, columns.first + 1, rows),
                    strip(columns.first + 1, x, rows));
  }
  float window(const Cells& columns, const Cells& rows) const {
    const bool one = columns.first == columns.last;
    return std::fma(one ? columns.first_part : columns.last_part, strip(columns.last, columns.last + 1, rows),
                    before(columns.last, columns, rows));
  }
  // Of column x within the rows' interval above row y.
  float above(int32_t y, int32_t x, const Cells& rows) const {
    if (y <= rows.first) return 0;
    return std::fma(rows.first_part, rectangle(x, x + 1, rows.first, rows.first + 1),
                    rectangle(x, x + 1, rows.first + 1, y));
  }
};

// The last cell with at most `target` before it.
template <class Before>
int32_t find_cell(const Cells& cells, float target, const Before& before) {
  int32_t low = cells.first, high = cells.last;
  while (low < high) {
    const int32_t middle = (low + high + 1) / 2;
    if (before(middle) <= target)
      low = middle;
    else
      high = middle - 1;
  }
  return low;
}

float place_in_cell(const Cells& cells, int32_t cell, float rest, float density) {
  const float start = std::max(cells.start, static_cast<float>(cell));
  const float end = std::min(cells.end, static_cast<float>(cell + 1));
  return std::min(start + rest / density, end);
}

bool is_empty(const DensityWindow& window) { return !(window.x1 > window.x0 && window.y1 > window.y0); }

}  // namespace

WindowDistribution make_window_distribution(std::span<const double> weights, uint32_t width, uint32_t height) {
  WindowDistribution distribution;
  distribution.width = width;
  distribution.height = height;
  distribution.sums.resize(size_t{width + 1} * (height + 1));
  double largest = 0, sum = 0;
  for (const double w : weights) largest = std::max(largest, usable(w));
  for (const double w : weights) sum += largest > 0 ? usable(w) / largest : 1;
  const double per_weight = mean_of_cells * static_cast<double>(weights.size()) / sum;
  for (uint32_t y = 0; y < height; ++y) {
    int32_t row = 0;
    for (uint32_t x = 0; x < width; ++x) {
      const double weight = largest > 0 ? usable(weights[size_t{y} * width + x]) / largest : 1;
      row += std::max(1, static_cast<int32_t>(weight * per_weight + 0.5));
      const size_t above = size_t{y} * (width + 1) + x + 1;
      distribution.sums[above + width + 1] = distribution.sums[above] + row;
    }
  }
  return distribution;
}

WindowSample sample_window(const WindowDistribution& distribution, const DensityWindow& window, float u, float v) {
  if (is_empty(window)) return {};
  const Sums sums(distribution);
  const Cells columns = cells_of(window.x0, window.x1, distribution.width);
  const Cells rows = cells_of(window.y0, window.y1, distribution.height);
  const float total = sums.window(columns, rows), target = u * total;
  if (!(total > 0)) return {};
  const int32_t x = find_cell(columns, target, [&](int32_t c) { return sums.before(c, columns, rows); });
  const float column = sums.strip(x, x + 1, rows);
  WindowSample sample;
  sample.x = place_in_cell(columns, x, target - sums.before(x, columns, rows), column);
  const float target_y = v * column;
  const int32_t y = find_cell(rows, target_y, [&](int32_t r) { return sums.above(r, x, rows); });
  const float cell = sums.rectangle(x, x + 1, y, y + 1);
  sample.y = place_in_cell(rows, y, target_y - sums.above(y, x, rows), cell);
  const float cells = static_cast<float>(distribution.width) * static_cast<float>(distribution.height);
  sample.x /= static_cast<float>(distribution.width);
  sample.y /= static_cast<float>(distribution.height);
  sample.pdf = cell * cells / total;
  return sample;
}

float window_pdf(const WindowDistribution& distribution, const DensityWindow& window, float x, float y) {
  if (is_empty(window) || !(x >= window.x0 && x <= window.x1 && y >= window.y0 && y <= window.y1)) return 0;
  const Sums sums(distribution);
  const Cells columns = cells_of(window.x0, window.x1, distribution.width);
  const Cells rows = cells_of(window.y0, window.y1, distribution.height);
  const Cells at_x = cells_of(x, x, distribution.width), at_y = cells_of(y, y, distribution.height);
  const float total = sums.window(columns, rows);
  const float cells = static_cast<float>(distribution.width) * static_cast<float>(distribution.height);
  const float cell = sums.rectangle(at_x.first, at_x.first + 1, at_y.first, at_y.first + 1);
  return total > 0 ? cell * cells / total : 0;
}

}  // namespace metamer
