#include "engine/sampling/distribution.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace metamer {
namespace {

using distribution_detail::just_above_one;
using distribution_detail::just_below_one;
using distribution_detail::largest_below_one;

constexpr double grid = 0x1p24;

// Capped where sums of them could overflow.
double usable(double weight) { return weight > 0 && std::isfinite(weight) ? std::min(weight, 1e300) : 0; }

// Writes weights.size() + 1 values. Returns the sum of the usable weights.
double write_cdf(std::span<const double> weights, float* cdf) {
  const size_t n = weights.size();
  // Scaled by the largest, so that no sum overflows.
  double largest = 0, scaled_sum = 0;
  for (const double w : weights) largest = std::max(largest, usable(w));
  for (const double w : weights) scaled_sum += largest > 0 ? usable(w) / largest : 1;
  // Steps of the grid: rounded sums, but each positive weight at least one step beyond the last bin, forwards; and
  // what that pushed past the end taken back, backwards.
  std::vector<int64_t> steps(n + 1, 0);
  const auto positive = [&](size_t i) { return !(largest > 0) || usable(weights[i]) > 0; };
  double running = 0;
  for (size_t i = 0; i < n; ++i) {
    running += largest > 0 ? usable(weights[i]) / largest : 1;
    const auto rounded = static_cast<int64_t>(std::floor(running / scaled_sum * grid + 0.5));
    steps[i + 1] = positive(i) ? std::max(rounded, steps[i] + 1) : steps[i];
  }
  int64_t limit = static_cast<int64_t>(grid);
  bool last = true;
  for (size_t i = n; i-- > 0;) {
    // The last positive bin ends at 1 whatever the rounding.
    steps[i + 1] = last ? limit : std::min(steps[i + 1], limit);
    if (positive(i)) {
      last = false;
      limit = steps[i + 1] - 1;
    }
  }
  for (size_t i = 0; i <= n; ++i) cdf[i] = static_cast<float>(static_cast<double>(steps[i]) / grid);
  return largest > 0 ? scaled_sum * largest : 0;
}

// The last bin in [low, high] that starts at or below u: bins of no width are passed over.
uint32_t find_bin(const float* cdf, uint32_t low, uint32_t high, float u) {
  while (low < high) {
    const uint32_t middle = (low + high + 1) / 2;
    if (cdf[middle] <= u) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

// Writes guide_cells(bins) + 1 values: the bins of the cells' first numbers, and that of the last number of all.
void write_guide(const float* cdf, uint32_t bins, int32_t* guide) {
  const uint32_t cells = guide_cells(bins);
  uint32_t bin = 0;
  for (uint32_t k = 0; k <= cells; ++k) {
    const float u = std::min(static_cast<float>(k) / static_cast<float>(cells), largest_below_one);
    while (bin + 1 < bins && cdf[bin + 1] <= u) ++bin;
    guide[k] = static_cast<int32_t>(bin);
  }
}

DiscreteSample sample_cdf(const float* cdf, const int32_t* guide, uint32_t bins, float u) {
  u = std::max(0.0f, std::min(largest_below_one, u));
  const auto cell = static_cast<uint32_t>(u * static_cast<float>(guide_cells(bins)));
  const uint32_t bin = find_bin(cdf, static_cast<uint32_t>(guide[cell]), static_cast<uint32_t>(guide[cell + 1]), u);
  const float start = cdf[bin], probability = cdf[bin + 1] - start;
  return {bin, probability, std::min((u - start) / probability, largest_below_one)};
}

// (bin + offset) / bins, so far inside the bin that rounding in bin_of does not lead to a neighbour, whose density
// may be of another order.
float coordinate(uint32_t bin, float offset, uint32_t bins) {
  const float start = static_cast<float>(bin);
  const float inside = std::max(std::min(start + offset, (start + 1) * just_below_one), start * just_above_one);
  return inside / static_cast<float>(bins);
}

uint32_t bin_of(float x, uint32_t bins) {
  const float position = std::max(0.0f, x) * static_cast<float>(bins);
  return std::min(static_cast<uint32_t>(std::min(position, static_cast<float>(bins))), bins - 1);
}

}  // namespace

Distribution1D make_distribution_1d(std::span<const double> weights) {
  Distribution1D distribution;
  distribution.cdf.resize(weights.size() + 1);
  distribution.sum = write_cdf(weights, distribution.cdf.data());
  distribution.guide.resize(size_t{guide_cells(distribution.size())} + 1);
  write_guide(distribution.cdf.data(), distribution.size(), distribution.guide.data());
  return distribution;
}

DiscreteSample sample_discrete(const Distribution1D& distribution, float u) {
  return sample_cdf(distribution.cdf.data(), distribution.guide.data(), distribution.size(), u);
}

float discrete_probability(const Distribution1D& distribution, uint32_t index) {
  return distribution.cdf[index + 1] - distribution.cdf[index];
}

Distribution2D make_distribution_2d(std::span<const double> weights, uint32_t width, uint32_t height) {
  Distribution2D distribution;
  distribution.width = width;
  distribution.height = height;
  distribution.marginal.resize(size_t{height} + 1);
  distribution.conditional.resize(size_t{height} * (size_t{width} + 1));
  distribution.marginal_guide.resize(size_t{guide_cells(height)} + 1);
  const size_t guide_stride = size_t{guide_cells(width)} + 1;
  distribution.conditional_guide.resize(height * guide_stride);
  std::vector<double> rows(height);
  for (uint32_t y = 0; y < height; ++y) {
    const std::span<const double> row = weights.subspan(size_t{y} * width, width);
    float* cdf = distribution.conditional.data() + size_t{y} * (size_t{width} + 1);
    rows[y] = write_cdf(row, cdf);
    write_guide(cdf, width, distribution.conditional_guide.data() + y * guide_stride);
  }
  distribution.mean = write_cdf(rows, distribution.marginal.data()) / width / height;
  write_guide(distribution.marginal.data(), height, distribution.marginal_guide.data());
  return distribution;
}

SquareSample sample_square(const Distribution2D& distribution, float u, float v) {
  const uint32_t width = distribution.width, height = distribution.height;
  const DiscreteSample row = sample_cdf(distribution.marginal.data(), distribution.marginal_guide.data(), height, v);
  const float* cdf = distribution.conditional.data() + size_t{row.index} * (size_t{width} + 1);
  const int32_t* guide = distribution.conditional_guide.data() + size_t{row.index} * (size_t{guide_cells(width)} + 1);
  const DiscreteSample column = sample_cdf(cdf, guide, width, u);
  const float cells = static_cast<float>(width) * static_cast<float>(height);
  return {coordinate(column.index, column.remapped, width), coordinate(row.index, row.remapped, height),
          row.probability * column.probability * cells, row.index * width + column.index};
}

float square_pdf(const Distribution2D& distribution, float x, float y) {
  const uint32_t row = bin_of(y, distribution.height), column = bin_of(x, distribution.width);
  const float* cdf = distribution.conditional.data() + size_t{row} * (size_t{distribution.width} + 1);
  const float marginal = distribution.marginal[row + 1] - distribution.marginal[row];
  const float cells = static_cast<float>(distribution.width) * static_cast<float>(distribution.height);
  return marginal * (cdf[column + 1] - cdf[column]) * cells;
}

}  // namespace metamer
