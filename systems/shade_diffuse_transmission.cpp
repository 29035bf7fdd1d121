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

struct SheetLobe {
  Vec3 wo;
  SheetOptics optics;
  HWY_INLINE void eval(const Vec3& wi, VF f_cos[4], VF& pdf) const { eval_sheet(wo, optics, wi, f_cos, pdf); }
  HWY_INLINE BsdfSample sample(const Draw& draw) const { return sample_sheet(wo, optics, draw.choice, draw.u, draw.v); }
};

void shade_diffuse_transmission_kernel(const World& world, const ShadeWork& work, ShadeStream& shade,
                                       ShadowStream& shadow) {
  shade_spreading(world, ShadeKind::diffuse_transmission, work, shade, shadow, [&](size_t i, const Vec3& wo) HWY_ATTR {
    return SheetLobe{wo, sheet_optics(world, shade, i)};
  });
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
