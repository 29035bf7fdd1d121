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

// The cdf of a lane starts at cdf[offset]. All lanes take the same number of steps.
HWY_INLINE DiscreteSampleV sample_cdf(const float* cdf, VI offset, uint32_t bins, VF u) {
  const FloatTag d;
  VI low = offset;
  for (uint32_t length = bins; length > 1;) {
    const uint32_t half = length / 2;
    const VI middle = hn::Add(low, hn::Set(IntTag(), static_cast<int32_t>(half)));
    const MF up = hn::Le(hn::GatherIndex(d, cdf, middle), u);
    low = hn::IfThenElse(hn::RebindMask(IntTag(), up), middle, low);
    length -= half;
  }
  const VF start = hn::GatherIndex(d, cdf, low);
  const VF probability = hn::Sub(hn::GatherIndex(d, cdf + 1, low), start);
  const VF remapped = hn::Div(hn::Sub(u, start), probability);
  return {hn::Sub(low, offset), probability, hn::Min(remapped, splat(metamer::distribution_detail::largest_below_one))};
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
  return distribution_detail::sample_cdf(distribution.cdf.data(), hn::Zero(IntTag()), distribution.size(), u);
}

HWY_INLINE VF discrete_probability(const Distribution1D& distribution, VI index) {
  const FloatTag d;
  return hn::Sub(hn::GatherIndex(d, distribution.cdf.data() + 1, index),
                 hn::GatherIndex(d, distribution.cdf.data(), index));
}

HWY_INLINE SquareSampleV sample_square(const Distribution2D& distribution, VF u, VF v) {
  const uint32_t width = distribution.width, height = distribution.height;
  const DiscreteSampleV row =
      distribution_detail::sample_cdf(distribution.marginal.data(), hn::Zero(IntTag()), height, v);
  const VI stride = hn::Set(IntTag(), static_cast<int32_t>(width + 1));
  const DiscreteSampleV column =
      distribution_detail::sample_cdf(distribution.conditional.data(), hn::Mul(row.index, stride), width, u);
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
