// A diffuse body under a clear coat, four wavelengths at a time: what the coat's surface reflects is white, what comes
// back from the body below has the body's colour. Directions are unit vectors in the local shading frame (z = shading
// normal) and point away from the surface; pdfs are per solid angle. Scalar double twins: reference_coat.h.
//
//   f = f_surface + (1 - E(wi)) (1 - E(wo)) a / (pi ((1 - a) eta^2 + a (1 - E_mean)))
//
// a: the body's albedo. eta: the coat's index against the outside. E: the share of light that the surface reflects at
// once (coat_albedo.h): Fresnel's F where it is smooth, the albedo of its GGX lobe f_surface where it is rough. E_mean:
// its average over the hemisphere.
//
// Where it comes from. Light enters with 1 - E(wi). Below, the body scatters it evenly; of that the surface sends the
// share E_inside back, on average over the hemisphere, so that a (1 + a E_inside + ...) = a / (1 - a E_inside) leaves
// the body in all; towards wo leaves (1 - E(wo)) / (pi eta^2) of it, the radiance being less by eta^2 outside. The same
// interface is crossed either way, so (1 - E_inside) eta^2 = 1 - E_mean (Duntley, JOSA 32, 61, 1942), which gives the
// form above. It has no absorption but the body's, all internal reflections, no thickness, and f(wi, wo) = f(wo, wi).
// The integral of f_cos over the hemisphere is E(wo) + (1 - E(wo)) g with g = a (1 - E_mean) / ((1 - a) eta^2 + a (1 -
// E_mean)): 1 for a = 1 whatever the angle, eta and roughness. For a = 1 it is the coupling of Kelemen & Szirmay-Kalos,
// "A Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling", Eurographics 2001.
//
// pbrt's coat (coat_layer.h) has the same form: A in place of 1 - E, 1 - eta^2 (1 - K) in place of E_mean, and the
// factor 1 - (a K)^n of a sum that ends after n hits of the base. `hits` is n, negative where there is no end.
//
// A dispersing coat needs no choice of a wavelength: directions do not depend on eta.
//
// Sampling is a mixture, one for all four wavelengths: with the chance `surface_share`, in proportion to what either
// reflects from wo, the surface (a mirror direction, or a visible facet), else wi in proportion to cos(theta_i).
// Both sides reflect alike.
#if defined(METAMER_SYSTEMS_BSDF_COATED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_COATED_INL_H_
#undef METAMER_SYSTEMS_BSDF_COATED_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_COATED_INL_H_
#endif

#include "engine/sampling/warps-inl.h"
#include "engine/simd/math-inl.h"
#include "engine/simd/vec3-inl.h"
#include "systems/bsdf/coat_albedo.h"
#include "systems/bsdf/fresnel-inl.h"
#include "systems/bsdf/ggx-inl.h"
#include "systems/bsdf/local-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A CoatRows per lane.
struct CoatRowsV {
  VI first, stride, last_pair;
  VF eta_least, rows_per_eta;
};

// albedo in [0, 1], eta > 0 within the table's range.
struct CoatOptics {
  VF albedo[4], eta[4];
  MF schlick;
  VF thickness, hits;  // of the layer: optical; negative: all
  const float* table;
  CoatRowsV rows;
};

// What eval and sample share about one viewing direction.
struct CoatView {
  VF mirror[4];  // F(wo), smooth surfaces only
  VF enters[4];  // 1 - E(wo)
  VF body[4];    // a / (pi ((1 - a) eta^2 + a (1 - E_mean))), what is missing of the sum included
  VF surface_share;
};

namespace bsdf_detail {

// Where a lane's four etas fall between rows of the table. Any float gives a place within the table.
struct CoatPlace {
  VI row;
  VF fraction;
};
HWY_INLINE CoatPlace coat_place(const CoatRowsV& rows, VF eta) {
  const VF zero = hn::Zero(FloatTag());
  const VF last = hn::Add(hn::ConvertTo(FloatTag(), rows.last_pair), splat(1.0f));
  const VF position = hn::Mul(hn::Sub(eta, rows.eta_least), rows.rows_per_eta);
  const VF x = hn::Min(hn::Max(hn::IfThenZeroElse(hn::IsNaN(position), position), zero), last);
  const VI pair = hn::Min(hn::ConvertTo(IntTag(), x), rows.last_pair);
  return {hn::Add(rows.first, hn::Mul(pair, rows.stride)), hn::Sub(x, hn::ConvertTo(FloatTag(), pair))};
}
HWY_INLINE VF coat_between(const CoatOptics& optics, const CoatPlace& place, VI column) {
  const VI at = hn::Add(place.row, column);
  const VF low = hn::GatherIndex(FloatTag(), optics.table, at);
  const VF high = hn::GatherIndex(FloatTag(), optics.table, hn::Add(at, optics.rows.stride));
  return hn::MulAdd(place.fraction, hn::Sub(high, low), low);
}

// Without dispersion one eta's value serves all four.
template <class Function>
HWY_INLINE void for_each_eta(const CoatOptics& optics, VF out[4], const Function& function) {
  const FloatTag d;
  const auto same = [&](int j) { return hn::AllTrue(d, hn::Eq(optics.eta[j], optics.eta[0])); };
  out[0] = function(optics.eta[0]);
  const bool all_same = same(1) && same(2) && same(3);
  for (int j = 1; j < 4; ++j) out[j] = all_same ? out[0] : function(optics.eta[j]);
}

}  // namespace bsdf_detail

// Fresnel's reflectance of the coat's surface, exact or Schlick's lane by lane; cos_theta in [0, 1]. Error as
// fresnel_dielectric.
HWY_INLINE void coat_reflectance(const CoatOptics& optics, VF cos_theta, VF reflectance[4]) {
  bsdf_detail::for_each_eta(optics, reflectance, [&](VF eta) {
    const VF inv_eta = hn::Div(splat(1.0f), eta);
    const VF exact = fresnel_dielectric(eta, inv_eta, cos_theta).reflectance;
    if (hn::AllFalse(FloatTag(), optics.schlick)) return exact;
    return hn::IfThenElse(optics.schlick, schlick_dielectric(eta, inv_eta, cos_theta).reflectance, exact);
  });
}

namespace bsdf_detail {
// What of 1 - F at a smooth surface gets through the layer.
HWY_INLINE void smooth_coat_enters(const CoatOptics& optics, VF cos_theta, const VF reflectance[4], VF enters[4]) {
  const FloatTag d;
  for (int j = 0; j < 4; ++j) enters[j] = hn::Sub(splat(1.0f), reflectance[j]);
  if (hn::AllFalse(d, hn::Gt(optics.thickness, hn::Zero(d)))) return;
  VF passes[4];
  for_each_eta(optics, passes, [&](VF eta) {
    const VF projection = safe_sqrt(transmitted_projection_squared(eta, hn::Min(cos_theta, splat(1.0f))));
    return exp(hn::Neg(hn::Div(hn::Mul(optics.thickness, eta), hn::Max(projection, splat(1e-20f)))));
  });
  for (int j = 0; j < 4; ++j) enters[j] = hn::Mul(enters[j], passes[j]);
}

// 1 - E of a rough surface, cos_theta in [0, 1].
HWY_INLINE void rough_coat_enters(const CoatOptics& optics, VF cos_theta, VF enters[4]) {
  const VF zero = hn::Zero(FloatTag()), last = splat(float(coat_nodes - 1));
  const VF position = hn::Mul(hn::Sqrt(hn::Sqrt(cos_theta)), last);
  const VF x = hn::Min(hn::Max(hn::IfThenZeroElse(hn::IsNaN(position), position), zero), last);
  const VI node = hn::Min(hn::ConvertTo(IntTag(), x), hn::Set(IntTag(), int(coat_nodes) - 2));
  const VF fraction = hn::Sub(x, hn::ConvertTo(FloatTag(), node));
  const VI column = hn::Add(node, hn::Set(IntTag(), 1));  // behind the average
  for_each_eta(optics, enters, [&](VF eta) {
    const CoatPlace place = coat_place(optics.rows, eta);
    const VF low = coat_between(optics, place, column);
    const VF high = coat_between(optics, place, hn::Add(column, hn::Set(IntTag(), 1)));
    return hn::Sub(splat(1.0f), hn::MulAdd(fraction, hn::Sub(high, low), low));
  });
}

// Finishes a view of which `enters` is known.
HWY_INLINE void complete_coat_view(const CoatOptics& optics, CoatView& view) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = splat(1.0f);
  VF enters_mean[4];
  for_each_eta(optics, enters_mean, [&](VF eta) {
    return hn::Sub(one, coat_between(optics, coat_place(optics.rows, eta), hn::Zero(IntTag())));
  });
  const MF ends = hn::Ge(optics.hits, zero);
  const bool any_ends = !hn::AllFalse(d, ends);
  VF surface = zero, body = zero;
  for (int j = 0; j < 4; ++j) {
    const VF a = hn::Min(optics.albedo[j], one);
    const VF eta2 = hn::Mul(optics.eta[j], optics.eta[j]);
    const VF denominator = hn::MulAdd(a, enters_mean[j], hn::Mul(hn::Sub(one, a), eta2));
    // 0 only where all is white and nothing enters.
    VF ratio = hn::Div(a, hn::Max(denominator, splat(FLT_MIN)));
    if (any_ends) {
      const VF again = saturate(hn::NegMulAdd(a, hn::Div(enters_mean[j], eta2), a));  // a K
      ratio = hn::IfThenElse(ends, hn::NegMulAdd(ratio, pow(again, optics.hits), ratio), ratio);
    }
    view.body[j] = hn::Mul(ratio, splat(inverse_pi));
    surface = hn::Add(surface, hn::Sub(one, view.enters[j]));
    body = hn::MulAdd(hn::Mul(view.enters[j], ratio), enters_mean[j], body);
  }
  view.surface_share = hn::Div(surface, hn::Max(hn::Add(surface, body), splat(FLT_MIN)));
}

// The body's f_cos and the mixture's pdf, added to what f_cos and pdf hold of the surface's part.
HWY_INLINE void add_coated_body(const CoatView& view, const VF enters_i[4], MF reflects, VF cos_i, VF f_cos[4],
                                VF& pdf) {
  const VF pdf_body = hn::Mul(hn::Sub(splat(1.0f), view.surface_share), hn::Mul(cos_i, splat(inverse_pi)));
  pdf = hn::IfThenElseZero(reflects, hn::MulAdd(view.surface_share, pdf, pdf_body));
  for (int j = 0; j < 4; ++j) {
    const VF body = hn::Mul(hn::Mul(view.enters[j], enters_i[j]), hn::Mul(view.body[j], cos_i));
    f_cos[j] = hn::IfThenElseZero(reflects, hn::Add(f_cos[j], body));
  }
}

HWY_INLINE void divide_by_pdf(const VF f_cos[4], BsdfSample& sample) {
  const MF drawn = hn::Gt(sample.pdf, hn::Zero(FloatTag()));
  const VF inverse = hn::Div(splat(1.0f), hn::IfThenElse(drawn, sample.pdf, splat(1.0f)));
  for (int j = 0; j < 4; ++j) sample.weight[j] = hn::IfThenElseZero(drawn, hn::Mul(f_cos[j], inverse));
}
}  // namespace bsdf_detail

// Under a smooth surface. wo.z may have either sign; wo.z = 0 reflects nothing.
HWY_INLINE CoatView make_smooth_coat_view(const Vec3& wo, const CoatOptics& optics) {
  CoatView view;
  coat_reflectance(optics, hn::Abs(wo.z), view.mirror);
  bsdf_detail::smooth_coat_enters(optics, hn::Abs(wo.z), view.mirror, view.enters);
  bsdf_detail::complete_coat_view(optics, view);
  return view;
}

// f_cos of the body and the pdf with which sample_smooth_coat draws wi from it; the mirror image is a delta lobe and
// has no part in either. Largest errors against double: 2e-5 absolute for either.
HWY_INLINE void eval_smooth_coat(const Vec3& wo, const CoatView& view, const CoatOptics& optics, const Vec3& wi,
                                 VF f_cos[4], VF& pdf) {
  const VF zero = hn::Zero(FloatTag());
  const VF cos_i = hn::Abs(wi.z);
  const MF reflects = hn::Gt(hn::Mul(wo.z, wi.z), zero);
  VF reflectance[4], enters[4];
  coat_reflectance(optics, cos_i, reflectance);
  bsdf_detail::smooth_coat_enters(optics, cos_i, reflectance, enters);
  for (int j = 0; j < 4; ++j) f_cos[j] = zero;
  pdf = zero;
  bsdf_detail::add_coated_body(view, enters, reflects, cos_i, f_cos, pdf);
}

struct CoatSample {
  BsdfSample draw;  // in lanes of `mirrored` the pdf is surface_share, a probability
  MF mirrored;      // the delta lobe
};

// Draws wi: `choice` in [0, 1) takes the lobe, u and v in [0, 1) the direction from the body. Largest errors against
// double: wi 1e-6 in each coordinate, weight 2e-5 (1 + weight), pdf 2e-5.
HWY_INLINE CoatSample sample_smooth_coat(const Vec3& wo, const CoatView& view, const CoatOptics& optics, VF choice,
                                         VF u, VF v) {
  const VF zero = hn::Zero(FloatTag());
  const Vec3 up = sample_cosine_hemisphere(u, v);
  CoatSample sample;
  sample.mirrored = hn::Lt(choice, view.surface_share);
  sample.draw.wi = if_then_else(sample.mirrored, Vec3{hn::Neg(wo.x), hn::Neg(wo.y), wo.z},
                                Vec3{up.x, up.y, flip_sign(up.z, sign_bit(wo.z))});
  VF f_cos[4], pdf_body;
  eval_smooth_coat(wo, view, optics, sample.draw.wi, f_cos, pdf_body);
  const VF pdf = hn::IfThenElse(sample.mirrored, view.surface_share, pdf_body);
  sample.draw.pdf = hn::IfThenElseZero(hn::Ne(wo.z, zero), pdf);
  for (int j = 0; j < 4; ++j) f_cos[j] = hn::IfThenElse(sample.mirrored, view.mirror[j], f_cos[j]);
  bsdf_detail::divide_by_pdf(f_cos, sample.draw);
  return sample;
}

// Under a rough surface; `lobe` is that of wo and the coat's alpha, which is at least smooth_alpha.
HWY_INLINE CoatView make_rough_coat_view(const GgxLobe& lobe, const CoatOptics& optics) {
  CoatView view;
  for (VF& mirror : view.mirror) mirror = hn::Zero(FloatTag());
  bsdf_detail::rough_coat_enters(optics, lobe.wo.z, view.enters);
  bsdf_detail::complete_coat_view(optics, view);
  return view;
}

// f_cos and the pdf with which sample_rough_coat draws wi; 0 where wi is on the other side. Largest errors against
// double: 6e-5 + 6e-7 / alpha relative (the facet's normal is uncertain by the rounding of directions) and 2e-5
// absolute.
HWY_INLINE void eval_rough_coat(const GgxLobe& lobe, const CoatView& view, const CoatOptics& optics, const Vec3& wi,
                                VF f_cos[4], VF& pdf) {
  const GgxReflection surface = eval_ggx_reflection(lobe, wi);
  const VF cos_i = flip_sign(wi.z, lobe.side);
  const MF reflects = hn::Gt(hn::Min(cos_i, lobe.wo.z), hn::Zero(FloatTag()));
  VF reflectance[4], enters[4];
  coat_reflectance(optics, surface.cos_theta_d, reflectance);
  bsdf_detail::rough_coat_enters(optics, hn::Min(hn::Abs(cos_i), splat(1.0f)), enters);
  for (int j = 0; j < 4; ++j) f_cos[j] = hn::Mul(reflectance[j], surface.f_cos);
  pdf = surface.pdf;
  bsdf_detail::add_coated_body(view, enters, reflects, cos_i, f_cos, pdf);
}

// Draws wi: `choice` in [0, 1) takes the lobe, u and v in [0, 1) the direction in it. A draw below the surface has
// weight 0 and pdf 0. Largest errors against double: wi 3e-5 in each coordinate, weight and pdf those of
// eval_rough_coat at wi.
HWY_INLINE BsdfSample sample_rough_coat(const GgxLobe& lobe, const CoatView& view, const CoatOptics& optics, VF choice,
                                        VF u, VF v) {
  const bsdf_detail::VisibleNormal visible = bsdf_detail::sample_visible_normal(lobe, u, v);
  const Vec3 mirrored = reflect(-lobe.wo, normalize(visible.m));
  const MF surface = hn::Lt(choice, view.surface_share);
  const Vec3 up = if_then_else(surface, mirrored, sample_cosine_hemisphere(u, v));
  BsdfSample sample;
  sample.wi = {up.x, up.y, flip_sign(up.z, lobe.side)};
  VF f_cos[4];
  eval_rough_coat(lobe, view, optics, sample.wi, f_cos, sample.pdf);
  bsdf_detail::divide_by_pdf(f_cos, sample);
  return sample;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
