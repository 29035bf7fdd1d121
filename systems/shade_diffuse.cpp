#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_diffuse.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/diffuse-inl.h"
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

void shade_diffuse_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  const Group& group = group_of(shade, ShadeKind::diffuse);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    VF albedo[4], f_cos[4], pdf, u, v;
    const VI row = material_row(shade, i);
    lane_reflectance(world, world.diffuse.reflectance, world.diffuse.texture, row, shade, i, albedo);
    const Frame frame = shading_frame(world, shade, i);
    const Vec3 wo = to_local(frame, load(shade.wo, i));
    if (work.weigh_light) {
      eval_diffuse(wo, albedo, to_local(frame, load(shade.light_direction, i)), f_cos, pdf);
      append_shadow_rays(shade, i, f_cos, pdf, shadow);
    }
    if (!work.draw_next) continue;
    sample_2d(point_key(shade, i), splat_u(bounce_dimension(work.depth, direction_dimension)), &u, &v);
    const BsdfSample next = sample_diffuse(wo, albedo, u, v);
    store_next(frame, next.wi, next.weight, next.pdf, shade, i);
    store(splat(1.0f), shade.next_eta_scale, i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(shade_diffuse_kernel);

void shade_diffuse(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(shade_diffuse_kernel)(world, work, shade, shadow);
}

}  // namespace metamer
#endif
