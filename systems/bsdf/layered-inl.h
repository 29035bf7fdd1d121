// pbrt-v4's coat in all its forms, four wavelengths at a time: a dielectric surface, smooth or rough, over a layer that
// absorbs or scatters, over a base that is diffuse or a conductor. Where there is no closed form (coat_layer.h,
// layered_mirror below) light is followed at random through the layer, as in pbrt (LayeredBxDF; Pharr, Jakob,
// Humphreys, Physically Based Rendering, 4th edition, section 14.3). Directions are unit vectors in the local shading
// frame and point away from the surface; both sides are alike. Double twin: tests/systems/support/layered_walk.h.
//
// eval_layered is an estimate whose mean is f_cos, by walks from wo that look for wi at every scattering, along two
// ways through the surface: one drawn from wi, and the walk's own next direction, weighed by the power heuristic. (pbrt
// weighs the latter with the pdf of the opposite direction, and its two weights do not sum to 1: it is brighter by some
// per cent where the surface is rough.) sample_layered follows one walk until it leaves; its weight is that of the
// walk, so that f_cos = the mean over walks, while the density of directions has no closed form. layered_pdf stands in
// for it in multiple importance sampling, which is unbiased with any function of wo and wi that both strategies use.
//
// Random numbers are hashes of a seed and a count: every lane takes the same number of them at every step, so that no
// lane depends on others.
#if defined(METAMER_SYSTEMS_BSDF_LAYERED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_LAYERED_INL_H_
#undef METAMER_SYSTEMS_BSDF_LAYERED_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_LAYERED_INL_H_
#endif

#include "engine/sampling/hash-inl.h"
#include "engine/sampling/warps-inl.h"
#include "systems/bsdf/layer_steps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// What eval and sample share about one viewing direction, which is on the upper side.
struct LayeredView {
  Vec3 wo;
  VF side;  // the sign bit of the caller's wo.z
  GgxLobe surface;
  VF mirror[4];      // the delta lobe: 0 where the surface is rough
  VF surface_share;  // the chance that a sample is the surface's reflection, or the delta lobe
  GgxLobe inner;     // what layered_pdf takes a conductor's light to be spread over
};

namespace bsdf_detail {

struct WalkRandom {
  VU seed;
  uint32_t count = 0;
  HWY_INLINE VF next() { return unit_float(hash_u32(hn::Xor(seed, splat_u(++count * 0x9e3779b9u)))); }
};

// Everything about a walk that goes on.
struct Walk {
  Vec3 w;
  VF z;  // above the base
  VF beta[4];
  MF alive;
};

// Where the walk is next: within the layer, at its surface from below, or at the base.
struct WalkPlace {
  MF within, at_surface, at_base;
};
HWY_INLINE WalkPlace advance(const LayeredOptics& o, Walk& walk, WalkRandom& random) {
  const VF zero = hn::Zero(FloatTag());
  const MF up = hn::Gt(walk.w.z, zero);
  const VF u = random.next();
  WalkPlace place;
  place.within = hn::Lt(zero, zero);
  if (!hn::AllFalse(FloatTag(), o.scatters)) {
    const VF z = hn::NegMulAdd(log(hn::Sub(splat(1.0f), u)), walk.w.z, walk.z);
    place.within = hn::And(hn::And(walk.alive, o.scatters), hn::And(hn::Gt(z, zero), hn::Lt(z, o.thickness)));
    walk.z = hn::IfThenElse(place.within, z, walk.z);
  }
  const VF passes = hn::IfThenElse(o.scatters, splat(1.0f), layer_transmittance(o.thickness, walk.w.z));
  for (VF& beta : walk.beta) beta = hn::Mul(beta, passes);
  walk.z = hn::IfThenElse(place.within, walk.z, hn::IfThenElseZero(up, o.thickness));
  const MF arrives = hn::AndNot(place.within, walk.alive);
  place.at_surface = hn::And(arrives, up);
  place.at_base = hn::AndNot(up, arrives);
  return place;
}

// Ends walks that carry little, without bias: pbrt's rule.
HWY_INLINE void end_weak_walks(uint32_t depth, Walk& walk, WalkRandom& random) {
  const VF u = random.next(), one = splat(1.0f);
  if (depth <= 3) return;
  const VF most = hn::Max(hn::Max(walk.beta[0], walk.beta[1]), hn::Max(walk.beta[2], walk.beta[3]));
  const MF weak = hn::Lt(most, splat(0.25f));
  walk.alive = hn::AndNot(hn::And(weak, hn::Ge(u, most)), walk.alive);
  const VF factor = hn::IfThenElse(weak, hn::Div(one, hn::Max(most, splat(FLT_MIN))), one);
  for (VF& beta : walk.beta) beta = hn::Mul(beta, factor);
}

HWY_INLINE void carry_on(MF where, const Vec3& w, const VF weight[4], Walk& walk) {
  walk.w = if_then_else(where, w, walk.w);
  VF most = hn::Zero(FloatTag());
  for (int j = 0; j < 4; ++j) {
    walk.beta[j] = hn::IfThenElse(where, hn::Mul(walk.beta[j], weight[j]), walk.beta[j]);
    most = hn::Max(most, walk.beta[j]);
  }
  walk.alive = hn::And(walk.alive, hn::Gt(most, hn::Zero(FloatTag())));
}

// The way out that was drawn from wi: its direction inside, pointing away from the surface, and f / pdf.
struct WayOut {
  GgxLobe lobe;  // of wi
  LayerStep step;
  VF f, pdf;
};

// What scatters towards the way out, in the layer or at the base.
HWY_INLINE void look_for_light(const LayeredOptics& o, const WalkPlace& place, const Walk& walk, const WayOut& out,
                               VF f[4]) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const MF looks = hn::Or(place.within, place.at_base);
  VF value[4], pdf = zero;
  for (VF& v : value) v = zero;
  if (!hn::AllFalse(FloatTag(), place.at_base)) eval_base(o, -walk.w, -out.step.w, value, pdf);
  if (!hn::AllFalse(FloatTag(), place.within)) {
    const VF p = phase(o.asymmetry, hn::Neg(dot(walk.w, out.step.w)));
    pdf = hn::IfThenElse(place.within, p, pdf);
    for (int j = 0; j < 4; ++j) value[j] = hn::IfThenElse(place.within, hn::Mul(o.albedo[j], p), value[j]);
  }
  const VF share = hn::IfThenElse(o.smooth_surface, one, power_share(out.pdf, pdf));
  const VF passes = layer_transmittance(hn::Sub(o.thickness, walk.z), out.step.w.z);
  const VF factor = hn::IfThenElseZero(looks, hn::Mul(hn::Mul(share, passes), out.f));
  for (int j = 0; j < 4; ++j) f[j] = hn::MulAdd(hn::Mul(walk.beta[j], value[j]), factor, f[j]);
}

// What the walk's next direction brings towards wi through a rough surface.
HWY_INLINE void leave_towards(const LayeredOptics& o, MF where, const Walk& walk, VF pdf, MF delta, const WayOut& out,
                              VF f[4]) {
  const MF leaves = hn::AndNot(o.smooth_surface, hn::And(where, hn::Gt(walk.w.z, hn::Zero(FloatTag()))));
  if (hn::AllFalse(FloatTag(), leaves)) return;
  const CrossValue exit = eval_crossing(o, out.lobe, -walk.w);
  const VF share = hn::IfThenElse(delta, splat(1.0f), power_share(pdf, exit.pdf));
  const VF passes = layer_transmittance(hn::Sub(o.thickness, walk.z), walk.w.z);
  const VF factor = hn::IfThenElseZero(leaves, hn::Mul(hn::Mul(share, passes), exit.f));
  for (int j = 0; j < 4; ++j) f[j] = hn::MulAdd(walk.beta[j], factor, f[j]);
}

// One direction further; pdf and whether it is a delta lobe are those of scatterings in the layer and at the base.
HWY_INLINE void scatter(const LayeredOptics& o, const WalkPlace& place, Walk& walk, WalkRandom& random, VF& pdf,
                        MF& delta) {
  const VF u = random.next(), v = random.next();
  VF weight[4];
  Vec3 w = walk.w;
  for (VF& x : weight) x = splat(1.0f);
  pdf = hn::Zero(FloatTag());
  delta = hn::And(place.at_base, o.smooth_base);
  if (!hn::AllFalse(FloatTag(), place.at_base)) {
    const BsdfSample next = sample_base(o, -walk.w, u, v);
    w = if_then_else(place.at_base, next.wi, w);
    pdf = next.pdf;
    for (int j = 0; j < 4; ++j) weight[j] = hn::IfThenElse(place.at_base, next.weight[j], weight[j]);
  }
  if (!hn::AllFalse(FloatTag(), place.within)) {
    const Vec3 next = sample_phase(o.asymmetry, walk.w, u, v);
    pdf = hn::IfThenElse(place.within, phase(o.asymmetry, dot(walk.w, next)), pdf);
    w = if_then_else(place.within, next, w);
    for (int j = 0; j < 4; ++j) weight[j] = hn::IfThenElse(place.within, o.albedo[j], weight[j]);
  }
  carry_on(hn::Or(place.within, place.at_base), w, weight, walk);
}

HWY_INLINE Walk enter(const LayeredOptics& o, const GgxLobe& lobe, WalkRandom& random) {
  const VF u = random.next(), v = random.next();
  const LayerStep in = facet_steps(o, lobe, u, v).through;
  Walk walk;
  walk.w = in.w;
  walk.z = o.thickness;
  for (VF& beta : walk.beta) beta = in.weight;
  walk.alive = hn::Gt(in.weight, hn::Zero(FloatTag()));
  return walk;
}

HWY_INLINE uint32_t most_in_lanes(VF x) { return static_cast<uint32_t>(hn::GetLane(hn::MaxOfLanes(FloatTag(), x))); }

// Adds an estimate of f, without what the surface reflects at once. wo and wi on the upper side.
HWY_INLINE void add_walk(const LayeredOptics& o, const LayeredView& view, const Vec3& wi, MF counts, WalkRandom& random,
                         VF f[4]) {
  const VF u = random.next(), v = random.next();
  WayOut out;
  out.lobe = make_ggx_lobe(wi, o.alpha_x, o.alpha_y);
  out.step = facet_steps(o, out.lobe, u, v).through;
  out.pdf = eval_crossing(o, out.lobe, out.step.w).pdf;
  out.f = hn::Div(out.step.weight, hn::Max(hn::Abs(out.step.w.z), splat(1e-20f)));
  Walk walk = enter(o, view.surface, random);
  // The radiance outside is less by eta^2.
  const VF outside = hn::Div(splat(1.0f), hn::Mul(o.eta, o.eta));
  for (VF& beta : walk.beta) beta = hn::Mul(beta, outside);
  walk.alive = hn::And(counts, hn::And(walk.alive, hn::Gt(out.step.weight, hn::Zero(FloatTag()))));
  const uint32_t most = most_in_lanes(hn::IfThenElseZero(walk.alive, o.max_depth));
  for (uint32_t depth = 0; depth < most; ++depth) {
    walk.alive = hn::And(walk.alive, hn::Lt(splat(static_cast<float>(depth)), o.max_depth));
    end_weak_walks(depth, walk, random);
    if (hn::AllFalse(FloatTag(), walk.alive)) return;
    const WalkPlace place = advance(o, walk, random);
    look_for_light(o, place, walk, out, f);
    VF pdf;
    MF delta;
    const MF leaving = hn::Or(place.within, place.at_base);
    scatter(o, place, walk, random, pdf, delta);
    leave_towards(o, hn::And(leaving, walk.alive), walk, pdf, delta, out, f);
    const VF u_facet = random.next(), v_facet = random.next();
    if (hn::AllFalse(FloatTag(), place.at_surface)) continue;
    const LayerStep back = facet_steps(o, make_ggx_lobe(-walk.w, o.alpha_x, o.alpha_y), u_facet, v_facet).back;
    const VF weight[4] = {back.weight, back.weight, back.weight, back.weight};
    carry_on(place.at_surface, back.w, weight, walk);
  }
}

}  // namespace bsdf_detail

// `draw_mirror`: else the delta lobe is somebody else's, and samples never are of it.
HWY_INLINE LayeredView make_layered_view(const Vec3& wo, const LayeredOptics& o, bool draw_mirror) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = splat(1.0f), quarter = splat(0.25f);
  LayeredView view;
  view.wo = {wo.x, wo.y, hn::Abs(wo.z)};
  view.side = sign_bit(wo.z);
  view.surface = make_ggx_lobe(view.wo, o.alpha_x, o.alpha_y);
  layered_mirror(o, view.wo.z, view.mirror);
  const VF f = fresnel_dielectric(o.eta, hn::Div(one, o.eta), view.wo.z).reflectance;
  VF surface = zero, base = zero;
  VF metal[4];
  conductor_reflectance(o.metal, splat(0.8f), metal);
  for (int j = 0; j < 4; ++j) {
    surface = hn::MulAdd(quarter, hn::IfThenElse(o.smooth_surface, view.mirror[j], f), surface);
    const VF of_base = hn::IfThenElse(o.conductor, metal[j], hn::Mul(splat(0.6f), o.reflectance[j]));
    base = hn::MulAdd(quarter, hn::Max(of_base, hn::IfThenElseZero(o.scatters, o.albedo[j])), base);
  }
  // Nothing but the delta lobe is there.
  const MF all_delta = hn::AndNot(o.scatters, hn::And(o.smooth_surface, o.smooth_base));
  const VF inner = hn::IfThenZeroElse(all_delta, hn::Max(hn::Mul(hn::Sub(one, f), base), splat(1e-3f)));
  view.surface_share = hn::Div(surface, hn::Max(hn::Add(surface, inner), splat(FLT_MIN)));
  if (!draw_mirror) view.surface_share = hn::IfThenZeroElse(o.smooth_surface, view.surface_share);
  // Slopes of the base count eta-fold outside, those of the surface by what refraction bends, on both ways.
  const VF bend = hn::Mul(splat(0.7f), hn::Sub(o.eta, one));
  const auto width = [&](VF base_alpha, VF alpha) {
    const VF x = hn::Mul(o.eta, base_alpha), y = hn::Mul(bend, alpha);
    return clamp(hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y))), 0.01f, 1.0f);
  };
  view.inner = make_ggx_lobe(view.wo, width(o.base_alpha_x, o.alpha_x), width(o.base_alpha_y, o.alpha_y));
  return view;
}

// The function that stands in for the density of sample_layered; wi on the upper side.
HWY_INLINE VF layered_pdf(const LayeredOptics& o, const LayeredView& view, const Vec3& wi, VF surface_pdf) {
  const VF one = splat(1.0f), even = hn::Mul(hn::Max(wi.z, hn::Zero(FloatTag())), splat(inverse_pi));
  const VF lobe = eval_ggx_reflection(view.inner, wi).pdf;
  const VF metal = hn::MulAdd(splat(0.8f), lobe, hn::Mul(splat(0.2f), even));
  const VF inner = hn::IfThenElse(o.conductor, metal, even);
  return hn::MulAdd(view.surface_share, surface_pdf, hn::Mul(hn::Sub(one, view.surface_share), inner));
}

// An estimate of f_cos, and layered_pdf. `seed` of each lane: another estimate. The delta lobe has no part in it.
HWY_INLINE void eval_layered(const LayeredView& view, const LayeredOptics& o, const Vec3& wi, VU seed, VF f_cos[4],
                             VF& pdf) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const Vec3 up = {wi.x, wi.y, flip_sign(wi.z, view.side)};
  const MF counts = hn::Gt(hn::Min(up.z, view.wo.z), zero);
  const GgxReflection surface = eval_ggx_reflection(view.surface, up);
  const VF reflectance = fresnel_dielectric(o.eta, hn::Div(one, o.eta), surface.cos_theta_d).reflectance;
  VF f[4] = {zero, zero, zero, zero};
  bsdf_detail::WalkRandom random{seed};
  const uint32_t most = bsdf_detail::most_in_lanes(hn::IfThenElseZero(counts, o.walks));
  for (uint32_t walk = 0; walk < most; ++walk) {
    const MF walks = hn::And(counts, hn::Lt(splat(static_cast<float>(walk)), o.walks));
    random.count = walk << 20;
    bsdf_detail::add_walk(o, view, up, walks, random, f);
  }
  const VF factor = hn::Div(up.z, hn::Max(o.walks, one));
  for (int j = 0; j < 4; ++j)
    f_cos[j] = hn::IfThenElseZero(counts, hn::MulAdd(f[j], factor, hn::Mul(reflectance, surface.f_cos)));
  pdf = hn::IfThenElseZero(counts, layered_pdf(o, view, up, surface.pdf));
}

// Draws wi: `choice` in [0, 1) takes the surface or a walk, u and v the facet of a rough surface. The pdf is
// layered_pdf, 0 for the delta lobe. Walks that never leave, or leave along the delta lobe, have weight 0.
HWY_INLINE BsdfSample sample_layered(const LayeredView& view, const LayeredOptics& o, VF choice, VF u, VF v, VU seed) {
  using bsdf_detail::Walk;
  using bsdf_detail::WalkPlace;
  const FloatTag d;
  const VF zero = hn::Zero(d), one = splat(1.0f);
  const MF by_surface = hn::Lt(choice, view.surface_share);
  bsdf_detail::WalkRandom random{seed};
  Walk walk = bsdf_detail::enter(o, view.surface, random);
  const VF inner_scale = hn::Div(one, hn::Max(hn::Sub(one, view.surface_share), splat(FLT_MIN)));
  walk.alive = hn::AndNot(by_surface, walk.alive);
  MF specular = o.smooth_surface;
  Vec3 wi = {zero, zero, one};
  VF weight[4] = {zero, zero, zero, zero};
  const uint32_t most = bsdf_detail::most_in_lanes(hn::IfThenElseZero(walk.alive, o.max_depth));
  for (uint32_t depth = 0; depth < most; ++depth) {
    walk.alive = hn::And(walk.alive, hn::Lt(splat(static_cast<float>(depth)), o.max_depth));
    bsdf_detail::end_weak_walks(depth, walk, random);
    if (hn::AllFalse(d, walk.alive)) break;
    const WalkPlace place = bsdf_detail::advance(o, walk, random);
    specular = hn::AndNot(hn::Or(place.within, hn::AndNot(o.smooth_base, place.at_base)), specular);
    VF pdf;
    MF delta;
    bsdf_detail::scatter(o, place, walk, random, pdf, delta);
    const VF u_facet = random.next(), v_facet = random.next(), side = random.next();
    if (hn::AllFalse(d, place.at_surface)) continue;
    const auto [through, back] = facet_steps(o, make_ggx_lobe(-walk.w, o.alpha_x, o.alpha_y), u_facet, v_facet);
    const VF reflected = back.reflectance;
    const MF leaves = hn::And(place.at_surface, hn::Ge(side, reflected));
    const MF stays = hn::AndNot(leaves, place.at_surface);
    const VF passes = hn::Div(through.weight, hn::Max(hn::Sub(one, reflected), splat(FLT_MIN)));
    const VF returns = hn::Div(back.weight, hn::Max(reflected, splat(FLT_MIN)));
    const MF counts = hn::AndNot(specular, leaves);
    wi = if_then_else(leaves, through.w, wi);
    for (int j = 0; j < 4; ++j)
      weight[j] = hn::IfThenElse(counts, hn::Mul(hn::Mul(walk.beta[j], passes), inner_scale), weight[j]);
    walk.alive = hn::AndNot(leaves, walk.alive);
    const VF again[4] = {returns, returns, returns, returns};
    bsdf_detail::carry_on(stays, back.w, again, walk);
  }
  const LayerStep first = facet_steps(o, view.surface, u, v).back;
  const VF inv_share = hn::Div(one, hn::Max(view.surface_share, splat(FLT_MIN)));
  for (int j = 0; j < 4; ++j) {
    const VF surface = hn::IfThenElse(o.smooth_surface, view.mirror[j], first.weight);
    weight[j] = hn::IfThenElse(by_surface, hn::Mul(surface, inv_share), weight[j]);
  }
  wi = if_then_else(by_surface, first.w, wi);
  BsdfSample sample;
  const MF drawn = hn::And(hn::Gt(view.wo.z, zero),
                           hn::Gt(hn::Max(hn::Max(weight[0], weight[1]), hn::Max(weight[2], weight[3])), zero));
  const VF pdf = layered_pdf(o, view, wi, eval_ggx_reflection(view.surface, wi).pdf);
  sample.pdf = hn::IfThenElseZero(hn::AndNot(hn::And(by_surface, o.smooth_surface), drawn), pdf);
  for (int j = 0; j < 4; ++j) sample.weight[j] = hn::IfThenElseZero(drawn, weight[j]);
  sample.wi = {wi.x, wi.y, flip_sign(wi.z, view.side)};
  return sample;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
