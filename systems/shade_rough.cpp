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

struct LobePair {
  RoughOptics optics;
  RoughLobe lobe;
  HWY_INLINE void eval(const Vec3& wi, VF f_cos[4], VF& pdf) const { eval_rough(lobe, optics, wi, f_cos, pdf); }
  HWY_INLINE BsdfSample sample(const Draw& draw) const {
    return sample_rough(lobe, optics, draw.choice, draw.u, draw.v);
  }
};

void shade_rough_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  shade_spreading(world, ShadeKind::rough, work, shade, shadow, [&](size_t i, const Vec3& wo) HWY_ATTR {
    LobePair pair;
    pair.optics = rough_optics(world, shade, i);
    pair.lobe = make_rough_lobe(wo, pair.optics);
    return pair;
  });
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
