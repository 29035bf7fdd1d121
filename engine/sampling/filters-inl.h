// SIMD twin of sample_filter. Absolute error in units of the radius: 5e-7 for box and triangle, 1e-5 for a gaussian
// cut at no more than 10 sigma (asserted by tests/engine/sampling/filters_test.cpp).
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

HWY_INLINE VF corrected(const float* correction, VF t) {
  const FloatTag d;
  const VF position = hn::Mul(hn::Abs(t), splat(static_cast<float>(filter_table_cells)));
  const VI cell = hn::Min(hn::ConvertTo(IntTag(), position), hn::Set(IntTag(), filter_table_cells - 1));
  const VF a = hn::GatherIndex(d, correction, cell);
  const VF b = hn::GatherIndex(d, correction + 1, cell);
  return hn::CopySign(hn::MulAdd(hn::Sub(b, a), hn::Sub(position, hn::ConvertTo(d, cell)), a), t);
}

HWY_INLINE VF sample_axis(FilterKind kind, const float* correction, float radius, VF u) {
  VF t = hn::MulSub(u, splat(2.0f), splat(1.0f));
  if (kind != FilterKind::box) t = tent_offset(u);
  if (kind == FilterKind::gaussian) t = corrected(correction, t);
  return hn::Mul(t, splat(radius));
}

}  // namespace filters_detail

// An offset from the pixel's centre, in pixels.
HWY_INLINE Point2V sample_filter(const PixelFilter& filter, VF u, VF v) {
  return {filters_detail::sample_axis(filter.kind, filter.correction_x.data(), filter.radius_x, u),
          filters_detail::sample_axis(filter.kind, filter.correction_y.data(), filter.radius_y, v)};
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
