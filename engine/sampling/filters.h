// Pixel reconstruction filters, sampled in exact proportion, so that every camera sample weighs 1 and a pixel is
// the plain mean of its samples (importance-sampled filtering; Ernst et al., "Filter Importance Sampling", 2006).
#pragma once
#include <cstdint>

#include "engine/sampling/warps.h"
#include "engine/simd/column.h"

namespace metamer {

enum class FilterKind : uint8_t { box, triangle, gaussian };

inline constexpr uint32_t filter_table_cells = 512;

// Separable; lengths in pixels. Beyond a radius the filter is 0.
struct PixelFilter {
  FilterKind kind = FilterKind::box;
  float radius_x = 0.5f, radius_y = 0.5f;
  double sigma = 0;                       // of the gaussian
  double integral_x = 1, integral_y = 1;  // of the one-dimensional gaussians
  // Gaussian only: |offset| / radius at |t| = i / filter_table_cells, where t is the offset a triangle filter would
  // take. The gaussian ends like the triangle, linearly, so this correction is smooth where its inverse cumulative
  // distribution is not.
  Column<float> correction_x, correction_y;
};

// Radii above 0 and finite, sigma above 0 (used by the gaussian only). The gaussian is
// exp(-x^2 / (2 sigma^2)) - exp(-radius^2 / (2 sigma^2)) in x, and likewise in y: pbrt's.
PixelFilter make_pixel_filter(FilterKind kind, double radius_x, double radius_y, double sigma = 0.5);

// The filter at an offset from the pixel's centre, divided by its integral: the density of sample_filter, per
// pixel area.
double filter_pdf(const PixelFilter& filter, double x, double y);

// An offset from the pixel's centre, in pixels. The SIMD twin is in filters-inl.h.
PointD2 sample_filter(const PixelFilter& filter, double u, double v);

}  // namespace metamer
