// Pixel reconstruction filters, sampled in proportion to their magnitude, so that a pixel is the plain mean of its
// samples (importance-sampled filtering; Ernst et al., "Filter Importance Sampling", 2006). Samples of filters without
// negative lobes weigh 1, those of the others plus or minus the same number.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "engine/sampling/warps.h"
#include "engine/simd/column.h"

namespace metamer {

enum class FilterKind : uint8_t { box, triangle, gaussian, mitchell, sinc };

// Each is of one kind only.
struct FilterParameters {
  float sigma = 0.5f;  // gaussian: pixels, above 0
  float b = 1 / 3.0f,
        c = 1 / 3.0f;  // mitchell: of Mitchell and Netravali, "Reconstruction Filters in Computer Graphics", 1988
  float tau = 3;       // sinc: pixels to the first zero of the window, above 0
};
inline constexpr std::array<std::string_view, 5> filter_names = {"box", "triangle", "gaussian", "mitchell", "sinc"};
constexpr std::string_view filter_name(FilterKind kind) { return filter_names[static_cast<size_t>(kind)]; }

inline constexpr uint32_t filter_table_cells = 512;

// Separable; lengths in pixels. Beyond a radius the filter is 0.
struct PixelFilter {
  FilterKind kind = FilterKind::box;
  float radius_x = 0.5f, radius_y = 0.5f;
  FilterParameters parameters;
  double integral_x = 1, integral_y = 1;  // of the one-dimensional functions; not of box and triangle
  // |offset| / radius at |t| = i / filter_table_cells, linear in between. Gaussian: t is the offset a triangle filter
  // would take. It ends like the triangle, linearly, so this correction is smooth where its inverse cumulative
  // distribution is not. Filters with negative lobes: t is uniform, and there are as many cells of as much magnitude.
  Column<float> correction_x, correction_y;
  // Of filters with negative lobes: per cell of |t|, its integral divided by its probability and by the whole integral,
  // so that weights are 1 on average.
  Column<float> weights_x, weights_y;

  bool is_signed() const { return kind >= FilterKind::mitchell; }
};

// Radii above 0 and finite. pbrt-v4's functions, in x and likewise in y: the gaussian is
// exp(-x^2 / (2 sigma^2)) - exp(-radius^2 / (2 sigma^2)), mitchell the cubic spline stretched to the radius, sinc is
// sinc(x) sinc(x / tau), sinc(x) = sin(pi x) / (pi x).
PixelFilter make_pixel_filter(FilterKind kind, double radius_x, double radius_y,
                              const FilterParameters& parameters = {});

// The filter at an offset from the pixel's centre, divided by its integral, per pixel area: the density of
// sample_filter times the weight.
double filter_value(const PixelFilter& filter, double x, double y);

// An offset from the pixel's centre, in pixels. The SIMD twin is in filters-inl.h.
PointD2 sample_filter(const PixelFilter& filter, double u, double v);
// What the sample at that offset weighs; 1 unless the filter is signed.
double filter_weight(const PixelFilter& filter, double u, double v);

}  // namespace metamer
