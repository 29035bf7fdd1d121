#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_hair.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/hair-inl.h"
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// The fibre runs along the tangent, and v goes across it from 0 to 1.
HWY_INLINE HairOptics hair_optics(const World& world, const ShadeStream& shade, size_t i) {
  const HairColumns& table = world.hair;
  const VI row = material_row(shade, i);
  VF lambda_nm[4];
  load(shade.lambda_nm, i, lambda_nm);
  HairOptics o;
  o.h = clamp(hn::MulSub(splat(2.0f), load(shade.uv[1], i), splat(1.0f)), -1.0f, 1.0f);
  o.eta = gather(table.eta.data(), row);
  eval_spectrum4(world.spectra.view(), gather(table.sigma_a.data(), row), lambda_nm, o.sigma_a);
  o.variance = gather(table.variance.data(), row);
  o.width = gather(table.width.data(), row);
  for (size_t k = 0; k < 3; ++k) {
    o.sin_tilt[k] = gather(table.sin_tilt[k].data(), row);
    o.cos_tilt[k] = gather(table.cos_tilt[k].data(), row);
  }
  return o;
}

void shade_hair_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  const Group& group = group_of(shade, ShadeKind::hair);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const HairOptics optics = hair_optics(world, shade, i);
    const Frame frame = shading_frame(world, shade, i);
    const HairView view = make_hair_view(to_local(frame, load(shade.wo, i)), optics);
    if (work.weigh_light) {
      VF f_cos[4], pdf;
      eval_hair(view, optics, to_local(frame, load(shade.light_direction, i)), f_cos, pdf);
      append_shadow_rays(shade, i, f_cos, pdf, shadow);
    }
    if (!work.draw_next) continue;
    const PointKey key = point_key(shade, i);
    const VF choice = sample_1d(key, splat_u(bounce_dimension(work.depth, lobe_dimension)));
    VF u, v;
    sample_2d(key, splat_u(bounce_dimension(work.depth, direction_dimension)), &u, &v);
    const BsdfSample next = sample_hair(view, optics, choice, u, v);
    store_next(frame, next.wi, next.weight, next.pdf, shade, i);
    store(splat(1.0f), shade.next_eta_scale, i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(shade_hair_kernel);

void shade_hair(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(shade_hair_kernel)(world, work, shade, shadow);
}

}  // namespace metamer
#endif
