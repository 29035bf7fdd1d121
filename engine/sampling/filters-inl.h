// SIMD twins of sample_filter and filter_weight. Absolute error of offsets in units of the radius: 1e-5 for a gaussian
// cut at no more than 10 sigma, 5e-7 for the others; relative error of weights 2e-7 (asserted by
// tests/engine/sampling/filters_test.cpp).
#if defined(METAMER_ENGINE_SAMPLING_FILTERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_ENGINE_SAMPLING_FILTERS_INL_H_
#undef METAMER_ENGINE_SAMPLING_FILTERS_INL_H_
#else
#define METAMER_ENGINE_SAMPLING_FILTERS_INL_H_
#endif

#include "engine/sampling/filters.h"
#include "engine/sampling/warps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace filters_detail {

// Offset in [-1, 1] under the triangle filter of radius 1.
HWY_INLINE VF tent_offset(VF u) {
  const MF left = hn::Lt(u, splat(0.5f));
  const VF rest = hn::IfThenElse(left, u, hn::Sub(splat(1.0f), u));
  const VF magnitude = hn::Sub(splat(1.0f), hn::Sqrt(hn::Add(rest, rest)));
  return hn::IfThenElse(left, hn::Neg(magnitude), magnitude);
}

// How far along the table of |t|, and in which cell of it.
struct TablePlace {
  VF position;
  VI cell;
};
HWY_INLINE TablePlace table_place(VF t) {
  const VF position = hn::Mul(hn::Abs(t), splat(static_cast<float>(filter_table_cells)));
  return {position, hn::Min(hn::ConvertTo(IntTag(), position), hn::Set(IntTag(), filter_table_cells - 1))};
}

HWY_INLINE VF corrected(const float* correction, VF t) {
  const FloatTag d;
  const auto [position, cell] = table_place(t);
  const VF a = hn::GatherIndex(d, correction, cell);
  const VF b = hn::GatherIndex(d, correction + 1, cell);
  return hn::CopySign(hn::MulAdd(hn::Sub(b, a), hn::Sub(position, hn::ConvertTo(d, cell)), a), t);
}

HWY_INLINE VF sample_axis(FilterKind kind, const float* correction, float radius, VF u) {
  VF t = hn::MulSub(u, splat(2.0f), splat(1.0f));
  if (kind == FilterKind::triangle || kind == FilterKind::gaussian) t = tent_offset(u);
  if (kind >= FilterKind::gaussian) t = corrected(correction, t);
  return hn::Mul(t, splat(radius));
}

HWY_INLINE VF axis_weight(const float* weights, VF u) {
  const TablePlace place = table_place(hn::MulSub(u, splat(2.0f), splat(1.0f)));
  return hn::GatherIndex(FloatTag(), weights, place.cell);
}

}  // namespace filters_detail

// An offset from the pixel's centre, in pixels.
HWY_INLINE Point2V sample_filter(const PixelFilter& filter, VF u, VF v) {
  return {filters_detail::sample_axis(filter.kind, filter.correction_x.data(), filter.radius_x, u),
          filters_detail::sample_axis(filter.kind, filter.correction_y.data(), filter.radius_y, v)};
}

// What the sample at that offset weighs.
HWY_INLINE VF filter_weight(const PixelFilter& filter, VF u, VF v) {
  if (!filter.is_signed()) return splat(1.0f);
  return hn::Mul(filters_detail::axis_weight(filter.weights_x.data(), u),
                 filters_detail::axis_weight(filter.weights_y.data(), v));
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
