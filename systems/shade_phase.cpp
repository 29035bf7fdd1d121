#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_phase.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/phase-inl.h"
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

void shade_phase_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  const VF one = splat(1.0f);
  const VF unit[4] = {one, one, one, one};
  const Group& group = group_of(shade, ShadeKind::phase);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const VI row = material_row(shade, i);
    const VolumeColumns& table = world.volumes;
    const PhaseLobes lobes = {gather(table.g.data(), row), gather(table.g2.data(), row),
                              gather(table.g2_share.data(), row)};
    const Vec3 onward = -load(shade.wo, i);
    if (work.weigh_light) {
      const VF p = eval_phase(clamp(dot(onward, load(shade.light_direction, i)), -1.0f, 1.0f), lobes);
      const VF f[4] = {p, p, p, p};
      append_shadow_rays(shade, i, f, p, shadow);
    }
    if (!work.draw_next) continue;
    VF u, v;
    const VF choice = sample_1d(point_key(shade, i), splat_u(bounce_dimension(work.depth, lobe_dimension)));
    sample_2d(point_key(shade, i), splat_u(bounce_dimension(work.depth, direction_dimension)), &u, &v);
    const Vec3 next = sample_phase(lobes, choice, u, v);
    store_next(make_frame(onward), next, unit, eval_phase(next.z, lobes), shade, i);
    store(one, shade.next_eta_scale, i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(shade_phase_kernel);

void shade_phase(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(shade_phase_kernel)(world, work, shade, shadow);
}

}  // namespace metamer
#endif
