#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_coated.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/coated-inl.h"
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

HWY_INLINE CoatOptics coat_optics(const World& world, const CoatedColumns& table, const ShadeStream& shade, size_t i,
                                  VI row) {
  const SpectrumView spectra = world.spectra.view();
  VF lambda_nm[4];
  load(shade.lambda_nm, i, lambda_nm);
  CoatOptics optics;
  lane_reflectance(world, table.reflectance, table.texture, row, shade, i, optics.albedo);
  eval_spectrum4(spectra, gather(table.eta.data(), row), lambda_nm, optics.eta);
  optics.schlick = float_mask(hn::Ne(gather(table.schlick.data(), row), splat_u(0)));
  optics.thickness = gather(table.thickness.data(), row);
  optics.hits = gather(table.hits.data(), row);
  optics.table = table.albedos.data();
  optics.rows = {as_index(gather(table.first_row.data(), row)), as_index(gather(table.row_stride.data(), row)),
                 as_index(gather(table.last_pair.data(), row)), gather(table.eta_least.data(), row),
                 gather(table.rows_per_eta.data(), row)};
  return optics;
}

struct SmoothCoatLobe {
  Vec3 wo;
  CoatOptics optics;
  CoatView view;
  HWY_INLINE void eval(const Vec3& wi, VF f_cos[4], VF& pdf) const {
    eval_smooth_coat(wo, view, optics, wi, f_cos, pdf);
  }
  // Lights that the mirror shows cannot be sampled.
  HWY_INLINE BsdfSample sample(const Draw& draw) const {
    CoatSample next = sample_smooth_coat(wo, view, optics, draw.choice, draw.u, draw.v);
    next.draw.pdf = hn::IfThenZeroElse(next.mirrored, next.draw.pdf);
    return next.draw;
  }
};

void shade_smooth_coated_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  shade_spreading(world, ShadeKind::smooth_coated, work, shade, shadow, [&](size_t i, const Vec3& wo) HWY_ATTR {
    SmoothCoatLobe lobe;
    lobe.wo = wo;
    lobe.optics = coat_optics(world, world.smooth_coated, shade, i, material_row(shade, i));
    lobe.view = make_smooth_coat_view(wo, lobe.optics);
    if (!work.draw_mirror) lobe.view.surface_share = hn::Zero(FloatTag());
    return lobe;
  });
}

void shade_coat_mirror_kernel(const World& world, ShadeStream& shade) {
  shade_mirror(ShadeKind::smooth_coated, shade, [&](size_t i, VF cos_theta, VF weight[4]) HWY_ATTR {
    coat_reflectance(coat_optics(world, world.smooth_coated, shade, i, material_row(shade, i)), cos_theta, weight);
  });
}

struct RoughCoatLobe {
  CoatOptics optics;
  GgxLobe surface;
  CoatView view;
  HWY_INLINE void eval(const Vec3& wi, VF f_cos[4], VF& pdf) const {
    eval_rough_coat(surface, view, optics, wi, f_cos, pdf);
  }
  HWY_INLINE BsdfSample sample(const Draw& draw) const {
    return sample_rough_coat(surface, view, optics, draw.choice, draw.u, draw.v);
  }
};

void shade_rough_coated_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  const auto& table = world.rough_coated;
  shade_spreading(world, ShadeKind::rough_coated, work, shade, shadow, [&](size_t i, const Vec3& wo) HWY_ATTR {
    const VI row = material_row(shade, i);
    RoughCoatLobe lobe;
    lobe.optics = coat_optics(world, table, shade, i, row);
    lobe.surface = make_ggx_lobe(wo, gather(table.alpha_x.data(), row), gather(table.alpha_y.data(), row));
    lobe.view = make_rough_coat_view(lobe.surface, lobe.optics);
    return lobe;
  });
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(shade_smooth_coated_kernel);
HWY_EXPORT(shade_coat_mirror_kernel);
HWY_EXPORT(shade_rough_coated_kernel);

void shade_smooth_coated(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(shade_smooth_coated_kernel)(world, work, shade, shadow);
}

void shade_coat_mirror(const World& world, ShadeStream& shade) {
  HWY_DYNAMIC_DISPATCH(shade_coat_mirror_kernel)(world, shade);
}

void shade_rough_coated(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(shade_rough_coated_kernel)(world, work, shade, shadow);
}

}  // namespace metamer
#endif
