// Kernels that read spectra and observers against their double-precision twins, on every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/engine/spectrum/spectrum_kernel_test.cpp"
#include <gtest/gtest.h>
#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/spectrum/rgb_fit.h"
#include "engine/spectrum/spectrum-inl.h"
#include "engine/spectrum/spectrum_set.h"
#include "tests/support/each_target.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// out holds four columns of n rows, one per wavelength.
void eval_columns(const SpectrumView& view, const uint32_t* id, const float* lambda_nm, float* out, size_t n) {
  const FloatTag d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    VF lambda[4];
    VF value[4];
    for (size_t j = 0; j < 4; ++j) lambda[j] = hn::LoadU(d, lambda_nm + j * n + i);
    eval_spectrum4(view, hn::LoadU(UintTag(), id + i), lambda, value);
    for (size_t j = 0; j < 4; ++j) hn::StoreU(value[j], d, out + j * n + i);
  }
}

void observer_columns(const float* columns, const float* lambda_nm, float* out, size_t n) {
  const FloatTag d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    VF xyz[3];
    observer_xyz(columns, hn::LoadU(d, lambda_nm + i), xyz);
    for (size_t c = 0; c < 3; ++c) hn::StoreU(xyz[c], d, out + c * n + i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(eval_columns);
HWY_EXPORT(observer_columns);

namespace {

// One spectrum of each form, and ids and wavelengths that put every mixture of them into a vector.
struct Batch {
  SpectrumSet set;
  std::vector<uint32_t> id;
  std::vector<float> lambda_nm;

  static constexpr size_t rows = 16 * 64;
  Batch() : id(rows), lambda_nm(4 * rows) {
    std::vector<SpectrumId> kinds = {zero_spectrum,
                                     unit_spectrum,
                                     set.add_constant(0.3).id,
                                     set.add_rgb({0.63, 0.065, 0.05}, RgbKind::albedo).id,
                                     set.add_rgb({0.0, 0.0, 1.0}, RgbKind::albedo).id,
                                     set.add_rgb({1e-4, 2e-4, 1e-5}, RgbKind::albedo).id,
                                     set.add_rgb({17.0, 12.0, 4.0}, RgbKind::illuminant).id,
                                     *set.add_named("FL11"),
                                     *set.add_named("Au.k"),
                                     set.add_blackbody(2856.0).id};
    for (size_t i = 0; i < rows; ++i) {
      id[i] = kinds[(i * 7 + i / 64) % (i < rows / 2 ? 6 : kinds.size())];
      for (size_t j = 0; j < 4; ++j) {
        lambda_nm[j * rows + i] = 360.0f + 470.0f * static_cast<float>((i * 389 + j * 97) % rows) / (rows - 1);
      }
    }
  }
};

// The bound stated above eval_spectrum4.
double stated_error(const SpectrumSet& set, uint32_t id, double lambda_nm) {
  const SpectrumRow& row = set.row(id);
  const double t = (lambda_nm - sigmoid_center_nm) / sigmoid_half_range_nm;
  const double x = (row.c0 * t + row.c1) * t + row.c2;
  const double slope = 0.5 / std::pow(1.0 + x * x, 1.5);
  const double size = std::abs(row.c0) + std::abs(row.c1) + std::abs(row.c2);
  const float* table = set.view().tables + row.table * lambda_stride;
  double largest = 0.0;
  for (size_t i = 0; i < lambda_count; ++i) largest = std::max(largest, std::abs(static_cast<double>(table[i])));
  return std::abs(row.scale) * largest * (3e-7 + 2e-7 + 1e-7 * size * slope);
}

TEST(SpectrumKernel, InRgbModeReadsTheCoefficientOfEachChannel) {
  for (const ColorMode mode : {ColorMode::rgb, ColorMode::lamps}) {
    Batch batch;
    std::vector<SpectrumId> given;
    for (size_t i = 0, spectra = batch.set.size(); i < spectra; ++i)
      given.push_back(
          batch.set.with_coefficients(static_cast<SpectrumId>(i), {double(i), double(i) + 0.25, double(i) + 0.5}));
    for (size_t i = 0; i < Batch::rows; ++i) {
      batch.id[i] = given[batch.id[i]];
      for (size_t j = 0; j < 4; ++j)
        batch.lambda_nm[j * Batch::rows + i] =
            static_cast<float>(coefficient_space(mode).lambda_nm[(std::min<size_t>(j, 2) + i) % 3]);
    }
    std::vector<float> out(4 * Batch::rows);
    for_each_target([&] {
      HWY_DYNAMIC_DISPATCH(eval_columns)
      (batch.set.view(), batch.id.data(), batch.lambda_nm.data(), out.data(), Batch::rows);
      for (size_t i = 0; i < Batch::rows; ++i)
        for (size_t j = 0; j < 4; ++j)
          ASSERT_EQ(out[j * Batch::rows + i],
                    batch.set.row(batch.id[i]).coefficients[(std::min<size_t>(j, 2) + i) % 3]);
    });
  }
}

TEST(SpectrumKernel, AgreesWithItsTwinWithinTheStatedError) {
  const Batch batch;
  std::vector<float> out(4 * Batch::rows);
  for_each_target([&] {
    HWY_DYNAMIC_DISPATCH(eval_columns)
    (batch.set.view(), batch.id.data(), batch.lambda_nm.data(), out.data(), Batch::rows);
    for (size_t k = 0; k < out.size(); ++k) {
      const uint32_t id = batch.id[k % Batch::rows];
      const double lambda = batch.lambda_nm[k];
      const double expected = batch.set.value(id, lambda);
      ASSERT_NEAR(out[k], expected, stated_error(batch.set, id, lambda)) << "spectrum " << id << " at " << lambda;
      if (batch.set.is_constant(id)) {
        ASSERT_EQ(out[k], expected);
      }
    }
  });
}

TEST(SpectrumKernel, LanesDoNotDependOnTheirNeighbours) {
  const Batch batch;
  for_each_target([&] {
    std::vector<float> mixed(4 * Batch::rows);
    HWY_DYNAMIC_DISPATCH(eval_columns)
    (batch.set.view(), batch.id.data(), batch.lambda_nm.data(), mixed.data(), Batch::rows);
    for (size_t i = 0; i < Batch::rows; i += 37) {
      const std::vector<uint32_t> alone(16, batch.id[i]);
      std::vector<float> lambda(64);
      std::vector<float> out(64);
      for (size_t k = 0; k < 64; ++k) lambda[k] = batch.lambda_nm[k / 16 * Batch::rows + i];
      HWY_DYNAMIC_DISPATCH(eval_columns)(batch.set.view(), alone.data(), lambda.data(), out.data(), 16);
      for (size_t j = 0; j < 4; ++j) ASSERT_EQ(out[16 * j + 5], mixed[j * Batch::rows + i]);
    }
  });
}

TEST(SpectrumKernel, BadWavelengthsStayInsideTheTables) {
  SpectrumSet set;
  const SpectrumId d65 = *set.add_named("D65");
  const std::vector<uint32_t> id(16, d65);
  std::vector<float> lambda(64, 0.0f);
  std::fill(lambda.begin() + 16, lambda.begin() + 32, 1e30f);
  std::fill(lambda.begin() + 32, lambda.begin() + 48, -std::numeric_limits<float>::infinity());
  std::fill(lambda.begin() + 48, lambda.end(), std::numeric_limits<float>::quiet_NaN());
  std::vector<float> out(64);
  for_each_target([&] {
    HWY_DYNAMIC_DISPATCH(eval_columns)(set.view(), id.data(), lambda.data(), out.data(), 16);
    EXPECT_NEAR(out[0], set.value(d65, 360.0), 1e-4);
    EXPECT_NEAR(out[16], set.value(d65, 830.0), 1e-4);
  });
}

TEST(ObserverKernel, AgreesWithItsTwinWithinTheStatedError) {
  constexpr size_t n = 4096;
  std::vector<float> lambda(n);
  for (size_t i = 0; i < n; ++i) lambda[i] = 360.0f + 470.0f * static_cast<float>(i) / (n - 1);
  std::vector<float> out(3 * n);
  for (size_t k = 0; k < observer_count; ++k) {
    const auto observer = static_cast<Observer>(k);
    const ObserverTable& table = observer_table(observer);
    for_each_target([&] {
      HWY_DYNAMIC_DISPATCH(observer_columns)(table.columns.data(), lambda.data(), out.data(), n);
      for (size_t c = 0; c < 3; ++c) {
        const auto& matching = table.matching[c];
        const double largest = *std::max_element(matching.begin(), matching.end());
        for (size_t i = 0; i < n; ++i) {
          ASSERT_NEAR(out[c * n + i], observer_value(observer, lambda[i])[c], 3e-7 * largest) << lambda[i];
        }
      }
    });
  }
}

}  // namespace
}  // namespace metamer
#endif
