// A spectrum as 1 nm point samples from 360 to 830 nm, the resolution of every table here, in double precision.
#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "engine/spectrum/embedded_data.h"

namespace metamer {

inline constexpr int lambda_min_nm = 360;
inline constexpr int lambda_max_nm = 830;
inline constexpr size_t lambda_count = lambda_max_nm - lambda_min_nm + 1;  // 471
// Float tables that kernels read are this long: a whole number of the widest vectors, at least one entry to spare.
inline constexpr size_t lambda_stride = 480;

using Samples = std::array<double, lambda_count>;

// What a table is worth outside its range.
enum class Extend { zero, constant };

// Linear interpolation; lambda_nm is clamped to 360..830.
double interpolate(const Samples& samples, double lambda_nm);

// The piecewise-linear curve through (lambda_nm[i], values[i]) as 1 nm samples. Needs two or more points, strictly
// ascending. Where the input is coarser than 1 nm a sample is the curve's value; around intervals finer than 1 nm it is
// the curve's mean weighted by the hat of half-width 1 nm, so that a narrow line keeps its integral.
Samples resample(std::span<const double> lambda_nm, std::span<const double> values, Extend extend);

// The same of one column of an embedded table whose first column is the wavelength in nm.
Samples resample(const DataTable& table, size_t column, Extend extend);

// Sum over 1 nm steps of a b d(lambda), the summation of CIE 15:2018, section 7.
double integrate(const Samples& a, const Samples& b);

}  // namespace metamer
