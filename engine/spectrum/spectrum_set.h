// All spectra of a scene, in the form kernels read: a row of eight floats each, and the tables some rows refer to.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

#include "engine/simd/column.h"
#include "engine/spectrum/color.h"
#include "engine/spectrum/samples.h"

namespace metamer {

using SpectrumId = uint32_t;
inline constexpr SpectrumId zero_spectrum = 0;
inline constexpr SpectrumId unit_spectrum = 1;

// value(lambda) = scale * S(c0 t^2 + c1 t + c2) * table(lambda), see rgb_fit.h for t and S. Table 0 is all ones and is
// not fetched by kernels. Tables are linear between 1 nm samples; lambda is clamped to 360..830 nm.
// Of RGB mode (color_mode.h) the row holds three coefficients, which follow from the spectrum and its role: a spectrum
// of two roles has two rows. Until they are given they are infinite, so that samples made with them are refused.
struct alignas(32) SpectrumRow {
  float c0, c1, c2;
  float scale;
  uint32_t table;
  std::array<float, 3> coefficients;
  bool operator==(const SpectrumRow&) const = default;
};
inline constexpr size_t spectrum_row_floats = sizeof(SpectrumRow) / sizeof(float);
inline constexpr size_t spectrum_row_coefficients = offsetof(SpectrumRow, coefficients) / sizeof(float);

// What kernels get; valid while the set does not change.
struct SpectrumView {
  const float* rows;    // spectrum_row_floats per spectrum
  const float* tables;  // table_stride floats per table, the first for 360 nm
  size_t table_stride;
  bool has_coefficients;  // RGB mode: the rows' coefficients stand for them
};

// How three numbers become a spectrum. albedo: a reflectance, each channel in 0..1. unbounded: channels >= 0, scale =
// 2 max(r, g, b) times the reflectance of rgb / scale. illuminant: unbounded times the colour space's white illuminant.
enum class RgbKind : uint8_t { albedo, unbounded, illuminant };

// Either an id, or what was wrong with the input (then id is that of the zero spectrum).
struct SpectrumResult {
  SpectrumId id = zero_spectrum;
  std::string error;
  bool ok() const { return error.empty(); }
};

// Append-only; equal spectra get equal ids. Inputs are unitless or in the unit of the quantity they describe; lights
// in W m^-2 sr^-1 nm^-1 or relative. Copyable and movable.
class SpectrumSet {
 public:
  SpectrumSet();

  SpectrumResult add_constant(double value);
  // Two or more points, strictly ascending in wavelength, finite; see `resample` for what happens between them.
  SpectrumResult add_table(std::span<const double> lambda_nm, std::span<const double> values, Extend extend);
  SpectrumResult add_samples(const Samples& samples);
  // S(c0 t^2 + c1 t + c2), see rgb_fit.h, times another spectrum that is no such curve itself.
  SpectrumResult add_sigmoid(const std::array<double, 3>& coefficients, SpectrumId times);
  SpectrumResult add_rgb(const Color3& rgb, RgbKind kind, ColorSpace space = ColorSpace::srgb);
  // Planck's radiance, W m^-2 sr^-1 nm^-1; temperature > 0.
  SpectrumResult add_blackbody(double kelvin);
  // Planck's law divided by its peak over all wavelengths, as pbrt-v4 defines "blackbody".
  SpectrumResult add_blackbody_normalized(double kelvin);
  // CIE daylight, 100 at 560 nm; 4000 to 25000 K.
  SpectrumResult add_daylight(double cct_kelvin);
  // See named_spectra.h; nothing for an unknown name.
  std::optional<SpectrumId> add_named(std::string_view name);
  // The white illuminant of a colour space in CIE's relative power.
  SpectrumId add_white(ColorSpace space);

  // New spectra made of old ones. `scaled` shares the table.
  SpectrumResult scaled(SpectrumId id, double factor);
  SpectrumResult product(SpectrumId a, SpectrumId b);

  // The spectrum with coefficients of RGB mode, which are kept in single precision; from the first on the view has
  // them.
  SpectrumId with_coefficients(SpectrumId id, const Color3& coefficients);

  size_t size() const { return rows_.size(); }
  size_t table_count() const { return tables_.size() / lambda_stride; }
  size_t bytes() const { return rows_.bytes() + tables_.bytes(); }
  const SpectrumRow& row(SpectrumId id) const { return rows_[id]; }
  SpectrumView view() const;

  // The double-precision twin of eval_spectrum4 without coefficients.
  double value(SpectrumId id, double lambda_nm) const;
  Samples samples(SpectrumId id) const;
  bool is_constant(SpectrumId id) const;
  double min_value(SpectrumId id) const;  // over the 1 nm samples
  double max_value(SpectrumId id) const;
  bool has_negative(SpectrumId id) const { return min_value(id) < 0.0; }
  // X Y Z = 683 times the sums over 1 nm of value xbar and so on; luminance is Y, cd/m^2 if the values are radiances.
  Color3 xyz(SpectrumId id, Observer observer = Observer::cie1931) const;
  double luminance(SpectrumId id) const { return xyz(id)[1]; }

 private:
  SpectrumId append(const SpectrumRow& row);
  // Finds or adds samples divided by `scale`, a power of two that brings the largest to 1/2..1.
  struct StoredTable {
    uint32_t index;
    double scale;
  };
  StoredTable store_table(const Samples& samples);

  bool has_coefficients_ = false;
  Column<SpectrumRow> rows_;
  Column<float> tables_;
  std::unordered_multimap<uint64_t, SpectrumId> row_of_hash_;
  std::unordered_multimap<uint64_t, uint32_t> table_of_hash_;
};

}  // namespace metamer
