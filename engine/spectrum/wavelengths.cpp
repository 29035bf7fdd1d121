#include "engine/spectrum/wavelengths.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/spectrum/color.h"

namespace metamer {
namespace {

// Mean with a triangle of half-width `half_width_nm`, cut off at the ends of the range.
Samples smooth(const Samples& samples, int half_width_nm) {
  const int count = static_cast<int>(lambda_count);
  Samples result;
  for (int i = 0; i < count; ++i) {
    double sum = 0.0;
    double weights = 0.0;
    for (int j = std::max(0, i - half_width_nm); j <= std::min(count - 1, i + half_width_nm); ++j) {
      const double weight = half_width_nm - std::abs(i - j);
      sum += weight * samples[static_cast<size_t>(j)];
      weights += weight;
    }
    result[static_cast<size_t>(i)] = sum / weights;
  }
  return result;
}

// Wanted density at the 1 nm nodes; between them it is linear.
Samples importance() {
  constexpr double uniform_part = 0.03;
  const auto& matching = observer_table(Observer::cie1931).matching;
  Samples norm;
  for (size_t i = 0; i < lambda_count; ++i) {
    const Color3 rgb = multiply(xyz_to_rgb(ColorSpace::srgb), Color3{matching[0][i], matching[1][i], matching[2][i]});
    norm[i] = std::sqrt(rgb[0] * rgb[0] + rgb[1] * rgb[1] + rgb[2] * rgb[2]);
  }
  norm = smooth(norm, 30);
  double integral = 0.0;
  for (size_t i = 1; i < lambda_count; ++i) integral += 0.5 * (norm[i - 1] + norm[i]);
  for (double& value : norm) {
    value = (1.0 - uniform_part) * value / integral + uniform_part / (lambda_max_nm - lambda_min_nm);
  }
  return norm;
}

WavelengthTable make_table() {
  const Samples density = importance();
  Samples cumulative{};
  for (size_t i = 1; i < lambda_count; ++i) {
    cumulative[i] = cumulative[i - 1] + 0.5 * (density[i - 1] + density[i]);
  }
  std::array<double, wavelength_segments + 1> knots_nm;
  size_t cell = 0;
  for (size_t k = 0; k <= wavelength_segments; ++k) {
    const double wanted = cumulative.back() * static_cast<double>(k) / wavelength_segments;
    while (cell + 2 < lambda_count && cumulative[cell + 1] <= wanted) ++cell;
    // Within the cell the distribution is a d + s d^2 / 2; the root of the quadratic in its stable form.
    const double a = density[cell];
    const double s = density[cell + 1] - a;
    const double rest = wanted - cumulative[cell];
    const double d = 2.0 * rest / (a + std::sqrt(std::max(0.0, a * a + 2.0 * s * rest)));
    knots_nm[k] = lambda_min_nm + static_cast<double>(cell) + std::clamp(d, 0.0, 1.0);
  }
  knots_nm.back() = lambda_max_nm;
  WavelengthTable table;
  for (size_t k = 0; k < wavelength_segments; ++k) {
    table.lower_nm[k] = static_cast<float>(knots_nm[k]);
    table.width_nm[k] = static_cast<float>(knots_nm[k + 1]) - table.lower_nm[k];
  }
  return table;
}

}  // namespace

const WavelengthTable& wavelength_table() {
  static const WavelengthTable table = make_table();
  return table;
}

double wavelength_pdf(double lambda_nm) {
  if (!(lambda_nm >= lambda_min_nm && lambda_nm <= lambda_max_nm)) return 0.0;
  const WavelengthTable& table = wavelength_table();
  const auto above = std::upper_bound(table.lower_nm.begin(), table.lower_nm.end(), lambda_nm);
  const auto segment = static_cast<size_t>(above - table.lower_nm.begin()) - 1;
  return 1.0 / (static_cast<double>(wavelength_segments) * table.width_nm[segment]);
}

WavelengthSample sample_wavelengths(double u, double u_rotation) {
  constexpr size_t segments_per_stratum = wavelength_segments / wavelengths_per_path;
  const WavelengthTable& table = wavelength_table();
  const double position = u * static_cast<double>(segments_per_stratum);
  const size_t within = std::min(static_cast<size_t>(position), segments_per_stratum - 1);
  const double fraction = position - static_cast<double>(within);
  const auto rotation = static_cast<size_t>(u_rotation * static_cast<double>(wavelengths_per_path));
  WavelengthSample sample;
  for (size_t j = 0; j < wavelengths_per_path; ++j) {
    const size_t segment = (j + rotation) % wavelengths_per_path * segments_per_stratum + within;
    sample.lambda_nm[j] = table.lower_nm[segment] + fraction * table.width_nm[segment];
    sample.inv_pdf_nm[j] = static_cast<double>(wavelength_segments) * table.width_nm[segment];
  }
  return sample;
}

}  // namespace metamer
