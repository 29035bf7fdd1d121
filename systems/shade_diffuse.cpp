#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_diffuse.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/diffuse-inl.h"
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

struct DiffuseLobe {
  Vec3 wo;
  VF albedo[4];
  HWY_INLINE void eval(const Vec3& wi, VF f_cos[4], VF& pdf) const { eval_diffuse(wo, albedo, wi, f_cos, pdf); }
  HWY_INLINE BsdfSample sample(const Draw& draw) const { return sample_diffuse(wo, albedo, draw.u, draw.v); }
};

void shade_diffuse_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  shade_spreading(world, ShadeKind::diffuse, work, shade, shadow, [&](size_t i, const Vec3& wo) HWY_ATTR {
    DiffuseLobe lobe;
    lobe.wo = wo;
    lane_reflectance(world, world.diffuse.reflectance, world.diffuse.texture, material_row(shade, i), shade, i,
                     lobe.albedo);
    return lobe;
  });
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
