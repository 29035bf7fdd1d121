#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/probe_rays.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

void probe_lanes(const ShadeStream& shade, size_t i, PathStream& next) {
  VF throughput[4];
  next_throughput(shade, i, throughput);
  const Vec3 direction = load(shade.next_direction, i), origin = ray_origin(shade, i, direction);
  const MF counts = hn::And(is_live(load(shade.slot, i)), hn::Gt(max_of(throughput), hn::Zero(FloatTag())));
  append_ray(hn::And(counts, is_traceable(origin, direction)), shade, i, {origin, direction}, throughput, next);
}

void probe_rays_kernel(const ShadeStream& shade, PathStream& next) {
  next.size = 0;
  for (const ShadeKind kind : rough_kinds) {
    const Group& group = group_of(shade, kind);
    for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) probe_lanes(shade, i, next);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(probe_rays_kernel);

void probe_rays(const ShadeStream& shade, PathStream& next) { HWY_DYNAMIC_DISPATCH(probe_rays_kernel)(shade, next); }

}  // namespace metamer
#endif
