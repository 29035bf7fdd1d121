#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_diffuse_transmission.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/diffuse_transmission-inl.h"
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

HWY_INLINE SheetOptics sheet_optics(const World& world, const ShadeStream& shade, size_t i) {
  const DiffuseTransmissionColumns& table = world.diffuse_transmission;
  const VI row = material_row(shade, i);
  SheetOptics optics;
  lane_reflectance(world, table.reflectance, table.reflectance_texture, shade.reflectance, row, shade, i,
                   optics.reflectance);
  lane_reflectance(world, table.transmittance, table.transmittance_texture, shade.transmittance, row, shade, i,
                   optics.transmittance);
  optics.reflected_share = sheet_share(optics);
  return optics;
}

void shade_diffuse_transmission_kernel(const World& world, const ShadeWork& work, ShadeStream& shade,
                                       ShadowStream& shadow) {
  const Group& group = group_of(shade, ShadeKind::diffuse_transmission);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const SheetOptics optics = sheet_optics(world, shade, i);
    const Frame frame = shading_frame(world, shade, i);
    const Vec3 wo = to_local(frame, load(shade.wo, i));
    VF f_cos[4], pdf, u, v;
    if (work.weigh_light) {
      eval_sheet(wo, optics, to_local(frame, load(shade.light_direction, i)), f_cos, pdf);
      append_shadow_rays(shade, i, f_cos, pdf, shadow);
    }
    if (!work.draw_next) continue;
    const PointKey key = point_key(shade, i);
    const VF choice = sample_1d(key, splat_u(bounce_dimension(work.depth, lobe_dimension)));
    sample_2d(key, splat_u(bounce_dimension(work.depth, direction_dimension)), &u, &v);
    const BsdfSample next = sample_sheet(wo, optics, choice, u, v);
    store_next(frame, next.wi, next.weight, next.pdf, shade, i);
    store(splat(1.0f), shade.next_eta_scale, i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(shade_diffuse_transmission_kernel);

void shade_diffuse_transmission(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(shade_diffuse_transmission_kernel)(world, work, shade, shadow);
}

}  // namespace metamer
#endif
