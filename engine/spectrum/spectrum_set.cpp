#include "engine/spectrum/spectrum_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/spectrum/named_spectra.h"
#include "engine/spectrum/rgb_fit.h"
#include "engine/spectrum/sources.h"

namespace metamer {
namespace {

constexpr double largest_value = 1e38;  // within single precision, with room for a sum
constexpr float saturated = static_cast<float>(sigmoid_saturated);
constexpr float not_given = std::numeric_limits<float>::infinity();
constexpr std::array<float, 3> no_coefficients = {not_given, not_given, not_given};

SpectrumRow flat_row(double scale, uint32_t table = 0) {
  return {0.0f, 0.0f, saturated, static_cast<float>(scale), table, no_coefficients};
}

bool representable(double value) { return std::abs(value) <= largest_value; }  // false for NaN

SpectrumResult failure(std::string error) { return {zero_spectrum, std::move(error)}; }

SpectrumResult not_representable(double value) {
  return failure(fmt::format("{} is not a finite number of magnitude up to {:g}", value, largest_value));
}

// FNV-1a over 32-bit words.
uint64_t hash_words(const void* data, size_t words) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  uint64_t hash = 14695981039346656037u;
  for (size_t i = 0; i < words; ++i) {
    uint32_t word;
    std::memcpy(&word, bytes + 4 * i, 4);
    hash = (hash ^ word) * 1099511628211u;
  }
  return hash;
}

std::string table_mistake(std::span<const double> lambda_nm, std::span<const double> values) {
  if (lambda_nm.size() != values.size()) {
    return fmt::format("{} wavelengths but {} values", lambda_nm.size(), values.size());
  }
  if (values.size() < 2) return "a table needs at least two wavelengths";
  for (size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(lambda_nm[i])) return fmt::format("wavelength {} is not a finite number", i + 1);
    if (!representable(values[i]))
      return fmt::format("value {} is not a finite number up to {:g}", i + 1, largest_value);
    if (i > 0 && lambda_nm[i] <= lambda_nm[i - 1]) {
      return fmt::format("wavelengths must ascend, but {} nm follows {} nm", lambda_nm[i], lambda_nm[i - 1]);
    }
  }
  return {};
}

}  // namespace

SpectrumSet::SpectrumSet() {
  tables_.resize(lambda_stride);
  std::fill(tables_.begin(), tables_.end(), 1.0f);
  append(flat_row(0.0));
  append(flat_row(1.0));
}

SpectrumId SpectrumSet::append(const SpectrumRow& row) {
  SpectrumRow canonical = row;
  if (canonical.scale == 0.0f) {
    canonical = flat_row(0.0);
    canonical.coefficients = row.coefficients;
  }
  const uint64_t hash = hash_words(&canonical, spectrum_row_floats);
  const auto [first, last] = row_of_hash_.equal_range(hash);
  for (auto it = first; it != last; ++it) {
    if (rows_[it->second] == canonical) return it->second;
  }
  const auto id = static_cast<SpectrumId>(rows_.size());
  rows_.push_back(canonical);
  row_of_hash_.emplace(hash, id);
  return id;
}

SpectrumSet::StoredTable SpectrumSet::store_table(const Samples& samples) {
  double largest = 0.0;
  for (const double value : samples) largest = std::max(largest, std::abs(value));
  int exponent = 0;
  std::frexp(largest, &exponent);
  const double scale = std::ldexp(1.0, exponent);
  std::array<float, lambda_stride> table;
  for (size_t i = 0; i < lambda_stride; ++i) {
    table[i] = static_cast<float>(samples[std::min(i, lambda_count - 1)] / scale);
  }
  const uint64_t hash = hash_words(table.data(), lambda_stride);
  const auto [first, last] = table_of_hash_.equal_range(hash);
  for (auto it = first; it != last; ++it) {
    if (std::equal(table.begin(), table.end(), tables_.begin() + it->second * lambda_stride))
      return {it->second, scale};
  }
  const auto index = static_cast<uint32_t>(table_count());
  tables_.resize(tables_.size() + lambda_stride);
  std::copy(table.begin(), table.end(), tables_.begin() + index * lambda_stride);
  table_of_hash_.emplace(hash, index);
  return {index, scale};
}

SpectrumResult SpectrumSet::add_constant(double value) {
  if (!representable(value)) return not_representable(value);
  return {append(flat_row(value)), {}};
}

SpectrumResult SpectrumSet::add_samples(const Samples& samples) {
  for (const double value : samples) {
    if (!representable(value)) return not_representable(value);
  }
  const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
  // Below the smallest normal number single precision loses digits: nothing.
  if (std::max(std::abs(*low), std::abs(*high)) < std::numeric_limits<float>::min()) return {};
  if (*low == *high) return add_constant(*low);
  const StoredTable stored = store_table(samples);
  return {append(flat_row(stored.scale, stored.index)), {}};
}

SpectrumResult SpectrumSet::add_table(std::span<const double> lambda_nm, std::span<const double> values,
                                      Extend extend) {
  std::string mistake = table_mistake(lambda_nm, values);
  if (!mistake.empty()) return failure(std::move(mistake));
  return add_samples(resample(lambda_nm, values, extend));
}

SpectrumResult SpectrumSet::add_sigmoid(const std::array<double, 3>& coefficients, SpectrumId times) {
  SpectrumRow row = rows_[times];
  const SpectrumRow flat = rows_[unit_spectrum];
  if (row.c0 != flat.c0 || row.c1 != flat.c1 || row.c2 != flat.c2)
    return failure("a smooth spectrum cannot be multiplied by another one");
  for (const double c : coefficients)
    if (!representable(c)) return not_representable(c);
  row.c0 = static_cast<float>(coefficients[0]);
  row.c1 = static_cast<float>(coefficients[1]);
  row.c2 = static_cast<float>(coefficients[2]);
  row.coefficients = no_coefficients;
  return {append(row), {}};
}

SpectrumResult SpectrumSet::add_rgb(const Color3& rgb, RgbKind kind, ColorSpace space) {
  const double limit = kind == RgbKind::albedo ? 1.0 : largest_value / 4.0;
  for (const double channel : rgb) {
    if (!(channel >= 0.0 && channel <= limit)) {
      return failure(fmt::format("rgb ({}, {}, {}): each must lie between 0 and {:g}", rgb[0], rgb[1], rgb[2], limit));
    }
  }
  SpectrumRow row = flat_row(rgb[0]);
  if (rgb[0] != rgb[1] || rgb[1] != rgb[2]) {
    const double scale = kind == RgbKind::albedo ? 1.0 : 2.0 * std::max({rgb[0], rgb[1], rgb[2]});
    const SigmoidCoefficients c = fit_sigmoid(space, {rgb[0] / scale, rgb[1] / scale, rgb[2] / scale}).c;
    row = {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]), static_cast<float>(scale), 0,
           no_coefficients};
  }
  if (kind != RgbKind::illuminant) return {append(row), {}};
  const StoredTable white = store_table(white_illuminant(space));
  row.table = white.index;
  row.scale = static_cast<float>(row.scale * white.scale);
  if (!representable(row.scale)) return not_representable(row.scale);
  return {append(row), {}};
}

SpectrumResult SpectrumSet::add_blackbody(double kelvin) {
  if (!(kelvin > 0.0 && kelvin <= 1e9))
    return failure(fmt::format("temperature {} K: must be above 0 and up to 1e9", kelvin));
  return add_samples(blackbody(kelvin));
}

SpectrumResult SpectrumSet::add_blackbody_normalized(double kelvin) {
  if (!(kelvin > 0.0 && kelvin <= 1e9))
    return failure(fmt::format("temperature {} K: must be above 0 and up to 1e9", kelvin));
  constexpr double wien_nm_kelvin = 2.897771955e6;  // CODATA 2018
  const double peak = planck_radiance(kelvin, wien_nm_kelvin / kelvin);
  Samples samples = blackbody(kelvin);
  for (double& value : samples) value /= peak;
  return add_samples(samples);
}

SpectrumResult SpectrumSet::add_daylight(double cct_kelvin) {
  if (!(cct_kelvin >= daylight_min_kelvin && cct_kelvin <= daylight_max_kelvin)) {
    return failure(fmt::format("daylight of {} K: CIE defines it from {} to {} K", cct_kelvin, daylight_min_kelvin,
                               daylight_max_kelvin));
  }
  return add_samples(daylight(cct_kelvin));
}

std::optional<SpectrumId> SpectrumSet::add_named(std::string_view name) {
  const std::optional<Samples> samples = named_spectrum(name);
  if (!samples) return std::nullopt;
  return add_samples(*samples).id;
}

SpectrumId SpectrumSet::add_white(ColorSpace space) { return add_samples(white_illuminant(space)).id; }

SpectrumResult SpectrumSet::scaled(SpectrumId id, double factor) {
  SpectrumRow row = rows_[id];
  const double scale = row.scale * factor;
  if (!representable(scale)) return not_representable(scale);
  row.scale = static_cast<float>(scale);
  row.coefficients = no_coefficients;
  return {append(row), {}};
}

SpectrumId SpectrumSet::with_coefficients(SpectrumId id, const Color3& coefficients) {
  SpectrumRow row = rows_[id];
  for (size_t c = 0; c < 3; ++c) row.coefficients[c] = static_cast<float>(coefficients[c]);
  has_coefficients_ = true;
  return append(row);
}

SpectrumResult SpectrumSet::product(SpectrumId a, SpectrumId b) {
  if (is_constant(a)) return scaled(b, value(a, lambda_min_nm));
  if (is_constant(b)) return scaled(a, value(b, lambda_min_nm));
  Samples samples_a = samples(a);
  const Samples samples_b = samples(b);
  for (size_t i = 0; i < lambda_count; ++i) samples_a[i] *= samples_b[i];
  return add_samples(samples_a);
}

SpectrumView SpectrumSet::view() const {
  return {reinterpret_cast<const float*>(rows_.data()), tables_.data(), lambda_stride, has_coefficients_};
}

double SpectrumSet::value(SpectrumId id, double lambda_nm) const {
  const SpectrumRow& row = rows_[id];
  const double lambda = std::clamp(lambda_nm, static_cast<double>(lambda_min_nm), static_cast<double>(lambda_max_nm));
  const double smooth = row.scale * sigmoid_polynomial({row.c0, row.c1, row.c2}, lambda);
  if (row.table == 0) return smooth;
  const float* table = tables_.data() + row.table * lambda_stride;
  const double position = lambda - lambda_min_nm;
  const auto lower = std::min(static_cast<size_t>(position), lambda_count - 2);
  const double fraction = position - static_cast<double>(lower);
  return smooth * (table[lower] * (1.0 - fraction) + table[lower + 1] * fraction);
}

Samples SpectrumSet::samples(SpectrumId id) const {
  Samples samples;
  for (size_t i = 0; i < lambda_count; ++i) samples[i] = value(id, lambda_min_nm + static_cast<double>(i));
  return samples;
}

bool SpectrumSet::is_constant(SpectrumId id) const {
  const SpectrumRow& row = rows_[id];
  return row.table == 0 && row.c0 == 0.0f && row.c1 == 0.0f;
}

double SpectrumSet::min_value(SpectrumId id) const {
  const Samples all = samples(id);
  return *std::min_element(all.begin(), all.end());
}

double SpectrumSet::max_value(SpectrumId id) const {
  const Samples all = samples(id);
  return *std::max_element(all.begin(), all.end());
}

Color3 SpectrumSet::xyz(SpectrumId id, Observer observer) const {
  Color3 result = integrate_xyz(samples(id), observer);
  for (double& component : result) component *= luminous_efficacy;
  return result;
}

}  // namespace metamer
