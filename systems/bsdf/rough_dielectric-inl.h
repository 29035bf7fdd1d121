// The rough boundary of a transparent medium: GGX microfacets that reflect and refract, four wavelengths at a time.
// Conventions and D, Lambda, G as in ggx-inl.h; scalar double twin: reference.h. With eta = n_i / n_o the relative
// index seen from wo's side, and for wi on the other side m along +-(wo + eta wi):
//   f = D G F / (4 |cos(theta_i) cos(theta_o)|)                                         on wo's side
//   f = D G (1 - F) |wi.m wo.m| / (|cos(theta_i) cos(theta_o)| (wo.m + eta wi.m)^2)     on the other
// Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, equations 20
// and 21, for radiance: f(wo, wi) / n_o^2 = f(wi, wo) / n_i^2. Light that would meet a second facet is lost.
//
// A facet is drawn among those visible from wo, then one of its two directions. Reflection goes the same way on all
// wavelengths; refraction, where the indices differ, takes the hero alone, as in dielectric-inl.h. A light's direction
// is weighed on every wavelength all the same, each by its own facet, and each against the chance that it would have
// had as the hero: over all heroes the two ways to find the light complement each other on each wavelength.
#if defined(METAMER_SYSTEMS_BSDF_ROUGH_DIELECTRIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_ROUGH_DIELECTRIC_INL_H_
#undef METAMER_SYSTEMS_BSDF_ROUGH_DIELECTRIC_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_ROUGH_DIELECTRIC_INL_H_
#endif

#include "systems/bsdf/dielectric-inl.h"
#include "systems/bsdf/ggx-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

namespace bsdf_detail {
// The facets of a matched index are not there: light goes straight on, a delta lobe.
HWY_INLINE MF is_matched(VF eta) { return hn::Lt(hn::Abs(hn::Sub(eta, splat(1.0f))), splat(matched_index)); }

// F on the four wavelengths at one facet, and the chance that its reflection is drawn when `hero` leads: the rule of
// dielectric-inl.h. Lanes that do not disperse have the hero's in all.
struct FacetChoice {
  VF reflectance[4];
  DielectricBoundary hero;
  VF p_reflect;
};
HWY_INLINE FacetChoice facet_choice(const DielectricOptics& optics, MF inside, VF cos_theta, int hero,
                                    bool any_dispersive) {
  FacetChoice choice;
  choice.hero = boundary(relative_index(optics.eta[hero], inside), cos_theta, optics.schlick);
  for (VF& f : choice.reflectance) f = choice.hero.reflectance;
  choice.p_reflect = choice.hero.reflectance;
  if (!any_dispersive) return choice;
  VF sum = hn::Zero(FloatTag());
  for (int j = 0; j < 4; ++j) {
    const VF f = boundary(relative_index(optics.eta[j], inside), cos_theta, optics.schlick).reflectance;
    choice.reflectance[j] = hn::IfThenElse(optics.dispersive, f, choice.reflectance[j]);
    sum = hn::Add(sum, f);
  }
  const MF drawn = hn::AndNot(choice.hero.total, optics.dispersive);
  choice.p_reflect = hn::IfThenElse(drawn, hn::Mul(splat(0.25f), sum), choice.p_reflect);
  return choice;
}

// S(wo) |cos(theta_i)| + S(wi) |cos(theta_o)|, up = wi with wo on the upper side.
HWY_INLINE VF shadowing_denominator(const GgxLobe& lobe, const Vec3& up) {
  const VF s_wi = stretched_length(lobe.alpha_x, lobe.alpha_y, up);
  return hn::MulAdd(lobe.s_wo, hn::Abs(up.z), hn::Mul(s_wi, lobe.wo.z));
}
HWY_INLINE VF stretched_square(const GgxLobe& lobe, const Vec3& h) {
  const VF x = hn::Mul(h.x, lobe.inv_alpha_x), y = hn::Mul(h.y, lobe.inv_alpha_y);
  return hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(h.z, h.z)));
}

// Light that arrives from the other side on one wavelength: f_cos, and the pdf of finding its direction as the hero.
HWY_INLINE void eval_refraction(const GgxLobe& lobe, const DielectricOptics& optics, const Vec3& up, VF inv_shadowing,
                                int j, bool any_dispersive, VF& f_cos, VF& pdf) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const MF inside = sign_bit_set(lobe.side);
  const VF eta = relative_index(optics.eta[j], inside).eta;
  Vec3 h = lobe.wo + up * eta;
  const VF sign = sign_bit(h.z);
  h = {flip_sign(h.x, sign), flip_sign(h.y, sign), flip_sign(h.z, sign)};
  const VF wo_h = dot(lobe.wo, h), wi_h = hn::Neg(dot(up, h));
  const MF refracts = hn::And(hn::AndNot(is_matched(eta), hn::Lt(up.z, zero)), hn::Gt(hn::Min(wo_h, wi_h), zero));
  const VF cos_theta = hn::Div(wo_h, hn::Sqrt(hn::Max(dot(h, h), splat(1e-30f))));
  const FacetChoice choice = facet_choice(optics, inside, cos_theta, j, any_dispersive);
  const VF q = stretched_square(lobe, h);
  const VF facets =
      hn::Div(hn::Mul(hn::Mul(splat(4.0f), lobe.d_scale), hn::Mul(wo_h, wi_h)), hn::Max(hn::Mul(q, q), splat(1e-37f)));
  const VF passes = hn::Sub(one, choice.reflectance[j]);
  const VF drawn = hn::IfThenElseZero(hn::Gt(passes, zero), hn::Sub(one, choice.p_reflect));
  f_cos = hn::IfThenElseZero(refracts, hn::Mul(hn::Mul(facets, passes), hn::Mul(hn::Abs(up.z), inv_shadowing)));
  pdf = hn::IfThenElseZero(refracts, hn::Mul(hn::Mul(facets, hn::Mul(eta, eta)), hn::Mul(lobe.inv_visible, drawn)));
}
}  // namespace bsdf_detail

// f_cos = f |cos(theta_i)| on both sides, and for each wavelength the pdf with which sample_rough_dielectric finds wi
// for it. Nothing of `optics` is opaque. Largest relative errors against double for alpha >= 0.02 and |eta - 1| >=
// 0.05: f_cos 1e-2, pdf 3e-2, both next to a facet's critical angle, where F is steep.
HWY_INLINE void eval_rough_dielectric(const GgxLobe& lobe, const DielectricOptics& optics, const Vec3& wi, VF f_cos[4],
                                      VF pdf[4]) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = splat(1.0f);
  const bool any_dispersive = !hn::AllFalse(d, optics.dispersive);
  const MF inside = sign_bit_set(lobe.side);
  const MF seen = hn::Gt(lobe.wo.z, zero);
  const Vec3 up = {wi.x, wi.y, flip_sign(wi.z, lobe.side)};
  const VF inv_shadowing = hn::Div(one, bsdf_detail::shadowing_denominator(lobe, up));

  const Vec3 h = lobe.wo + up;
  const VF h2 = dot(h, h);
  const VF ratio = hn::Div(h2, bsdf_detail::stretched_square(lobe, h));
  const VF half_d = hn::Mul(hn::Mul(ratio, ratio), lobe.d_scale);
  const bsdf_detail::FacetChoice mirror =
      bsdf_detail::facet_choice(optics, inside, hn::Mul(splat(0.5f), hn::Sqrt(h2)), 0, any_dispersive);
  const MF reflects = hn::And(seen, hn::Gt(up.z, zero));
  const VF common = hn::Mul(hn::Mul(half_d, up.z), inv_shadowing);
  const VF reflected_pdf = hn::Mul(hn::Mul(half_d, lobe.inv_visible), mirror.p_reflect);
  VF hero_f, hero_pdf;
  bsdf_detail::eval_refraction(lobe, optics, up, inv_shadowing, 0, any_dispersive, hero_f, hero_pdf);
  for (int j = 0; j < 4; ++j) {
    VF refracted_f = hero_f, refracted_pdf = hero_pdf;
    if (j > 0 && any_dispersive) {
      VF own_f, own_pdf;
      bsdf_detail::eval_refraction(lobe, optics, up, inv_shadowing, j, true, own_f, own_pdf);
      refracted_f = hn::IfThenElse(optics.dispersive, own_f, hero_f);
      refracted_pdf = hn::IfThenElse(optics.dispersive, own_pdf, hero_pdf);
    }
    const VF f = hn::IfThenElse(reflects, hn::Mul(common, mirror.reflectance[j]), refracted_f);
    f_cos[j] = hn::IfThenElseZero(seen, f);
    pdf[j] = hn::IfThenElseZero(seen, hn::IfThenElse(reflects, reflected_pdf, refracted_pdf));
  }
}

struct RoughDielectricSample {
  Vec3 wi;
  VF weight[4];            // f_cos / pdf of the wavelengths that go on; 0 where the draw is void
  VF pdf;                  // the hero's, per solid angle; 0 for a void draw and for a matched index, a delta lobe
  MF transmitted;          // wi is on the other side
  MF terminate_secondary;  // only the hero goes on: weight[1..3] are 0, and the hero stands for all four
};

// Draws wi; `choice` takes the direction at the facet that u and v draw, all in [0, 1). Void: a direction on the wrong
// side of the surface, which meets a second facet. Largest errors against double where eval's hold: wi 1e-4, weight
// 1e-3, pdf 1e-2 relative (D is steep where alpha is small).
HWY_INLINE RoughDielectricSample sample_rough_dielectric(const GgxLobe& lobe, const DielectricOptics& optics, VF choice,
                                                         VF u, VF v) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = splat(1.0f);
  const bool any_dispersive = !hn::AllFalse(d, optics.dispersive);
  const MF inside = sign_bit_set(lobe.side);
  const bsdf_detail::VisibleNormal visible = bsdf_detail::sample_visible_normal(lobe, u, v);
  const VF n2 = dot(visible.m, visible.m);
  const Vec3 m = visible.m * hn::Div(one, hn::Sqrt(n2));
  const VF c = dot(lobe.wo, m);
  const bsdf_detail::FacetChoice facet = bsdf_detail::facet_choice(optics, inside, c, 0, any_dispersive);
  const bsdf_detail::RelativeIndex hero = bsdf_detail::relative_index(optics.eta[0], inside);
  const MF matched = bsdf_detail::is_matched(hero.eta);

  RoughDielectricSample sample;
  sample.transmitted = hn::Ge(choice, facet.p_reflect);
  sample.terminate_secondary = hn::And(sample.transmitted, optics.dispersive);
  const Vec3 refracted = refract(-lobe.wo, m, hero.inv_eta, facet.hero.cos_theta_t);
  Vec3 up = if_then_else(sample.transmitted, refracted, reflect(-lobe.wo, m));
  const MF straight = hn::And(sample.transmitted, matched);
  up = if_then_else(straight, -lobe.wo, up);
  sample.wi = {up.x, up.y, flip_sign(up.z, lobe.side)};
  const MF right_side = hn::Gt(hn::IfThenElse(sample.transmitted, hn::Neg(up.z), up.z), zero);
  const MF goes_on = hn::And(right_side, hn::And(hn::Gt(lobe.wo.z, zero), hn::Gt(c, zero)));

  const VF inv_shadowing = hn::Div(one, bsdf_detail::shadowing_denominator(lobe, up));
  const VF shadowing = hn::Mul(hn::Mul(hn::Abs(up.z), hn::Add(lobe.wo.z, lobe.s_wo)), inv_shadowing);  // G / G1
  const VF ratio = hn::Div(n2, visible.h2);
  const VF half_d = hn::Mul(hn::Mul(ratio, ratio), lobe.d_scale);
  const VF reflected_pdf = hn::Mul(half_d, lobe.inv_visible);
  // wo.m + eta wi.m = c - g = (1 - eta^2) / (c + g), g = eta cos(theta_t).
  const VF g = hn::Mul(hero.eta, facet.hero.cos_theta_t);
  const VF sum = hn::Add(c, g);
  const VF ends = hn::Mul(hn::Sub(hero.eta, one), hn::Add(hero.eta, one));
  const VF jacobian = hn::Div(hn::Mul(hn::Mul(splat(4.0f), hn::Mul(c, g)), hn::Mul(hero.eta, hn::Mul(sum, sum))),
                              hn::Max(hn::Mul(ends, ends), splat(1e-30f)));
  const VF probability = hn::IfThenElse(sample.transmitted, hn::Sub(one, facet.p_reflect), facet.p_reflect);
  const VF pdf = hn::Mul(hn::Mul(reflected_pdf, probability), hn::IfThenElse(sample.transmitted, jacobian, one));
  sample.pdf = hn::IfThenElseZero(hn::AndNot(straight, goes_on), pdf);

  const VF scale = hn::IfThenElse(sample.transmitted, hn::Mul(hero.inv_eta, hero.inv_eta), one);
  const VF kept = hn::IfThenElseZero(goes_on, hn::Mul(scale, hn::IfThenElse(straight, one, hn::Min(shadowing, one))));
  for (int j = 0; j < 4; ++j) {
    const VF share = hn::IfThenElse(sample.transmitted, hn::Sub(one, facet.reflectance[j]), facet.reflectance[j]);
    const VF own = hn::Mul(kept, hn::Div(share, probability));
    sample.weight[j] = hn::IfThenElse(optics.dispersive, own, kept);
    if (j > 0) sample.weight[j] = hn::IfThenZeroElse(sample.terminate_secondary, sample.weight[j]);
  }
  return sample;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
