// SIMD twins of distribution.h: the same bits as the scalar functions in every lane.
#if defined(METAMER_ENGINE_SAMPLING_DISTRIBUTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_ENGINE_SAMPLING_DISTRIBUTION_INL_H_
#undef METAMER_ENGINE_SAMPLING_DISTRIBUTION_INL_H_
#else
#define METAMER_ENGINE_SAMPLING_DISTRIBUTION_INL_H_
#endif

#include "engine/sampling/distribution.h"
#include "engine/simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

struct DiscreteSampleV {
  VI index;
  VF probability;
  VF remapped;  // in [0, 1)
};

struct SquareSampleV {
  VF x, y;  // in [0, 1)
  VF pdf;   // per unit square's area
  VI cell;  // row * width + column
};

namespace distribution_detail {

// The cdf of a lane starts at cdf[cdf_offset], its guide at guide[guide_offset]. Lanes that are done wait for the
// others without changing, so their result does not depend on them.
HWY_INLINE DiscreteSampleV sample_cdf(const float* cdf, VI cdf_offset, const int32_t* guide, VI guide_offset,
                                      uint32_t bins, VF u) {
  const FloatTag d;
  const IntTag di;
  const VI one = hn::Set(di, 1);
  u = hn::Max(hn::Min(u, splat(metamer::distribution_detail::largest_below_one)), hn::Zero(d));
  const VI cell = hn::ConvertTo(di, hn::Mul(u, splat(static_cast<float>(guide_cells(bins)))));
  const VI guide_index = hn::Add(guide_offset, cell);
  VI low = hn::Add(cdf_offset, hn::GatherIndex(di, guide, guide_index));
  VI high = hn::Add(cdf_offset, hn::GatherIndex(di, guide + 1, guide_index));
  while (!hn::AllTrue(di, hn::Eq(low, high))) {
    const VI middle = hn::Add(low, hn::ShiftRight<1>(hn::Add(hn::Sub(high, low), one)));
    const auto up = hn::RebindMask(di, hn::Le(hn::GatherIndex(d, cdf, middle), u));
    high = hn::IfThenElse(up, high, hn::Max(low, hn::Sub(middle, one)));
    low = hn::IfThenElse(up, middle, low);
  }
  const VF start = hn::GatherIndex(d, cdf, low);
  const VF probability = hn::Sub(hn::GatherIndex(d, cdf + 1, low), start);
  const VF remapped = hn::Div(hn::Sub(u, start), probability);
  return {hn::Sub(low, cdf_offset), probability,
          hn::Min(remapped, splat(metamer::distribution_detail::largest_below_one))};
}

HWY_INLINE VF coordinate(VI bin, VF offset, uint32_t bins) {
  const VF start = hn::ConvertTo(FloatTag(), bin);
  const VF end = hn::Mul(hn::Add(start, splat(1.0f)), splat(metamer::distribution_detail::just_below_one));
  const VF first = hn::Mul(start, splat(metamer::distribution_detail::just_above_one));
  return hn::Div(hn::Max(hn::Min(hn::Add(start, offset), end), first), splat(static_cast<float>(bins)));
}

HWY_INLINE VI bin_of(VF x, uint32_t bins) {
  const float last = static_cast<float>(bins - 1);
  const VF position = hn::Mul(hn::Max(x, hn::Zero(FloatTag())), splat(static_cast<float>(bins)));
  return hn::ConvertTo(IntTag(), hn::Min(position, splat(last)));
}

}  // namespace distribution_detail

HWY_INLINE DiscreteSampleV sample_discrete(const Distribution1D& distribution, VF u) {
  const VI zero = hn::Zero(IntTag());
  return distribution_detail::sample_cdf(distribution.cdf.data(), zero, distribution.guide.data(), zero,
                                         distribution.size(), u);
}

HWY_INLINE VF discrete_probability(const Distribution1D& distribution, VI index) {
  const FloatTag d;
  return hn::Sub(hn::GatherIndex(d, distribution.cdf.data() + 1, index),
                 hn::GatherIndex(d, distribution.cdf.data(), index));
}

HWY_INLINE SquareSampleV sample_square(const Distribution2D& distribution, VF u, VF v) {
  const uint32_t width = distribution.width, height = distribution.height;
  const VI zero = hn::Zero(IntTag());
  const DiscreteSampleV row = distribution_detail::sample_cdf(distribution.marginal.data(), zero,
                                                              distribution.marginal_guide.data(), zero, height, v);
  const VI stride = hn::Set(IntTag(), static_cast<int32_t>(width + 1));
  const VI guide_stride = hn::Set(IntTag(), static_cast<int32_t>(guide_cells(width) + 1));
  const DiscreteSampleV column = distribution_detail::sample_cdf(
      distribution.conditional.data(), hn::Mul(row.index, stride), distribution.conditional_guide.data(),
      hn::Mul(row.index, guide_stride), width, u);
  const VF cells = splat(static_cast<float>(width) * static_cast<float>(height));
  return {distribution_detail::coordinate(column.index, column.remapped, width),
          distribution_detail::coordinate(row.index, row.remapped, height),
          hn::Mul(hn::Mul(row.probability, column.probability), cells),
          hn::Add(hn::Mul(row.index, hn::Set(IntTag(), static_cast<int32_t>(width))), column.index)};
}

HWY_INLINE VF square_pdf(const Distribution2D& distribution, VF x, VF y) {
  const FloatTag d;
  const uint32_t width = distribution.width, height = distribution.height;
  const VI row = distribution_detail::bin_of(y, height);
  const VI stride = hn::Set(IntTag(), static_cast<int32_t>(width + 1));
  const VI column = hn::Add(hn::Mul(row, stride), distribution_detail::bin_of(x, width));
  const float* marginal = distribution.marginal.data();
  const float* conditional = distribution.conditional.data();
  const VF row_probability = hn::Sub(hn::GatherIndex(d, marginal + 1, row), hn::GatherIndex(d, marginal, row));
  const VF probability = hn::Sub(hn::GatherIndex(d, conditional + 1, column), hn::GatherIndex(d, conditional, column));
  const VF cells = splat(static_cast<float>(width) * static_cast<float>(height));
  return hn::Mul(hn::Mul(row_probability, probability), cells);
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
