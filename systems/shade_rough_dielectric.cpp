#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_rough_dielectric.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/rough_dielectric-inl.h"
#include "systems/dielectric_optics-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// What the medium before the light lets through: that of wo's side, or the one behind the boundary.
HWY_INLINE void attenuate_light(const World& world, const ShadeStream& shade, size_t i, const MediaCrossing& crossing,
                                VF f_cos[4]) {
  const VF zero = hn::Zero(FloatTag());
  const MF from_inside = hn::Lt(dot(load(shade.light_direction, i), load(shade.normal, i)), zero);
  const MF behind = hn::And(crossing.followed, hn::Xor(from_inside, crossing.inside));
  const VU medium = if_then_else(behind, crossing.after, crossing.before).entry[0];
  VF lambda_nm[4], passes[4];
  load(shade.lambda_nm, i, lambda_nm);
  medium_transmittance(world, medium, lambda_nm, load(shade.light_distance, i), passes);
  for (int j = 0; j < 4; ++j) f_cos[j] = hn::Mul(f_cos[j], passes[j]);
}

void shade_rough_dielectric_kernel(const World& world, const ShadeWork& work, ShadeStream& shade,
                                   ShadowStream& shadow) {
  const Group& group = group_of(shade, ShadeKind::rough_dielectric);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const VI row = material_row(shade, i);
    MediaCrossing crossing;
    const DielectricOptics optics = dielectric_optics(world, shade, i, row, crossing);
    const Frame frame = boundary_frame(world, shade, i);
    const GgxLobe lobe = make_ggx_lobe(
        to_local(frame, load(shade.wo, i)),
        lane_alpha(world, world.dielectric.alpha_x, world.dielectric.alpha_texture[0], row, shade.alpha[0], i),
        lane_alpha(world, world.dielectric.alpha_y, world.dielectric.alpha_texture[1], row, shade.alpha[1], i));
    VF f_cos[4], pdf[4], u, v;
    if (work.weigh_light) {
      eval_rough_dielectric(lobe, optics, to_local(frame, load(shade.light_direction, i)), f_cos, pdf);
      if (world.has_interiors) attenuate_light(world, shade, i, crossing, f_cos);
      append_shadow_rays(shade, i, f_cos, pdf, shadow);
    }
    if (!work.draw_next) continue;
    const PointKey key = point_key(shade, i);
    const VF choice = sample_1d(key, splat_u(bounce_dimension(work.depth, lobe_dimension)));
    sample_2d(key, splat_u(bounce_dimension(work.depth, direction_dimension)), &u, &v);
    RoughDielectricSample next = sample_rough_dielectric(lobe, optics, choice, u, v);
    next.weight[0] =
        hn::IfThenElse(next.terminate_secondary, hn::Mul(next.weight[0], lone_weight(world, shade, i)), next.weight[0]);
    store_lone_share(world, next.terminate_secondary, shade, i);
    store_next(frame, next.wi, next.weight, next.pdf, shade, i);
    if (world.has_interiors) store_next_media(crossing, load(shade.next_direction, i), shade, i);
    store(refraction_scale(optics, sign_bit_set(lobe.side), next.transmitted), shade.next_eta_scale, i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(shade_rough_dielectric_kernel);

void shade_rough_dielectric(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(shade_rough_dielectric_kernel)(world, work, shade, shadow);
}

}  // namespace metamer
#endif
