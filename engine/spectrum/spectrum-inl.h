// Spectra at the wavelengths of a path, per lane. Included once per instruction set, hence the toggling guard.
#if defined(METAMER_ENGINE_SPECTRUM_SPECTRUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_ENGINE_SPECTRUM_SPECTRUM_INL_H_
#undef METAMER_ENGINE_SPECTRUM_SPECTRUM_INL_H_
#else
#define METAMER_ENGINE_SPECTRUM_SPECTRUM_INL_H_
#endif

#include "engine/simd/vec3-inl.h"
#include "engine/spectrum/color_mode.h"
#include "engine/spectrum/observers.h"
#include "engine/spectrum/rgb_fit.h"
#include "engine/spectrum/spectrum_set.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// S(x) = 1/2 + x / (2 sqrt(1 + x^2)); twin: sigmoid(). Absolute error below 1.2e-7; exact at +-1e18.
HWY_INLINE VF sigmoid(VF x) {
  const VF half = splat(0.5f);
  return hn::Add(half, hn::Div(hn::Mul(half, x), hn::Sqrt(hn::MulAdd(x, x, splat(1.0f)))));
}

// S(c0 t^2 + c1 t + c2) at lambda_nm, for coefficients that are already in lanes (textures).
// Twin: sigmoid_polynomial(). Absolute error below 2e-7 + 1e-7 (|c0| + |c1| + |c2|) S'(x), S' = (1 + x^2)^-1.5 / 2 at
// the argument x: steep spectra are uncertain by what single precision does to x.
HWY_INLINE VF sigmoid_polynomial(VF c0, VF c1, VF c2, VF lambda_nm) {
  constexpr float inverse = static_cast<float>(1.0 / sigmoid_half_range_nm);
  const VF t = hn::Mul(hn::Sub(lambda_nm, splat(static_cast<float>(sigmoid_center_nm))), splat(inverse));
  return sigmoid(hn::MulAdd(hn::MulAdd(c0, t, c1), t, c2));
}

// Where a wavelength falls in 1 nm tables: the lower entry and the fraction towards the next. Clamped to 360..830 nm;
// NaN becomes 360.
struct TablePosition {
  VI lower;
  VF fraction;
};
HWY_INLINE TablePosition table_position(VF lambda_nm) {
  const VF last = splat(static_cast<float>(lambda_count - 1));
  const VF offset = hn::Sub(lambda_nm, splat(static_cast<float>(lambda_min_nm)));
  const VF position = hn::Min(hn::Max(hn::IfThenZeroElse(hn::IsNaN(offset), offset), splat(0.0f)), last);
  const VI lower = hn::Min(hn::ConvertTo(IntTag(), position), hn::Set(IntTag(), static_cast<int>(lambda_count) - 2));
  return {lower, hn::Sub(position, hn::ConvertTo(FloatTag(), lower))};
}

// Linear interpolation in the table that starts at tables[offset].
HWY_INLINE VF table_value(const float* HWY_RESTRICT tables, VI offset, const TablePosition& at) {
  const FloatTag d;
  const VI index = hn::Add(offset, at.lower);
  const VF below = hn::GatherIndex(d, tables, index);
  const VF above = hn::GatherIndex(d, tables + 1, index);
  return hn::MulAdd(at.fraction, hn::Sub(above, below), below);
}

// RGB mode: the channel that a path's wavelength stands for, 0 red, 1 green, 2 blue.
HWY_INLINE VI channel_of(VF lambda_nm) {
  const IntTag di;
  const auto is_below = [&](double nm) {  // -1 or 0
    return hn::VecFromMask(di, hn::RebindMask(di, hn::Lt(lambda_nm, splat(static_cast<float>(nm)))));
  };
  return hn::Neg(hn::Add(is_below(red_above_nm), is_below(blue_below_nm)));
}

// Spectrum `id` of each lane at four wavelengths in nm, clamped to 360..830. Ids must be valid in every lane, dead
// ones included (0 will do). Twin: SpectrumSet::value(). Error: that of sigmoid_polynomial() times |scale table|, plus
// 3e-7 |scale| max |table|. In RGB mode the coefficients of the channels, exactly; a path's fourth wavelength carries
// nothing there and repeats the third.
HWY_INLINE void eval_spectrum4(const SpectrumView& view, VU id, const VF lambda_nm[4], VF out[4]) {
  static_assert(spectrum_row_floats == 8);
  const FloatTag d;
  const VI row = hn::BitCast(IntTag(), hn::ShiftLeft<3>(id));
  if (view.has_coefficients) {
    const float* coefficients = view.rows + spectrum_row_coefficients;
    for (int i = 0; i < 3; ++i) out[i] = hn::GatherIndex(d, coefficients, hn::Add(row, channel_of(lambda_nm[i])));
    out[3] = out[2];
    return;
  }
  const VF c0 = hn::GatherIndex(d, view.rows, row);
  const VF c1 = hn::GatherIndex(d, view.rows + 1, row);
  const VF c2 = hn::GatherIndex(d, view.rows + 2, row);
  const VF scale = hn::GatherIndex(d, view.rows + 3, row);
  const VI table = hn::BitCast(IntTag(), hn::GatherIndex(d, view.rows + 4, row));
  for (int i = 0; i < 4; ++i) out[i] = hn::Mul(scale, sigmoid_polynomial(c0, c1, c2, lambda_nm[i]));
  // Table 0 is all ones, so lanes without a table get the same bits whether or not their neighbours have one.
  if (hn::AllTrue(IntTag(), hn::Eq(table, hn::Zero(IntTag())))) return;
  const VI offset = hn::Mul(table, hn::Set(IntTag(), static_cast<int32_t>(view.table_stride)));
  for (int i = 0; i < 4; ++i) {
    out[i] = hn::Mul(out[i], table_value(view.tables, offset, table_position(lambda_nm[i])));
  }
}

// The colour-matching functions at lambda_nm in 360..830; `columns` is ObserverTable::columns. Twin: observer_value().
// Absolute error below 3e-7 of the function's maximum.
HWY_INLINE void observer_xyz(const float* HWY_RESTRICT columns, VF lambda_nm, VF xyz[3]) {
  const TablePosition at = table_position(lambda_nm);
  for (size_t c = 0; c < 3; ++c) xyz[c] = table_value(columns + c * lambda_stride, hn::Zero(IntTag()), at);
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
