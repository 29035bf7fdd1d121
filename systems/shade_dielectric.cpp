#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_dielectric.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/dielectric-inl.h"
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

HWY_INLINE DielectricOptics dielectric_optics(const World& world, const ShadeStream& shade, size_t i, VI row) {
  VF lambda_nm[4];
  load(shade.lambda_nm, i, lambda_nm);
  DielectricOptics optics;
  eval_spectrum4(world.spectra.view(), gather(world.dielectric.eta.data(), row), lambda_nm, optics.eta);
  optics.schlick = float_mask(hn::Ne(gather(world.dielectric.schlick.data(), row), splat_u(0)));
  const MF disperses = float_mask(hn::Ne(gather(world.dielectric.dispersive.data(), row), splat_u(0)));
  // A path that has dispersed already carries its hero only.
  const VF companions =
      hn::Max(hn::Max(load(shade.throughput[1], i), load(shade.throughput[2], i)), load(shade.throughput[3], i));
  optics.dispersive = hn::And(disperses, hn::Gt(companions, hn::Zero(FloatTag())));
  return optics;
}

void shade_dielectric_kernel(const World& world, uint32_t depth, Branch branch, ShadeStream& shade) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const VF hero_weight = splat(static_cast<float>(live_wavelengths(world.settings)));
  const Group& group = group_of(shade, ShadeKind::dielectric);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    DielectricOptics optics = dielectric_optics(world, shade, i, material_row(shade, i));
    const MF disperses = optics.dispersive;
    if (branch >= Branch::refracted) {  // each wavelength that goes alone is its own hero
      optics.eta[0] = optics.eta[leading_wavelength(branch)];
      optics.dispersive = hn::Lt(one, zero);
    }
    const Frame frame = shading_frame(world, shade, i);
    const Vec3 wo = to_local(frame, load(shade.wo, i));
    const VF u = branch_number(shade, i, depth, branch);
    DielectricSample next = sample_dielectric(wo, optics, u);
    // Drawn, the hero stands for all wavelengths that accumulate sums.
    const MF stands_alone = branch == Branch::drawn ? next.terminate_secondary : hn::Lt(one, zero);
    next.weight[0] = hn::IfThenElse(stands_alone, hn::Mul(next.weight[0], hero_weight), next.weight[0]);
    keep_branch(branch, disperses, next.transmitted, next.probability, next.weight);
    store_next(frame, next.wi, next.weight, zero, shade, i);
    const VF eta = hn::IfThenElse(hn::Lt(wo.z, zero), hn::Div(one, optics.eta[0]), optics.eta[0]);
    store(hn::IfThenElse(next.transmitted, hn::Mul(eta, eta), one), shade.next_eta_scale, i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(shade_dielectric_kernel);

void shade_dielectric(const World& world, uint32_t depth, Branch branch, ShadeStream& shade) {
  HWY_DYNAMIC_DISPATCH(shade_dielectric_kernel)(world, depth, branch, shade);
}

}  // namespace metamer
#endif
