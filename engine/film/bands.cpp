#include "engine/film/bands.h"

#include "engine/film/film.h"

namespace metamer {
namespace {

// Fills what lies between two bands with values, or beyond the only one; `left` or `right` may be outside.
void fill_between(int left, int right, int band_count, std::span<double> means) {
  for (int b = left + 1; b < right; ++b) {
    double& mean = means[static_cast<size_t>(b)];
    if (left < 0)
      mean = means[static_cast<size_t>(right)];
    else if (right >= band_count)
      mean = means[static_cast<size_t>(left)];
    else
      mean = means[static_cast<size_t>(left)] +
             (b - left) * (means[static_cast<size_t>(right)] - means[static_cast<size_t>(left)]) / (right - left);
  }
}

// The bands of one pixel, filled.
void pixel_means(std::span<const BandSum> sums, std::span<double> means) {
  const int band_count = static_cast<int>(sums.size());
  int last = -1;
  for (int b = 0; b < band_count; ++b) {
    const BandSum& sum = sums[static_cast<size_t>(b)];
    means[static_cast<size_t>(b)] = band_mean(sum);
    if (sum.weight_units() == 0) continue;
    fill_between(last, b, band_count, means);
    last = b;
  }
  if (last >= 0) fill_between(last, band_count, band_count, means);
}

}  // namespace

std::vector<double> band_edges_nm(uint32_t band_count) {
  std::vector<double> edges_nm(band_count + 1);
  for (uint32_t i = 0; i <= band_count; ++i)
    edges_nm[i] = double{band_min_nm} + (double{band_max_nm} - double{band_min_nm}) * i / band_count;
  return edges_nm;
}

double band_mean(const BandSum& sum) {
  const uint64_t weight = sum.weight_units();
  if (weight == 0) return 0;
  // One rounding each; the units' ratio is a power of two.
  return static_cast<double>(sum.radiance_units()) / static_cast<double>(weight) * 0x1p-20;
}

void band_means(const Film& film, size_t first, size_t count, std::span<float* const> columns) {
  const uint32_t band_count = film.band_count();
  std::array<double, max_band_count> means;
  for (size_t i = 0; i < count; ++i) {
    pixel_means(film.bands().subspan((first + i) * band_count, band_count), {means.data(), band_count});
    for (uint32_t b = 0; b < band_count; ++b) columns[b][i] = static_cast<float>(means[b]);
  }
}

}  // namespace metamer
