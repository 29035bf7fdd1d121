#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_phase.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "engine/sampling/distribution-inl.h"
#include "systems/bsdf/phase-inl.h"
#include "systems/equiangular-inl.h"
#include "systems/shade-inl.h"
#include "systems/volumes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// How much of a light sample counts: of lights at a point, those that scattered_light() finds in another way, a share.
VF light_share(const World& world, const ShadeStream& shade, size_t i, VI volume, const Vec3& onward) {
  const FloatTag d;
  const VF one = splat(1.0f);
  if (world.positional_choice.size() == 0) return one;
  const auto is_even = hn::Eq(gather(world.volumes.grid.data(), volume), splat_u(no_index));
  const VU row = load(shade.light, i);
  const auto known = hn::And(is_even, hn::And(uint_mask(is_live(load(shade.slot, i))), hn::Ne(row, splat_u(no_index))));
  const LightFields light(world, as_index(hn::IfThenElseZero(known, row)));
  const VF chosen = discrete_probability(world.positional_choice, light.light);
  const MF counts = hn::And(float_mask(known), hn::Gt(chosen, hn::Zero(d)));
  if (hn::AllFalse(d, counts)) return one;
  VF lambda_nm[4];
  load(shade.lambda_nm, i, lambda_nm);
  const VolumeCoefficients c = volume_coefficients(world, hn::BitCast(UintTag(), volume), lambda_nm);
  const VF t = load(shade.distance, i);
  const Vec3 from = mul_add(onward, hn::Neg(t), load(shade.position, i));
  const Equiangular angles = equiangular(light.vector(offsetof(LightRow, p)) - from, onward);
  const VF share = free_path_share(angles, t, c.extinction, live_wavelengths(world.settings),
                                   light.number(offsetof(LightRow, choice_probability)), chosen);
  return hn::IfThenElse(counts, share, one);
}

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
      const VF share = light_share(world, shade, i, row, onward);
      const VF weight = hn::Mul(light_sample_weight(shade, i, p), share);
      const VF weights[4] = {weight, weight, weight, weight};
      append_weighted_shadow_rays(shade, i, f, weights, shadow);
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
