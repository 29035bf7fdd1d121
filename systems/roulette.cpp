#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/roulette.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// From the fourth vertex on a path survives with the probability of its largest throughput (at most 1), the change of
// radiance by refraction apart: what a path passes through glass and out again is no reason to end it. Earlier vertices
// carry most of the picture. Against a start at the second vertex, error times processor time over four seeds at 64
// samples: Cornell box 0.87 (0.71 to 1.07), veach-mis 1.00 (0.83 to 1.18), which is to say a third less error on the
// one, a fifth less on the other, for a third and a quarter more time.
constexpr uint32_t first_roulette_depth = 3;

void roulette_lanes(uint32_t depth, const ShadeStream& shade, size_t i, PathStream& next) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = splat(1.0f);
  VF throughput[4];
  next_throughput(shade, i, throughput);
  const VF importance = hn::Mul(max_of(throughput), next_eta_scale(shade, i));
  MF survives = hn::And(is_live(load(shade.slot, i)), hn::Gt(importance, zero));
  if (depth >= first_roulette_depth) {
    const VF probability = hn::Min(importance, one);
    const VF u = sample_1d(point_key(shade, i), splat_u(bounce_dimension(depth, roulette_dimension)));
    survives = hn::And(survives, hn::Lt(u, probability));
    const VF compensation = hn::Div(one, hn::Max(probability, splat(1e-30f)));
    for (VF& t : throughput) t = hn::Mul(t, compensation);
  }
  const Vec3 direction = load(shade.next_direction, i), origin = ray_origin(shade, i, direction);
  survives = hn::And(survives, is_traceable(origin, direction));
  append_ray(survives, shade, i, {origin, direction}, throughput, next);
}

void roulette_kernel(uint32_t depth, const ShadeStream& shade, PathStream& next) {
  next.size = 0;
  const size_t end = group_of(shade, ShadeKind::absorber).begin;
  for (size_t i = 0; i < end; i += lane_count()) roulette_lanes(depth, shade, i, next);
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(roulette_kernel);

void roulette(uint32_t depth, const ShadeStream& shade, PathStream& next) {
  HWY_DYNAMIC_DISPATCH(roulette_kernel)(depth, shade, next);
}

}  // namespace metamer
#endif
