// A piecewise constant density over the unit square, of which only a window is wanted, another one each time: what of
// an environment is seen through a portal. Sums over rectangles come from a summed-area table (Crow, "Summed-Area
// Tables for Texture Mapping", 1984). Cells are whole numbers, whose differences of sums are exact however small the
// window; the parts of cells at its edges are added, never subtracted. SIMD twins in window_distribution-inl.h.
#pragma once
#include <cstdint>
#include <span>

#include "engine/simd/column.h"

namespace metamer {

inline constexpr uint32_t max_window_side = 512;

struct WindowDistribution {
  uint32_t width = 0, height = 0;
  Column<int32_t> sums;  // (width + 1) (height + 1): of the cells left of and above each corner; the last below 2^31
};

// width * height weights, row by row, sides from 1 to max_window_side. Every cell has at least a part in 4096 of the
// mean, also those of no usable (negative, infinite or NaN) weight. Same bits on every machine.
WindowDistribution make_window_distribution(std::span<const double> weights, uint32_t width, uint32_t height);

// Corners in the unit square; empty where x1 <= x0 or y1 <= y0.
struct DensityWindow {
  float x0 = 0, y0 = 0, x1 = 1, y1 = 1;
};
struct WindowSample {
  float x = 0, y = 0;
  float pdf = 0;  // per unit square's area; 0: the window is empty
};
// u, v in [0, 1); u chooses the column.
WindowSample sample_window(const WindowDistribution& distribution, const DensityWindow& window, float u, float v);
// Of a point in the window; 0 outside.
float window_pdf(const WindowDistribution& distribution, const DensityWindow& window, float x, float y);

}  // namespace metamer
