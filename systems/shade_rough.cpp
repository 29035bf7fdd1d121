#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_rough.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/rough-inl.h"
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

HWY_INLINE RoughOptics rough_optics(const World& world, const ShadeStream& shade, size_t i) {
  const SpectrumView spectra = world.spectra.view();
  const VI row = material_row(shade, i);
  VF lambda_nm[4];
  load(shade.lambda_nm, i, lambda_nm);
  RoughOptics optics;
  eval_spectrum4(spectra, gather(world.rough.kd.data(), row), lambda_nm, optics.kd);
  eval_spectrum4(spectra, gather(world.rough.ks.data(), row), lambda_nm, optics.ks);
  optics.shininess = gather(world.rough.shininess.data(), row);
  optics.normalized = float_mask(hn::Ne(gather(world.rough.normalized.data(), row), splat_u(0)));
  return optics;
}

void shade_rough_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  const Group& group = group_of(shade, ShadeKind::rough);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const RoughOptics optics = rough_optics(world, shade, i);
    const Frame frame = shading_frame(world, shade, i);
    const RoughLobe lobe = make_rough_lobe(to_local(frame, load(shade.wo, i)), optics);
    VF f_cos[4], pdf, u, v;
    if (work.weigh_light) {
      eval_rough(lobe, optics, to_local(frame, load(shade.light_direction, i)), f_cos, pdf);
      append_shadow_rays(shade, i, f_cos, pdf, shadow);
    }
    if (!work.draw_next) continue;
    const PointKey key = point_key(shade, i);
    const VF choice = sample_1d(key, splat_u(bounce_dimension(work.depth, lobe_dimension)));
    sample_2d(key, splat_u(bounce_dimension(work.depth, direction_dimension)), &u, &v);
    const BsdfSample next = sample_rough(lobe, optics, choice, u, v);
    store_next(frame, next.wi, next.weight, next.pdf, shade, i);
    store(splat(1.0f), shade.next_eta_scale, i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(shade_rough_kernel);

void shade_rough(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(shade_rough_kernel)(world, work, shade, shadow);
}

}  // namespace metamer
#endif
