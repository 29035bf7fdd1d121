#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/accumulate.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "engine/spectrum/color_mode.h"
#include "engine/spectrum/spectrum-inl.h"
#include "engine/spectrum/wavelengths.h"
#include "systems/lanes-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// XYZ of samples into their columns: bright ones scaled down, balanced, and weighed by the pixel filter.
// `scale`: what of the radiance was recorded, but for the balance.
HWY_INLINE void record(const World& world, const Slots& slots, size_t i, VF value[3], const Columns<float, 3>& xyz,
                       float* scale) {
  const float most = world.settings.largest_component;
  VF kept = splat(1.0f);
  if (most < std::numeric_limits<float>::infinity()) {
    const VF largest = hn::Max(value[0], hn::Max(value[1], value[2]));
    kept = hn::IfThenElse(hn::Gt(largest, splat(most)), hn::Div(splat(most), largest), kept);
  }
  kept = hn::Mul(kept, load(slots.weight, i));
  store(kept, scale, i);
  for (size_t c = 0; c < 3; ++c) value[c] = hn::Mul(value[c], kept);
  const auto& m = world.sensor_matrix;
  for (size_t c = 0; c < 3; ++c) {
    VF recorded = value[c];
    if (world.settings.white_balance_kelvin > 0) {
      recorded = hn::Mul(splat(m[3 * c]), value[0]);
      for (size_t k = 1; k < 3; ++k) recorded = hn::MulAdd(splat(m[3 * c + k]), value[k], recorded);
    }
    store(recorded, xyz[c], i);
  }
}

// X = 683 integral of L xbar d(lambda), estimated by the mean over a path's wavelengths of L xbar / p.
void to_xyz(const World& world, const Slots& slots, const Columns<float, 3>& xyz, float* row_scale) {
  const float* observer = observer_table(Observer::cie1931).columns.data();
  const VF scale = splat(static_cast<float>(luminous_efficacy / wavelengths_per_path) * world.settings.sensor_scale);
  for (size_t i = 0; i < slots.size; i += lane_count()) {
    VF sum[3] = {hn::Zero(FloatTag()), hn::Zero(FloatTag()), hn::Zero(FloatTag())};
    for (size_t j = 0; j < 4; ++j) {
      VF matching[3];
      observer_xyz(observer, load(slots.lambda_nm[j], i), matching);
      const VF weight = hn::Mul(load(slots.radiance[j], i), load(slots.inv_pdf_nm[j], i));
      for (size_t c = 0; c < 3; ++c) sum[c] = hn::MulAdd(weight, matching[c], sum[c]);
    }
    for (VF& value : sum) value = hn::Mul(value, scale);
    record(world, slots, i, sum, xyz, row_scale);
  }
}

// RGB mode: the three channels, each on its wavelength's primary.
void channels_to_xyz(const World& world, const Slots& slots, const Columns<float, 3>& xyz, float* row_scale) {
  const Matrix3& matrix = coefficient_space(world.settings.color).to_xyz;
  const auto primary = [&](size_t c, size_t channel) {
    return splat(static_cast<float>(matrix[c][channel]) * world.settings.sensor_scale);
  };
  for (size_t i = 0; i < slots.size; i += lane_count()) {
    VF sum[3] = {hn::Zero(FloatTag()), hn::Zero(FloatTag()), hn::Zero(FloatTag())};
    for (size_t j = 0; j < 3; ++j) {
      const VF lambda_nm = load(slots.lambda_nm[j], i), radiance = load(slots.radiance[j], i);
      const MF is_red = hn::Gt(lambda_nm, splat(static_cast<float>(red_above_nm)));
      const MF is_blue = hn::Lt(lambda_nm, splat(static_cast<float>(blue_below_nm)));
      for (size_t c = 0; c < 3; ++c) {
        const VF other = hn::IfThenElse(is_blue, primary(c, 2), primary(c, 1));
        sum[c] = hn::MulAdd(radiance, hn::IfThenElse(is_red, primary(c, 0), other), sum[c]);
      }
    }
    record(world, slots, i, sum, xyz, row_scale);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(to_xyz);
HWY_EXPORT(channels_to_xyz);

void accumulate(const World& world, const Slots& slots, TileFilm& film, SampleWeights weights) {
  alignas(column_alignment) float X[batch_capacity], Y[batch_capacity], Z[batch_capacity], scale[batch_capacity];
  if (world.settings.color == ColorMode::spectral)
    HWY_DYNAMIC_DISPATCH(to_xyz)(world, slots, {X, Y, Z}, scale);
  else
    HWY_DYNAMIC_DISPATCH(channels_to_xyz)(world, slots, {X, Y, Z}, scale);
  const std::span<const uint32_t> pixel(slots.pixel, slots.size);
  uint8_t live[batch_capacity], recorded[batch_capacity];
  for (uint32_t i = 0; i < slots.size; ++i) {
    live[i] = slots.pixel[i] != dead_lane;
    recorded[i] = is_recordable(X[i]) & is_recordable(Y[i]) & is_recordable(Z[i]);
  }
  add_samples(film, pixel, {slots.sample, slots.size}, X, Y, Z, {live, slots.size});
  if (film.band_count() == 0) return;
  const auto columns = [](const Columns<float, 4>& c) { return std::array<const float*, 4>{c[0], c[1], c[2], c[3]}; };
  const BandSamples bands{columns(slots.lambda_nm),
                          columns(slots.inv_pdf_nm),
                          columns(slots.radiance),
                          world.settings.sensor_scale,
                          scale,
                          weights == SampleWeights::added};
  add_band_samples(film, pixel, bands, {live, slots.size}, {recorded, slots.size});
}

}  // namespace metamer
#endif
