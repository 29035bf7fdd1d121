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
  if (world.has_textures()) {
    const MF textured = float_mask(hn::Ne(gather(table.texture.data(), row), splat_u(no_index)));
    const VF factor = gather(table.absorption_of_log.data(), row);
    for (size_t j = 0; j < 4; ++j) {
      const VF root = hn::Mul(log(hn::Max(load(shade.reflectance[j], i), splat(1e-6f))), factor);
      o.sigma_a[j] = hn::IfThenElse(textured, hn::Mul(root, root), o.sigma_a[j]);
    }
  }
  o.variance = gather(table.variance.data(), row);
  o.width = gather(table.width.data(), row);
  for (size_t k = 0; k < 3; ++k) {
    o.sin_tilt[k] = gather(table.sin_tilt[k].data(), row);
    o.cos_tilt[k] = gather(table.cos_tilt[k].data(), row);
  }
  return o;
}

struct HairLobe {
  HairOptics optics;
  HairView view;
  HWY_INLINE void eval(const Vec3& wi, VF f_cos[4], VF& pdf) const { eval_hair(view, optics, wi, f_cos, pdf); }
  HWY_INLINE BsdfSample sample(const Draw& draw) const {
    return sample_hair(view, optics, draw.choice, draw.u, draw.v);
  }
};

void shade_hair_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  shade_spreading(world, ShadeKind::hair, work, shade, shadow, [&](size_t i, const Vec3& wo) HWY_ATTR {
    HairLobe lobe;
    lobe.optics = hair_optics(world, shade, i);
    lobe.view = make_hair_view(wo, lobe.optics);
    return lobe;
  });
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
