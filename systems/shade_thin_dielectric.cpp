#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_thin_dielectric.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/thin-inl.h"
#include "systems/dielectric_optics-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

HWY_INLINE ThinOptics thin_optics(const World& world, const ShadeStream& shade, size_t i, VI row) {
  const SpectrumView spectra = world.spectra.view();
  const DielectricColumns& table = world.dielectric;
  VF lambda_nm[4];
  load(shade.lambda_nm, i, lambda_nm);
  ThinOptics optics;
  eval_spectrum4(spectra, gather(table.eta.data(), row), lambda_nm, optics.eta);
  eval_spectrum4(spectra, gather(table.kappa.data(), row), lambda_nm, optics.kappa);
  const VF thickness = gather(table.thickness.data(), row);
  for (int j = 0; j < 4; ++j) {
    optics.opaque[j] = hn::Ge(optics.kappa[j], splat(refracting_kappa));
    optics.optical_depth[j] = hn::Mul(absorption(optics.kappa[j], lambda_nm[j]), thickness);
  }
  if (world.has_interiors) {
    const MF absolute = is_set(table.is_absolute, row);
    const VU around = hn::IfThenElseZero(uint_mask(absolute), load_media(shade.media, i).entry[0]);
    make_relative(world, around, lambda_nm, optics.eta);
    make_relative(world, around, lambda_nm, optics.kappa);
  }
  optics.schlick = is_set(table.schlick, row);
  optics.companions = has_companions(shade, i);
  return optics;
}

void shade_thin_dielectric_kernel(const World& world, uint32_t depth, Branch branch, ShadeStream& shade) {
  const Group& group = group_of(shade, ShadeKind::thin_dielectric);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const ThinOptics optics = thin_optics(world, shade, i, material_row(shade, i));
    const Vec3 wo = load(shade.wo, i), normal = load(shade.shading_normal, i);
    ThinSample next = sample_thin(hn::Abs(dot(wo, normal)), optics, branch_number(shade, i, depth, branch));
    keep_branch(branch, hn::Lt(wo.x, wo.x), next.transmitted, next.probability, next.weight);
    store_delta(if_then_else(next.transmitted, -wo, reflect(-wo, normal)), next.weight, shade, i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(shade_thin_dielectric_kernel);

void shade_thin_dielectric(const World& world, uint32_t depth, Branch branch, ShadeStream& shade) {
  HWY_DYNAMIC_DISPATCH(shade_thin_dielectric_kernel)(world, depth, branch, shade);
}

}  // namespace metamer
#endif
