// Hero wavelengths: distributed as claimed, stratified, unbiased, and the same on every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/engine/spectrum/wavelengths_test.cpp"
#include "engine/spectrum/wavelengths.h"

#include <gtest/gtest.h>
#include <hwy/foreach_target.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "engine/spectrum/color.h"
#include "engine/spectrum/sources.h"
#include "engine/spectrum/wavelengths-inl.h"
#include "tests/support/each_target.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// lambda_nm and inv_pdf_nm hold four columns of n rows.
void sample_columns(const float* u, const float* rotation, float* lambda_nm, float* inv_pdf_nm, size_t n) {
  const FloatTag d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    VF lambda[4];
    VF inv_pdf[4];
    sample_wavelengths(wavelength_table(), hn::LoadU(d, u + i), hn::LoadU(d, rotation + i), lambda, inv_pdf);
    for (size_t j = 0; j < 4; ++j) {
      hn::StoreU(lambda[j], d, lambda_nm + j * n + i);
      hn::StoreU(inv_pdf[j], d, inv_pdf_nm + j * n + i);
    }
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(sample_columns);

namespace {

TEST(Wavelengths, DensityIntegratesToOneOverTheRange) {
  double integral = 0.0;
  constexpr int steps = 470000;
  for (int i = 0; i < steps; ++i) integral += wavelength_pdf(360.0 + 470.0 * (i + 0.5) / steps) * 470.0 / steps;
  EXPECT_NEAR(integral, 1.0, 1e-5);
  EXPECT_EQ(wavelength_pdf(359.9), 0.0);
  EXPECT_EQ(wavelength_pdf(830.1), 0.0);
  EXPECT_GE(wavelength_pdf(361.0), 0.02 / 470.0);  // the uniform part
  EXPECT_GE(wavelength_pdf(829.0), 0.02 / 470.0);
}

TEST(Wavelengths, SegmentsCoverTheRangeWithoutGaps) {
  const WavelengthTable& table = wavelength_table();
  EXPECT_EQ(table.lower_nm[0], 360.0f);
  for (size_t i = 0; i + 1 < wavelength_segments; ++i) {
    EXPECT_GT(table.width_nm[i], 0.0f);
    EXPECT_EQ(table.lower_nm[i] + table.width_nm[i], table.lower_nm[i + 1]) << i;
  }
  EXPECT_EQ(table.lower_nm.back() + table.width_nm.back(), 830.0f);
}

// Chi-square over 64 bins with the density integrated by midpoint, 63 degrees of freedom: above 117 with probability
// 4e-5. The seed is fixed.
double chi_square(const std::vector<double>& lambdas, double low, double high, double mass) {
  constexpr size_t bins = 64;
  std::vector<double> counts(bins, 0.0);
  for (const double lambda : lambdas) {
    EXPECT_GE(lambda, low - 1e-3);
    EXPECT_LE(lambda, high + 1e-3);
    const auto bin = static_cast<size_t>((lambda - low) / (high - low) * bins);
    counts[std::min(bin, bins - 1)] += 1.0;
  }
  double statistic = 0.0;
  for (size_t bin = 0; bin < bins; ++bin) {
    double probability = 0.0;
    constexpr size_t steps = 2000;
    const double width = (high - low) / bins / steps;
    for (size_t k = 0; k < steps; ++k) {
      probability += wavelength_pdf(low + (static_cast<double>(bin * steps + k) + 0.5) * width) * width / mass;
    }
    const double expected = probability * static_cast<double>(lambdas.size());
    statistic += (counts[bin] - expected) * (counts[bin] - expected) / expected;
  }
  return statistic;
}

TEST(Wavelengths, HeroAndEachStratumFollowTheDensity) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> hero;
  std::array<std::vector<double>, 4> stratum;
  for (int i = 0; i < 200000; ++i) {
    const double rotation = uniform(random);
    const WavelengthSample sample = sample_wavelengths(uniform(random), rotation);
    hero.push_back(sample.lambda_nm[0]);
    for (size_t j = 0; j < 4; ++j) {
      stratum[(j + static_cast<size_t>(4.0 * rotation)) % 4].push_back(sample.lambda_nm[j]);
    }
  }
  EXPECT_LT(chi_square(hero, 360.0, 830.0, 1.0), 117.0);
  const WavelengthTable& table = wavelength_table();
  for (size_t s = 0; s < 4; ++s) {
    const double low = table.lower_nm[256 * s];
    const double high = s == 3 ? 830.0 : table.lower_nm[256 * (s + 1)];
    EXPECT_LT(chi_square(stratum[s], low, high, 0.25), 117.0) << s;
  }
}

// Quadrature over u at a fixed rotation: unbiased even without random rotation. The integrand is linear between
// table nodes; 2^20 points leave 2e-5.
TEST(Wavelengths, MeanOverTheFourIntegratesTheObservers) {
  const ObserverTable& table = observer_table(Observer::cie1931);
  constexpr size_t n = 1 << 18;
  Color3 sum{};
  Color3 hero_sum{};
  for (size_t i = 0; i < n; ++i) {
    const double u = (static_cast<double>(i) + 0.5) / n;
    const WavelengthSample sample = sample_wavelengths(u, 0.3);
    for (size_t j = 0; j < 4; ++j) {
      const auto matching = observer_value(Observer::cie1931, sample.lambda_nm[j]);
      for (size_t c = 0; c < 3; ++c) sum[c] += matching[c] * sample.inv_pdf_nm[j] / 4.0 / n;
    }
    for (size_t r = 0; r < 4; ++r) {
      const WavelengthSample turned = sample_wavelengths(u, static_cast<double>(r) / 4.0);
      const auto matching = observer_value(Observer::cie1931, turned.lambda_nm[0]);
      for (size_t c = 0; c < 3; ++c) hero_sum[c] += matching[c] * turned.inv_pdf_nm[0] / 4.0 / n;
    }
  }
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(sum[c] / table.integrals[c], 1.0, 2e-5);
    EXPECT_NEAR(hero_sum[c] / table.integrals[c], 1.0, 2e-5);
  }
}

// The variances the choice of density rests on, stated in wavelengths.h.
TEST(Wavelengths, VarianceOfDevelopedWhiteIsAsStated) {
  const Samples& white = white_illuminant(ColorSpace::srgb);
  const double y = integrate_xyz(white)[1];
  const auto developed = [&](double lambda) {
    Color3 xyz = observer_value(Observer::cie1931, lambda);
    for (double& component : xyz) component *= interpolate(white, lambda) / y;
    return multiply(xyz_to_rgb(ColorSpace::srgb), xyz);
  };
  constexpr size_t n = 1 << 16;
  double hero_variance = -3.0;
  double four_variance = -3.0;
  for (size_t i = 0; i < n; ++i) {
    for (size_t r = 0; r < 4; ++r) {
      const WavelengthSample sample =
          sample_wavelengths((static_cast<double>(i) + 0.5) / n, static_cast<double>(r) / 4.0);
      Color3 mean{};
      for (size_t j = 0; j < 4; ++j) {
        const Color3 rgb = developed(sample.lambda_nm[j]);
        for (size_t c = 0; c < 3; ++c) {
          const double estimate = rgb[c] * sample.inv_pdf_nm[j];
          mean[c] += estimate / 4.0;
          if (j == 0) hero_variance += estimate * estimate / (4.0 * n);
        }
      }
      for (const double channel : mean) four_variance += channel * channel / (4.0 * n);
    }
  }
  EXPECT_NEAR(hero_variance, 10.2, 0.1);
  EXPECT_NEAR(four_variance, 0.035, 0.001);
}

TEST(WavelengthKernel, AgreesWithItsTwinOnEveryInstructionSet) {
  constexpr size_t n = 4096;
  std::vector<float> u(n);
  std::vector<float> rotation(n);
  std::mt19937 random(3);
  for (size_t i = 0; i < n; ++i) {
    u[i] = static_cast<float>(random() >> 8) * 0x1p-24f;
    rotation[i] = static_cast<float>(random() >> 8) * 0x1p-24f;
  }
  u[0] = rotation[0] = 0.0f;
  u[1] = rotation[1] = 1.0f - 0x1p-24f;
  std::vector<float> lambda(4 * n);
  std::vector<float> inv_pdf(4 * n);
  for_each_target([&] {
    HWY_DYNAMIC_DISPATCH(sample_columns)(u.data(), rotation.data(), lambda.data(), inv_pdf.data(), n);
    for (size_t i = 0; i < n; ++i) {
      const WavelengthSample expected = sample_wavelengths(u[i], rotation[i]);
      for (size_t j = 0; j < 4; ++j) {
        ASSERT_NEAR(lambda[j * n + i], expected.lambda_nm[j], 5e-5);
        ASSERT_EQ(inv_pdf[j * n + i], static_cast<float>(expected.inv_pdf_nm[j]));
        ASSERT_GE(lambda[j * n + i], 360.0f);
        ASSERT_LE(lambda[j * n + i], 830.0f);
      }
    }
  });
}

TEST(WavelengthKernel, GarbageInDeadLanesStaysInsideTheTable) {
  const float bad = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> u(16, bad);
  u[3] = 0.25f;
  u[5] = -1e30f;
  u[6] = 1e30f;
  std::vector<float> rotation(16, bad);
  rotation[3] = 0.6f;
  std::vector<float> lambda(64);
  std::vector<float> inv_pdf(64);
  for_each_target([&] {
    HWY_DYNAMIC_DISPATCH(sample_columns)(u.data(), rotation.data(), lambda.data(), inv_pdf.data(), 16);
    const WavelengthSample expected = sample_wavelengths(0.25, 0.6);
    for (size_t j = 0; j < 4; ++j) EXPECT_NEAR(lambda[16 * j + 3], expected.lambda_nm[j], 5e-5);
  });
}

}  // namespace
}  // namespace metamer
#endif
