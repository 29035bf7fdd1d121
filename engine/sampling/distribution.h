// Piecewise constant distributions over flat columns: one-dimensional (choosing one of many) and two-dimensional
// (marginal rows, conditional columns: environment maps). SIMD twins in distribution-inl.h.
//
// Probabilities are whole multiples of 2^-24, the grid of the points' random numbers: a bin is drawn exactly as often
// as its probability says, so dividing by it is unbiased. Every bin of positive weight has at least 2^-24, however
// small its share; a bin of weight 0 is never drawn.
//
// A guide table (Chen and Asau, "On Generating Random Variates from an Empirical Distribution", 1974) says between
// which bins a number in [k, k + 1) / cells leads, so that few steps are left to search: one or two on average,
// where bisecting the whole row of an environment map would miss the cache at each of its ten.
// Choosing by the cumulative sum keeps the stratification of u, which an alias table would destroy.
#pragma once
#include <bit>
#include <cstdint>
#include <span>

#include "engine/simd/column.h"

namespace metamer {

inline constexpr uint32_t max_distribution_bins = 1u << 22;
inline constexpr uint32_t max_distribution_side = 1u << 16;

// A power of two, so that the cell of a number is exact.
constexpr uint32_t guide_cells(uint32_t bins) { return std::bit_ceil(bins); }

namespace distribution_detail {
inline constexpr float largest_below_one = 0x1.fffffep-1f;
inline constexpr float just_below_one = 1 - 0x1p-22f, just_above_one = 1 + 0x1p-22f;
}  // namespace distribution_detail

struct Distribution1D {
  Column<float> cdf;      // size() + 1 values, from 0 to 1
  Column<int32_t> guide;  // guide_cells(size()) + 1 bins
  double sum = 0;         // of the weights; 0: all weights were 0 and the distribution is uniform
  uint32_t size() const { return cdf.empty() ? 0 : static_cast<uint32_t>(cdf.size()) - 1; }
};

// 1 to max_distribution_bins weights. Negative, infinite and NaN weights count as 0. Same bits on every machine.
Distribution1D make_distribution_1d(std::span<const double> weights);

struct DiscreteSample {
  uint32_t index = 0;
  float probability = 0;
  float remapped = 0;  // in [0, 1): what is left of u within the bin, uniform again; fewer bits where the bin is small
};
// u in [0, 1); what is outside, and NaN, counts as the nearest number within, NaN as the last.
DiscreteSample sample_discrete(const Distribution1D& distribution, float u);
float discrete_probability(const Distribution1D& distribution, uint32_t index);

// Over the unit square, in cells of 1 / width by 1 / height.
struct Distribution2D {
  uint32_t width = 0, height = 0;
  Column<float> marginal;             // height + 1 values: cdf of the rows
  Column<float> conditional;          // height * (width + 1) values: cdf of the cells of each row
  Column<int32_t> marginal_guide;     // guide_cells(height) + 1 rows
  Column<int32_t> conditional_guide;  // height * (guide_cells(width) + 1) columns
  double mean = 0;                    // of the weights; 0: all were 0 and the distribution is uniform
};

// width * height weights, row by row; both sides at most max_distribution_side and height * (2 * width + 1) below 2^31.
// Weights as in make_distribution_1d; those of an environment map include the cell's solid angle.
Distribution2D make_distribution_2d(std::span<const double> weights, uint32_t width, uint32_t height);

struct SquareSample {
  float x = 0, y = 0;  // in [0, 1)
  float pdf = 0;       // per unit square's area
  uint32_t cell = 0;   // row * width + column
};
// u chooses the column, v the row; both in [0, 1).
SquareSample sample_square(const Distribution2D& distribution, float u, float v);
// x and y in [0, 1); beyond counts as the border.
float square_pdf(const Distribution2D& distribution, float x, float y);

}  // namespace metamer
