#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_dielectric.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/dielectric_optics-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

void shade_dielectric_kernel(const World& world, uint32_t depth, Branch branch, ShadeStream& shade) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const Group& group = group_of(shade, ShadeKind::dielectric);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    MediaCrossing crossing;
    DielectricOptics optics = dielectric_optics(world, shade, i, material_row(shade, i), crossing);
    const MF disperses = optics.dispersive;
    if (branch >= Branch::refracted) {  // each wavelength that goes alone is its own hero
      const size_t lead = leading_wavelength(branch);
      optics.eta[0] = optics.eta[lead];
      optics.dispersive = hn::Lt(one, zero);
      if (optics.some_opaque) {
        optics.kappa[0] = optics.kappa[lead];
        optics.opaque[0] = optics.opaque[lead];
      }
    }
    const Frame frame = boundary_frame(world, shade, i);
    const Vec3 wo = to_local(frame, load(shade.wo, i));
    const VF u = branch_number(shade, i, depth, branch);
    DielectricSample next = sample_dielectric(wo, optics, u);
    const MF stands_alone = branch == Branch::drawn ? next.terminate_secondary : hn::Lt(one, zero);
    next.weight[0] =
        hn::IfThenElse(stands_alone, hn::Mul(next.weight[0], lone_weight(world, shade, i)), next.weight[0]);
    store_lone_share(world, stands_alone, shade, i);
    keep_branch(branch, disperses, next.transmitted, next.probability, next.weight);
    store_next(frame, next.wi, next.weight, zero, shade, i);
    if (world.has_interiors) store_next_media(crossing, load(shade.next_direction, i), shade, i);
    store(refraction_scale(optics, hn::Lt(wo.z, zero), next.transmitted), shade.next_eta_scale, i);
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
