#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_conductor.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/ggx-inl.h"
#include "systems/dielectric_optics-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// Where a reflectance along the normal is given: eta 1 and kappa 2 sqrt(R) / sqrt(1 - R), as pbrt-v4.
HWY_INLINE void apply_reflectance(const World& world, const ShadeStream& shade, size_t i, VI row,
                                  ConductorOptics& optics) {
  const VF one = splat(1.0f);
  const MF given = float_mask(hn::Ne(gather(world.conductor.texture.data(), row), splat_u(no_index)));
  if (hn::AllFalse(FloatTag(), given)) return;
  for (size_t j = 0; j < 4; ++j) {
    const VF reflectance = clamp(load(shade.reflectance[j], i), 0.0f, 0.9999f);
    const VF kappa = hn::Mul(splat(2.0f), hn::Sqrt(hn::Div(reflectance, hn::Sub(one, reflectance))));
    optics.n[j] = hn::IfThenElse(given, one, optics.n[j]);
    optics.kappa[j] = hn::IfThenElse(given, kappa, optics.kappa[j]);
  }
}

HWY_INLINE ConductorOptics conductor_optics(const World& world, const ShadeStream& shade, size_t i, VI row) {
  const SpectrumView spectra = world.spectra.view();
  VF lambda_nm[4];
  load(shade.lambda_nm, i, lambda_nm);
  ConductorOptics optics;
  eval_spectrum4(spectra, gather(world.conductor.eta.data(), row), lambda_nm, optics.n);
  eval_spectrum4(spectra, gather(world.conductor.kappa.data(), row), lambda_nm, optics.kappa);
  if (world.has_textures()) apply_reflectance(world, shade, i, row, optics);
  if (world.has_interiors) {
    const VU around = load_media(shade.media, i).entry[0];
    make_relative(world, around, lambda_nm, optics.n);
    make_relative(world, around, lambda_nm, optics.kappa);
  }
  optics.schlick = float_mask(hn::Ne(gather(world.conductor.schlick.data(), row), splat_u(0)));
  return optics;
}

void shade_rough_conductor_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  const Group& group = group_of(shade, ShadeKind::rough_conductor);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const VI row = material_row(shade, i);
    const ConductorOptics optics = conductor_optics(world, shade, i, row);
    const Frame frame = shading_frame(world, shade, i);
    const Vec3 wo = to_local(frame, load(shade.wo, i));
    const GgxLobe lobe = make_ggx_lobe(
        wo, lane_alpha(world, world.conductor.alpha_x, world.conductor.alpha_texture[0], row, shade.alpha[0], i),
        lane_alpha(world, world.conductor.alpha_y, world.conductor.alpha_texture[1], row, shade.alpha[1], i));
    VF f_cos[4], pdf, u, v;
    if (work.weigh_light) {
      eval_conductor(lobe, optics, to_local(frame, load(shade.light_direction, i)), f_cos, pdf);
      append_shadow_rays(shade, i, f_cos, pdf, shadow);
    }
    if (!work.draw_next) continue;
    sample_2d(point_key(shade, i), splat_u(bounce_dimension(work.depth, direction_dimension)), &u, &v);
    const BsdfSample next = sample_conductor(lobe, optics, u, v);
    store_next(frame, next.wi, next.weight, next.pdf, shade, i);
    store(splat(1.0f), shade.next_eta_scale, i);
  }
}

void shade_smooth_conductor_kernel(const World& world, ShadeStream& shade) {
  const Group& group = group_of(shade, ShadeKind::smooth_conductor);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const ConductorOptics optics = conductor_optics(world, shade, i, material_row(shade, i));
    const Vec3 wo = load(shade.wo, i), normal = load(shade.shading_normal, i);
    const VF cos_theta = dot(wo, normal);
    VF weight[4];
    conductor_reflectance(optics, hn::Abs(cos_theta), weight);
    store(reflect(-wo, normal), shade.next_direction, i);
    store(weight, shade.next_weight, i);
    store(hn::Zero(FloatTag()), shade.next_pdf, i);
    store(splat(1.0f), shade.next_eta_scale, i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(shade_rough_conductor_kernel);
HWY_EXPORT(shade_smooth_conductor_kernel);

void shade_rough_conductor(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(shade_rough_conductor_kernel)(world, work, shade, shadow);
}

void shade_smooth_conductor(const World& world, ShadeStream& shade) {
  HWY_DYNAMIC_DISPATCH(shade_smooth_conductor_kernel)(world, shade);
}

}  // namespace metamer
#endif
