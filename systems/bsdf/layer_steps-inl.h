// The single steps of light in pbrt's coat (layered-inl.h): through its surface and back from below, across its layer,
// off its base. Directions are unit vectors in the local shading frame, point away from where they scatter, and have z
// < 0 inside of the surface; the base is below. Shares are of power: what a boundary does to radiance is left to the
// caller.
#if defined(METAMER_SYSTEMS_BSDF_LAYER_STEPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_LAYER_STEPS_INL_H_
#undef METAMER_SYSTEMS_BSDF_LAYER_STEPS_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_LAYER_STEPS_INL_H_
#endif

#include "engine/sampling/warps-inl.h"
#include "systems/bsdf/rough_dielectric-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct LayeredOptics {
  VF eta, alpha_x, alpha_y;  // of the layer against the outside, of its surface
  MF smooth_surface;
  VF thickness, asymmetry;  // optical; mean cosine of what scatters in the layer
  VF albedo[4];             // of what scatters in it
  MF scatters;              // some of the four is above 0
  VF max_depth, walks;
  MF conductor;  // the base, else diffuse
  VF reflectance[4];
  ConductorOptics metal;  // relative to the layer
  VF base_alpha_x, base_alpha_y;
  MF smooth_base;  // of a conductor
};

struct LayerStep {
  Vec3 w;
  VF weight;       // f_cos / pdf, of a share of power; 0 where light is lost
  VF reflectance;  // F at the facet
};
// Both directions at one facet among those that are visible from where light comes; each weight with its own F.
struct FacetSteps {
  LayerStep through, back;
};
HWY_INLINE FacetSteps facet_steps(const LayeredOptics& o, const GgxLobe& lobe, VF u, VF v) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const Vec3 drawn = normalize(bsdf_detail::sample_visible_normal(lobe, u, v).m);
  const Vec3 m = if_then_else(lobe.smooth, Vec3{zero, zero, one}, drawn);
  const VF c = dot(lobe.wo, m);
  const bsdf_detail::RelativeIndex index = bsdf_detail::relative_index(o.eta, sign_bit_set(lobe.side));
  const DielectricBoundary boundary = fresnel_dielectric(index.eta, index.inv_eta, c);
  const Vec3 t = refract(-lobe.wo, m, index.inv_eta, boundary.cos_theta_t), r = reflect(-lobe.wo, m);
  // G / G1
  const auto shadowing = [&](const Vec3& up) {
    const VF g =
        hn::Div(hn::Mul(hn::Abs(up.z), hn::Add(lobe.wo.z, lobe.s_wo)), bsdf_detail::shadowing_denominator(lobe, up));
    return hn::IfThenElse(lobe.smooth, one, hn::Min(g, one));
  };
  const MF seen = hn::Gt(hn::Min(c, lobe.wo.z), zero);
  const MF passes = hn::AndNot(boundary.total, hn::And(seen, hn::Lt(t.z, zero)));
  const MF returns = hn::And(seen, hn::Gt(r.z, zero));
  FacetSteps steps;
  steps.through = {{t.x, t.y, flip_sign(t.z, lobe.side)},
                   hn::IfThenElseZero(passes, hn::Mul(hn::Sub(one, boundary.reflectance), shadowing(t))),
                   boundary.reflectance};
  steps.back = {{r.x, r.y, flip_sign(r.z, lobe.side)},
                hn::IfThenElseZero(returns, hn::Mul(boundary.reflectance, shadowing(r))),
                boundary.reflectance};
  return steps;
}

// Of light from the lobe's side to a direction on the other: f as a share of power, and the density with which
// facet_steps passes it on there. 0 for a smooth surface.
struct CrossValue {
  VF f, pdf;
};
HWY_INLINE CrossValue eval_crossing(const LayeredOptics& o, const GgxLobe& lobe, const Vec3& to) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const bsdf_detail::RelativeIndex index = bsdf_detail::relative_index(o.eta, sign_bit_set(lobe.side));
  const Vec3 up = {to.x, to.y, flip_sign(to.z, lobe.side)};
  Vec3 h = lobe.wo + up * index.eta;
  const VF sign = sign_bit(h.z);
  h = {flip_sign(h.x, sign), flip_sign(h.y, sign), flip_sign(h.z, sign)};
  const VF wo_h = dot(lobe.wo, h), wi_h = hn::Neg(dot(up, h));
  const MF crosses = hn::AndNot(lobe.smooth, hn::And(hn::Lt(up.z, zero), hn::Gt(hn::Min(wo_h, wi_h), zero)));
  const VF cosine = hn::Div(wo_h, hn::Sqrt(hn::Max(dot(h, h), splat(1e-30f))));
  const VF passes = hn::Sub(one, fresnel_dielectric(index.eta, index.inv_eta, cosine).reflectance);
  const VF q = bsdf_detail::stretched_square(lobe, h);
  const VF facets =
      hn::Div(hn::Mul(hn::Mul(splat(4.0f), lobe.d_scale), hn::Mul(wo_h, wi_h)), hn::Max(hn::Mul(q, q), splat(1e-37f)));
  const VF scaled = hn::Mul(facets, hn::Mul(index.eta, index.eta));
  const VF f = hn::Div(hn::Mul(scaled, passes), bsdf_detail::shadowing_denominator(lobe, up));
  return {hn::IfThenElseZero(crosses, f), hn::IfThenElseZero(crosses, hn::Mul(scaled, lobe.inv_visible))};
}

// What is left of light after a distance perpendicular to the layer.
HWY_INLINE VF layer_transmittance(VF distance, VF cos_theta) {
  return exp(hn::Neg(hn::Div(distance, hn::Max(hn::Abs(cos_theta), splat(1e-20f)))));
}

// The weight of one of two strategies (power heuristic); 0 where this one is a delta lobe that found nothing.
HWY_INLINE VF power_share(VF pdf, VF other) {
  const VF a = hn::Mul(pdf, pdf), sum = hn::MulAdd(other, other, a);
  return hn::Div(a, hn::Max(sum, splat(FLT_MIN)));
}

// The base's f_cos, both directions above it, and the density with which sample_base draws `to`; 0 for a smooth
// conductor.
HWY_INLINE void eval_base(const LayeredOptics& o, const Vec3& w, const Vec3& to, VF f_cos[4], VF& pdf) {
  const VF zero = hn::Zero(FloatTag());
  pdf = hn::IfThenElseZero(hn::Gt(hn::Min(w.z, to.z), zero), hn::Mul(to.z, splat(inverse_pi)));
  for (int j = 0; j < 4; ++j) f_cos[j] = hn::Mul(o.reflectance[j], pdf);
  if (hn::AllFalse(FloatTag(), o.conductor)) return;
  VF metal[4], metal_pdf;
  eval_conductor(make_ggx_lobe(w, o.base_alpha_x, o.base_alpha_y), o.metal, to, metal, metal_pdf);
  pdf = hn::IfThenElse(o.conductor, metal_pdf, pdf);
  for (int j = 0; j < 4; ++j) f_cos[j] = hn::IfThenElse(o.conductor, metal[j], f_cos[j]);
}
HWY_INLINE BsdfSample sample_base(const LayeredOptics& o, const Vec3& w, VF u, VF v) {
  BsdfSample sample;
  sample.wi = sample_cosine_hemisphere(u, v);
  sample.pdf = cosine_hemisphere_pdf(sample.wi.z);
  for (int j = 0; j < 4; ++j) sample.weight[j] = o.reflectance[j];
  if (hn::AllFalse(FloatTag(), o.conductor)) return sample;
  const BsdfSample metal = sample_conductor(make_ggx_lobe(w, o.base_alpha_x, o.base_alpha_y), o.metal, u, v);
  sample.wi = if_then_else(o.conductor, metal.wi, sample.wi);
  sample.pdf = hn::IfThenElse(o.conductor, metal.pdf, sample.pdf);
  for (int j = 0; j < 4; ++j) sample.weight[j] = hn::IfThenElse(o.conductor, metal.weight[j], sample.weight[j]);
  return sample;
}

// Henyey and Greenstein, Astrophysical Journal 93, 70 (1941); cos_theta between the ways before and behind.
HWY_INLINE VF phase(VF asymmetry, VF cos_theta) {
  const VF one = splat(1.0f), g2 = hn::Mul(asymmetry, asymmetry);
  const VF x = hn::Max(hn::NegMulAdd(hn::Add(asymmetry, asymmetry), cos_theta, hn::Add(one, g2)), splat(1e-12f));
  return hn::Div(hn::Mul(splat(0.25f * inverse_pi), hn::Sub(one, g2)), hn::Mul(x, hn::Sqrt(x)));
}
HWY_INLINE Vec3 sample_phase(VF asymmetry, const Vec3& w, VF u, VF v) {
  const VF one = splat(1.0f), two = splat(2.0f), g = asymmetry, g2 = hn::Mul(g, g);
  const VF s = hn::Div(hn::Sub(one, g2), hn::MulAdd(hn::Mul(two, g), u, hn::Sub(one, g)));
  const MF even = hn::Lt(hn::Abs(g), splat(1e-3f));
  const VF peaked = hn::Div(hn::NegMulAdd(s, s, hn::Add(one, g2)), hn::IfThenElse(even, one, hn::Mul(two, g)));
  const VF c = clamp(hn::IfThenElse(even, hn::NegMulAdd(two, u, one), peaked), -1.0f, 1.0f);
  const VF r = safe_sqrt(hn::NegMulAdd(c, c, one));
  const SinCos around = sincos_2pi(v);
  const Vec3 local = {hn::Mul(r, around.cos), hn::Mul(r, around.sin), c};
  return normalize(to_world(make_frame(w), local));
}

// The delta lobe of a smooth surface: its mirror image, and over a smooth conductor all reflections between the two,
// whose angles are the same: F + (1 - F)^2 T^2 R (1 + F T^2 R + ...), half of max_depth terms.
HWY_INLINE void layered_mirror(const LayeredOptics& o, VF cos_theta, VF mirror[4]) {
  const VF one = splat(1.0f);
  const DielectricBoundary boundary = fresnel_dielectric(o.eta, hn::Div(one, o.eta), cos_theta);
  const VF f = boundary.reflectance;
  for (int j = 0; j < 4; ++j) mirror[j] = hn::IfThenElseZero(o.smooth_surface, f);
  const MF sees_base = hn::And(o.smooth_surface, o.smooth_base);
  if (hn::AllFalse(FloatTag(), sees_base)) return;
  const VF way = layer_transmittance(o.thickness, boundary.cos_theta_t),
           terms = hn::Floor(hn::Mul(splat(0.5f), o.max_depth));
  VF metal[4];
  conductor_reflectance(o.metal, boundary.cos_theta_t, metal);
  for (int j = 0; j < 4; ++j) {
    const VF once = hn::Mul(hn::Mul(way, way), metal[j]), again = hn::Mul(f, once);
    const VF sum = hn::Div(hn::Sub(one, pow(again, terms)), hn::Max(hn::Sub(one, again), splat(FLT_MIN)));
    const VF passes = hn::Mul(hn::Sub(one, f), hn::Sub(one, f));
    const VF base = hn::IfThenElseZero(hn::Lt(f, one), hn::Mul(passes, hn::Mul(once, sum)));
    mirror[j] = hn::IfThenElse(sees_base, hn::Add(mirror[j], base), mirror[j]);
  }
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
