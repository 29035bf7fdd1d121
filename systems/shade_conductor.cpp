#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_conductor.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/ggx-inl.h"
#include "systems/dielectric_optics-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// Where a reflectance along the normal is given.
HWY_INLINE void apply_reflectance(const World& world, const ShadeStream& shade, size_t i, VI row,
                                  ConductorOptics& optics) {
  const MF given = float_mask(hn::Ne(gather(world.conductor.texture.data(), row), splat_u(no_index)));
  if (hn::AllFalse(FloatTag(), given)) return;
  for (size_t j = 0; j < 4; ++j) {
    optics.n[j] = hn::IfThenElse(given, splat(1.0f), optics.n[j]);
    optics.kappa[j] = hn::IfThenElse(given, kappa_of_reflectance(load(shade.reflectance[j], i)), optics.kappa[j]);
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

struct MetalLobe {
  ConductorOptics optics;
  GgxLobe lobe;
  HWY_INLINE void eval(const Vec3& wi, VF f_cos[4], VF& pdf) const { eval_conductor(lobe, optics, wi, f_cos, pdf); }
  HWY_INLINE BsdfSample sample(const Draw& draw) const { return sample_conductor(lobe, optics, draw.u, draw.v); }
};

void shade_rough_conductor_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  const ConductorColumns& table = world.conductor;
  shade_spreading(world, ShadeKind::rough_conductor, work, shade, shadow, [&](size_t i, const Vec3& wo) HWY_ATTR {
    const VI row = material_row(shade, i);
    MetalLobe metal;
    metal.optics = conductor_optics(world, shade, i, row);
    metal.lobe = make_ggx_lobe(wo, lane_alpha(world, table.alpha_x, table.alpha_texture[0], row, shade.alpha[0], i),
                               lane_alpha(world, table.alpha_y, table.alpha_texture[1], row, shade.alpha[1], i));
    return metal;
  });
}

void shade_smooth_conductor_kernel(const World& world, ShadeStream& shade) {
  shade_mirror(ShadeKind::smooth_conductor, shade, [&](size_t i, VF cos_theta, VF weight[4]) HWY_ATTR {
    conductor_reflectance(conductor_optics(world, shade, i, material_row(shade, i)), cos_theta, weight);
  });
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
