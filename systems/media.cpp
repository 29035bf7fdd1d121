#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/media.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/media-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// A ray that comes out of something it never went into started inside of it: under an open water surface, say.
void remember_unseen(const World& world, const Group& group, ShadeStream& shade) {
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const auto live = hn::Ne(load(shade.slot, i), splat_u(dead_lane));
    const VI row = as_index(hn::IfThenElseZero(live, load(shade.material, i)));
    const VU medium = gather(world.dielectric.medium.data(), row);
    const MF inside = hn::Lt(dot(load(shade.wo, i), load(shade.normal, i)), hn::Zero(FloatTag()));
    const MediaStack stack = load_media(shade.media, i);
    const MF unseen = hn::AndNot(has_medium(stack, medium), hn::And(inside, is_medium(medium)));
    if (hn::AllFalse(FloatTag(), unseen)) continue;
    const MediaStack corrected = with_medium(world, stack, medium, true);
    store_media(if_then_else(unseen, corrected, stack), shade.media, i);
  }
}

void media_kernel(const World& world, ShadeStream& shade) {
  for (const ShadeKind kind : {ShadeKind::rough_dielectric, ShadeKind::dielectric})
    remember_unseen(world, shade.groups[static_cast<size_t>(kind)], shade);
  const size_t miss_begin = shade.groups[static_cast<size_t>(ShadeKind::miss)].begin;
  for (size_t i = 0; i < shade.size; i += lane_count()) {
    for (size_t k = 0; k < 2; ++k) store(load(shade.media[k], i), shade.next_media[k], i);
    VF lambda_nm[4], passes[4];
    load(shade.lambda_nm, i, lambda_nm);
    const VF distance = i < miss_begin ? load(shade.distance, i) : hn::Inf(FloatTag());
    medium_transmittance(world, load_media(shade.media, i).entry[0], lambda_nm, distance, passes);
    for (size_t j = 0; j < 4; ++j) store(hn::Mul(load(shade.throughput[j], i), passes[j]), shade.throughput[j], i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(media_kernel);

void media(const World& world, ShadeStream& shade) { HWY_DYNAMIC_DISPATCH(media_kernel)(world, shade); }

}  // namespace metamer
#endif
