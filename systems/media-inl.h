// What a path is inside of. Nested dielectrics by priority: Schmidt & Budge, "Simple Nested Dielectrics in Ray Traced
// Images", Journal of Graphics Tools 7(2), 2002. A path remembers up to four media, highest priority first, the later
// entered first where priorities are equal; the first fills the space. A boundary counts when it is the first medium
// that begins or ends there; else the ray passes as if it were not there.
#if defined(METAMER_SYSTEMS_MEDIA_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_MEDIA_INL_H_
#undef METAMER_SYSTEMS_MEDIA_INL_H_
#else
#define METAMER_SYSTEMS_MEDIA_INL_H_
#endif

#include "engine/simd/math-inl.h"
#include "engine/spectrum/spectrum-inl.h"
#include "systems/lanes-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// Rows of World::media; 0 behind the last. Entry 0 is what fills the space.
struct MediaStack {
  VU entry[media_stack_size];
};

HWY_INLINE MediaStack unpack_media(VU low, VU high) {
  const VU mask = splat_u(largest_medium);
  return {{hn::And(low, mask), hn::ShiftRight<16>(low), hn::And(high, mask), hn::ShiftRight<16>(high)}};
}
HWY_INLINE MediaStack load_media(const Columns<uint32_t, 2>& columns, size_t i) {
  return unpack_media(load(columns[0], i), load(columns[1], i));
}
HWY_INLINE void store_media(const MediaStack& stack, const Columns<uint32_t, 2>& columns, size_t i) {
  store(hn::Or(stack.entry[0], hn::ShiftLeft<16>(stack.entry[1])), columns[0], i);
  store(hn::Or(stack.entry[2], hn::ShiftLeft<16>(stack.entry[3])), columns[1], i);
}
HWY_INLINE MediaStack if_then_else(MF mask, const MediaStack& yes, const MediaStack& no) {
  MediaStack stack;
  for (size_t k = 0; k < media_stack_size; ++k)
    stack.entry[k] = hn::IfThenElse(uint_mask(mask), yes.entry[k], no.entry[k]);
  return stack;
}

HWY_INLINE VI medium_priority(const World& world, VU medium) {
  return as_index(gather(world.media.priority.data(), as_index(medium)));
}
HWY_INLINE MF is_same(VU a, VU b) { return float_mask(hn::Eq(a, b)); }
HWY_INLINE MF is_medium(VU a) { return float_mask(hn::Ne(a, splat_u(0))); }

// With `medium` (not 0) put behind all of higher priority and, if it is the oldest, behind all of equal priority. Where
// the stack is full the last entry is lost.
HWY_INLINE MediaStack with_medium(const World& world, const MediaStack& stack, VU medium, bool is_oldest) {
  const VI own = medium_priority(world, medium);
  const VI threshold = is_oldest ? hn::Sub(own, hn::Set(IntTag(), 1)) : own;
  MediaStack result;
  auto placed = hn::Lt(threshold, threshold);  // false
  for (size_t k = 0; k < media_stack_size; ++k) {
    const auto stays = hn::Lt(threshold, medium_priority(world, stack.entry[k]));
    const auto stays_u = hn::RebindMask(UintTag(), stays), placed_u = hn::RebindMask(UintTag(), placed);
    const VU moved = k == 0 ? medium : hn::IfThenElse(placed_u, stack.entry[k == 0 ? 0 : k - 1], medium);
    result.entry[k] = hn::IfThenElse(stays_u, stack.entry[k], moved);
    placed = hn::Not(stays);
  }
  return result;
}

// Without the first entry that is `medium`, if there is one.
HWY_INLINE MediaStack without_medium(const MediaStack& stack, VU medium) {
  MediaStack result;
  auto found = hn::Ne(medium, medium);  // false
  for (size_t k = 0; k < media_stack_size; ++k) {
    found = hn::Or(found, hn::Eq(stack.entry[k], medium));
    const VU behind = k + 1 < media_stack_size ? stack.entry[k + 1] : splat_u(0);
    result.entry[k] = hn::IfThenElse(found, behind, stack.entry[k]);
  }
  return result;
}
HWY_INLINE MF has_medium(const MediaStack& stack, VU medium) {
  MF has = is_same(stack.entry[0], medium);
  for (size_t k = 1; k < media_stack_size; ++k) has = hn::Or(has, is_same(stack.entry[k], medium));
  return has;
}

// sigma_a = 4 pi kappa / lambda, per metre. DESIGN.md, section 1.
HWY_INLINE VF absorption(VF kappa, VF lambda_nm) {
  return hn::Mul(hn::Div(kappa, lambda_nm), splat(static_cast<float>(4e9 * 3.14159265358979323846)));
}

// What a medium lets through over a distance in metres, exp(-sigma_a distance), on four wavelengths: 1 where
// nothing absorbs, however far, and 0 over an infinite distance where something does. Relative error 1e-6 (1 + x) for
// an exponent x.
HWY_INLINE void medium_transmittance(const World& world, VU medium, const VF lambda_nm[4], VF distance, VF out[4]) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  for (int j = 0; j < 4; ++j) out[j] = one;
  if (hn::AllFalse(FloatTag(), is_medium(medium))) return;
  VF kappa[4];
  eval_spectrum4(world.spectra.view(), gather(world.media.kappa.data(), as_index(medium)), lambda_nm, kappa);
  for (int j = 0; j < 4; ++j) {
    const VF depth = hn::Mul(absorption(kappa[j], lambda_nm[j]), distance);
    out[j] = hn::IfThenElse(hn::Gt(kappa[j], zero), exp(hn::Neg(depth)), one);
  }
}

// A followed boundary between media, seen from the ray that came.
struct MediaCrossing {
  VU outside;                // what fills the space on the other side of the material's own
  MF followed;               // the material has a medium
  MF inside;                 // the ray came from inside; by the geometric normal, as rays start on a side of it
  MF real;                   // the material's medium is the first that begins or ends there
  MF passed;                 // a boundary without optical effect
  MediaStack before, after;  // of the ray that came, and behind the boundary
};

HWY_INLINE MediaCrossing media_crossing(const World& world, const ShadeStream& shade, size_t i, VU medium) {
  MediaCrossing crossing;
  crossing.followed = is_medium(medium);
  crossing.inside = hn::Lt(dot(load(shade.wo, i), load(shade.normal, i)), hn::Zero(FloatTag()));
  crossing.before = load_media(shade.media, i);
  const MediaStack left = without_medium(crossing.before, medium);
  const MediaStack entered = with_medium(world, crossing.before, medium, false);
  crossing.after = if_then_else(crossing.inside, left, entered);
  const VU top = crossing.before.entry[0];
  crossing.outside = hn::IfThenElse(uint_mask(crossing.inside), left.entry[0], top);
  const MF ends = is_same(top, medium), begins = is_same(entered.entry[0], medium);
  crossing.real = hn::Or(hn::And(crossing.inside, ends), hn::AndNot(crossing.inside, begins));
  const MF changes = hn::AndNot(is_same(crossing.outside, medium), crossing.real);
  crossing.passed = hn::AndNot(changes, crossing.followed);
  return crossing;
}

// The media of the next ray: those behind the boundary where `direction` (world) goes to its other side.
HWY_INLINE void store_next_media(const MediaCrossing& crossing, const Vec3& direction, ShadeStream& shade, size_t i) {
  const VF zero = hn::Zero(FloatTag());
  const VF along = dot(direction, load(shade.normal, i));
  const MF goes_out = hn::Gt(along, zero);
  const MF crosses = hn::And(
      crossing.followed, hn::Or(hn::And(crossing.inside, goes_out), hn::AndNot(crossing.inside, hn::Lt(along, zero))));
  store_media(if_then_else(crosses, crossing.after, crossing.before), shade.next_media, i);
  const MF full = hn::AndNot(crossing.inside, hn::And(crosses, is_medium(crossing.before.entry[media_stack_size - 1])));
  if (hn::AllFalse(FloatTag(), full)) return;
  VF weight[4];
  load(shade.next_weight, i, weight);
  const MF goes_on = hn::And(is_live(load(shade.slot, i)), hn::Gt(max_of(weight), zero));
  shade.lost_media += static_cast<uint32_t>(hn::CountTrue(FloatTag(), hn::And(full, goes_on)));
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
