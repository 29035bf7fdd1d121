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

// What fills the sides of followed boundaries, by priority: behind one that does not count what was there before; else
// inside the medium of that side, outside that of the solid that begins there, or where that has none the medium of
// that side. A solid without a medium displaces what the solid around it is filled with.
void fill_sides(const World& world, const Group& group, ShadeStream& shade) {
  const VU keeps = splat_u(keeps_volume);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const auto live = hn::Ne(load(shade.slot, i), splat_u(dead_lane));
    const VI row = as_index(hn::IfThenElseZero(live, load(shade.material, i)));
    const MediaCrossing crossing = media_crossing(world, shade, i, gather(world.dielectric.medium.data(), row));
    if (hn::AllFalse(FloatTag(), crossing.followed)) continue;
    const VU before = load(shade.volume, i), inside = load(shade.volumes[0], i), outside = load(shade.volumes[1], i);
    const VU left = gather(world.media.volume.data(), as_index(crossing.before.entry[0]));
    const VU around = gather(world.media.volume.data(), as_index(crossing.outside));
    const MF has_sides = hn::Not(is_same(inside, outside));
    const MF displaces = hn::AndNot(hn::Or(crossing.inside, has_sides), hn::Not(is_same(left, keeps)));
    const VU sides[2] = {hn::IfThenZeroElse(uint_mask(displaces), inside),
                         hn::IfThenElse(uint_mask(is_same(around, keeps)), outside, around)};
    for (size_t k = 0; k < 2; ++k) {
      const VU real = hn::IfThenElse(uint_mask(crossing.real), sides[k], before);
      store(hn::IfThenElse(uint_mask(crossing.followed), real, k == 0 ? inside : outside), shade.volumes[k], i);
    }
  }
}

void media_kernel(const World& world, ShadeStream& shade) {
  for (const ShadeKind kind : {ShadeKind::rough_dielectric, ShadeKind::dielectric}) {
    const Group& group = shade.groups[static_cast<size_t>(kind)];
    remember_unseen(world, group, shade);
    if (shade.carries_volumes) fill_sides(world, group, shade);
  }
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
