#include "engine/spectrum/sources.h"

#include <cmath>
#include <string>

#include "engine/simd/portable_math.h"

namespace metamer {
namespace {

// Illuminant A at lambda, 100 at 560 nm (CIE 15:2018, 4.1.1).
double illuminant_a(double lambda_nm) {
  const double ratio = 560.0 / lambda_nm;
  const double c2_over_t = 1.435e7 / 2848.0;  // nm
  return 100.0 * ratio * ratio * ratio * ratio * ratio * (portable::exp(c2_over_t / 560.0) - 1.0) /
         (portable::exp(c2_over_t / lambda_nm) - 1.0);
}

double round_to_thousandth(double x) { return std::round(x * 1000.0) / 1000.0; }

template <class Function>
void continue_after(double last_nm, Samples& samples, Function&& function) {
  for (size_t i = 0; i < lambda_count; ++i) {
    const double lambda = lambda_min_nm + static_cast<double>(i);
    if (lambda > last_nm) samples[i] = function(i, lambda);
  }
}

}  // namespace

double planck_radiance(double temperature_kelvin, double lambda_nm) {
  constexpr double planck = 6.62607015e-34;   // J s
  constexpr double light = 299792458.0;       // m/s
  constexpr double boltzmann = 1.380649e-23;  // J/K
  const double lambda = lambda_nm * 1e-9;
  const double lambda5 = lambda * lambda * lambda * lambda * lambda;
  const double exponent = planck * light / (lambda * boltzmann * temperature_kelvin);
  // e^x - 1 loses digits where x is small (temperatures of millions of kelvin): there its series.
  const double denominator =
      exponent < 1e-5 ? exponent * (1.0 + exponent * (0.5 + exponent / 6.0)) : portable::exp(exponent) - 1.0;
  // 1e-9: per metre to per nanometre.
  return 2.0 * planck * light * light / lambda5 / denominator * 1e-9;
}

Samples blackbody(double temperature_kelvin) {
  Samples samples;
  for (size_t i = 0; i < lambda_count; ++i) {
    samples[i] = planck_radiance(temperature_kelvin, lambda_min_nm + static_cast<double>(i));
  }
  return samples;
}

std::array<double, 2> daylight_chromaticity(double t) {
  const double x = t <= 7000.0 ? ((-4.6070e9 / t + 2.9678e6) / t + 0.09911e3) / t + 0.244063
                               : ((-2.0064e9 / t + 1.9018e6) / t + 0.24748e3) / t + 0.237040;
  return {x, (-3.0 * x + 2.870) * x - 0.275};
}

Samples daylight(double cct_kelvin) {
  const auto [x, y] = daylight_chromaticity(cct_kelvin);
  const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
  const double m1 = round_to_thousandth((-1.3515 - 1.7703 * x + 5.9114 * y) / m);
  const double m2 = round_to_thousandth((0.0300 - 31.4424 * x + 30.0717 * y) / m);
  const DataTable& components = require_embedded_data("illuminant/D_series");
  Samples samples = resample(components, 1, Extend::zero);
  const Samples s1 = resample(components, 2, Extend::zero);
  const Samples s2 = resample(components, 3, Extend::zero);
  for (size_t i = 0; i < lambda_count; ++i) samples[i] += m1 * s1[i] + m2 * s2[i];
  return samples;
}

std::optional<Samples> cie_illuminant(std::string_view name) {
  if (name == "E") {
    Samples samples;
    samples.fill(100.0);
    return samples;
  }
  const DataTable* table = name == "D_series" ? nullptr : find_embedded_data("illuminant/" + std::string(name));
  if (table == nullptr) return std::nullopt;
  Samples samples = resample(*table, 1, Extend::zero);
  const double last_nm = table->at(table->rows() - 1, 0);
  if (name == "A") {
    continue_after(last_nm, samples, [](size_t, double lambda) { return illuminant_a(lambda); });
  } else if (name == "D50" || name == "D65") {
    const Samples components = daylight((name == "D50" ? 5000.0 : 6500.0) * daylight_shift);
    continue_after(last_nm, samples, [&](size_t i, double) { return components[i]; });
  }
  return samples;
}

double sellmeier_index(const DataTable& coefficients, double lambda_nm) {
  const double lambda2 = lambda_nm * lambda_nm * 1e-6;  // um^2
  double n2 = 1.0;
  for (size_t i = 0; i < coefficients.rows(); ++i) {
    n2 += coefficients.at(i, 0) * lambda2 / (lambda2 - coefficients.at(i, 1));
  }
  return std::sqrt(n2);
}

std::optional<Samples> dispersion_index(std::string_view medium) {
  const DataTable* table = find_embedded_data("dispersion/" + std::string(medium));
  if (table == nullptr) return std::nullopt;
  Samples samples;
  for (size_t i = 0; i < lambda_count; ++i) {
    samples[i] = sellmeier_index(*table, lambda_min_nm + static_cast<double>(i));
  }
  return samples;
}

std::optional<ComplexIndex> metal_index(std::string_view metal) {
  const DataTable* table = find_embedded_data("nk/" + std::string(metal));
  if (table == nullptr) return std::nullopt;
  return ComplexIndex{resample(*table, 1, Extend::constant), resample(*table, 2, Extend::constant)};
}

}  // namespace metamer
