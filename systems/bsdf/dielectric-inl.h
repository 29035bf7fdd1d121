// The smooth boundary of a transparent medium, four wavelengths at a time: a mirror and a refracted direction, both
// delta lobes. Directions are unit vectors in the local shading frame (z = shading normal, out of the medium) and point
// away from the surface. Scalar double twin: reference.h.
//
// Which lobe is drawn. Without dispersion all four wavelengths share one eta, one direction and one F: the lobe is
// reflected with probability F, and all four go on. With dispersion the mirror direction is still common to all, the
// refracted one is not: all four go on in reflection, only the hero (wavelength 0) in transmission. Each wavelength is
// unbiased if every lobe in which it goes on is drawn with a probability that its weight divides by; so the probability
// must be positive wherever some F is (a hero for which eta = 1 must not forbid its companions' reflection), and the
// hero's transmission must be possible unless it is totally reflected. The mean of the four F is both, and bounds every
// weight by 4 (times the radiance's scale); where the hero is totally reflected, or opaque, nothing can be transmitted
// and the probability is 1.
#if defined(METAMER_SYSTEMS_BSDF_DIELECTRIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_DIELECTRIC_INL_H_
#undef METAMER_SYSTEMS_BSDF_DIELECTRIC_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_DIELECTRIC_INL_H_
#endif

#include "engine/simd/vec3-inl.h"
#include "systems/bsdf/fresnel-inl.h"
#include "systems/bsdf/local-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// eta = n_inside / n_outside > 0, where outside is the side that z points to; the hero first. `dispersive`: the
// wavelengths part in refraction, because the etas differ or because some are opaque, and all four are alive. Lanes
// whose companions have been terminated already are not dispersive: for them, as for lanes of one common eta, eta[0]
// alone is read. Lanes of `schlick` use Schlick's approximation.
// Where `some_opaque`: wavelengths of `opaque` reflect as conductors of index eta + i kappa, kappa relative to the
// outside as well, and nothing of them is transmitted.
struct DielectricOptics {
  VF eta[4];
  MF schlick, dispersive;
  bool some_opaque = false;
  MF opaque[4];
  VF kappa[4];
};

struct DielectricSample {
  Vec3 wi;
  VF weight[4];            // F / probability, or (1 - F) (n_viewer / n_light)^2 / probability
  VF probability;          // of the lobe that was drawn, in (0, 1]
  MF transmitted;          // wi is on the other side
  MF terminate_secondary;  // only the hero goes on: weight[1..3] are 0, and the hero stands for all four
};

namespace bsdf_detail {
struct RelativeIndex {
  VF eta, inv_eta;  // n_transmitted / n_incident seen from wo, and its reciprocal
};
HWY_INLINE RelativeIndex relative_index(VF eta, MF inside) {
  const VF inv_eta = hn::Div(splat(1.0f), eta);
  return {hn::IfThenElse(inside, inv_eta, eta), hn::IfThenElse(inside, eta, inv_eta)};
}
HWY_INLINE DielectricBoundary boundary(const RelativeIndex& index, VF cos_theta_i, MF schlick) {
  DielectricBoundary b = fresnel_dielectric(index.eta, index.inv_eta, cos_theta_i);
  if (hn::AllFalse(FloatTag(), schlick)) return b;
  const VF approximate = schlick_dielectric(index.eta, index.inv_eta, cos_theta_i).reflectance;
  b.reflectance = hn::IfThenElse(schlick, approximate, b.reflectance);
  return b;
}
// F of the opaque wavelengths.
HWY_INLINE void reflect_opaque(const DielectricOptics& optics, VF cos_theta_i, VF f[4]) {
  for (int j = 0; j < 4; ++j) {
    const VF exact = fresnel_conductor(optics.eta[j], optics.kappa[j], cos_theta_i);
    const VF approximate = schlick_conductor(optics.eta[j], optics.kappa[j], cos_theta_i);
    f[j] = hn::IfThenElse(optics.opaque[j], hn::IfThenElse(optics.schlick, approximate, exact), f[j]);
  }
}
}  // namespace bsdf_detail

// Draws one of the two lobes; u in [0, 1). Transmission scales radiance towards the viewer by (n_viewer / n_light)^2
// (DESIGN.md, section 1). Largest errors against double: weight 5e-5 and wi 2e-6 relative to the largest component,
// away from critical angles (|g^2| > 1e-3, see fresnel_dielectric).
HWY_INLINE DielectricSample sample_dielectric(const Vec3& wo, const DielectricOptics& optics, VF u) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = splat(1.0f);
  const VF side = sign_bit(wo.z);
  const MF inside = hn::Lt(wo.z, zero);
  const VF cos_theta_o = hn::Abs(wo.z);
  const bsdf_detail::RelativeIndex hero = bsdf_detail::relative_index(optics.eta[0], inside);
  const DielectricBoundary boundary = bsdf_detail::boundary(hero, cos_theta_o, optics.schlick);
  const bool any_dispersive = !hn::AllFalse(d, optics.dispersive);
  VF f[4] = {boundary.reflectance, boundary.reflectance, boundary.reflectance, boundary.reflectance};
  MF blocked = boundary.total;  // for the hero
  if (any_dispersive) {
    for (int j = 1; j < 4; ++j) {
      const bsdf_detail::RelativeIndex index = bsdf_detail::relative_index(optics.eta[j], inside);
      f[j] = bsdf_detail::boundary(index, cos_theta_o, optics.schlick).reflectance;
    }
  }
  if (optics.some_opaque) {
    bsdf_detail::reflect_opaque(optics, cos_theta_o, f);
    blocked = hn::Or(blocked, optics.opaque[0]);
  }
  VF p_reflect = hn::IfThenElse(blocked, one, f[0]);
  if (any_dispersive) {
    const VF mean = hn::Mul(splat(0.25f), hn::Add(hn::Add(f[0], f[1]), hn::Add(f[2], f[3])));
    p_reflect = hn::IfThenElse(hn::AndNot(blocked, optics.dispersive), mean, p_reflect);
  }

  DielectricSample sample;
  sample.transmitted = hn::Ge(u, p_reflect);
  sample.terminate_secondary = hn::And(sample.transmitted, optics.dispersive);
  sample.probability = hn::IfThenElse(sample.transmitted, hn::Sub(one, p_reflect), p_reflect);
  const VF up = hn::Or(one, side);  // the normal on wo's side
  Vec3 refracted = refract(-wo, Vec3{zero, zero, up}, hero.inv_eta, boundary.cos_theta_t);
  refracted.z = hn::Neg(hn::Or(boundary.cos_theta_t, side));  // the same without rounding
  sample.wi = if_then_else(sample.transmitted, refracted, Vec3{hn::Neg(wo.x), hn::Neg(wo.y), wo.z});

  const VF scale = hn::IfThenElse(sample.transmitted, hn::Mul(hero.inv_eta, hero.inv_eta), one);
  for (int j = 0; j < 4; ++j) sample.weight[j] = scale;
  if (optics.some_opaque) sample.weight[0] = hn::IfThenElse(optics.opaque[0], f[0], scale);
  if (any_dispersive) {
    const VF factor = hn::Div(scale, sample.probability);
    const VF hero_share = hn::IfThenElse(sample.transmitted, hn::Sub(one, f[0]), f[0]);
    sample.weight[0] = hn::IfThenElse(optics.dispersive, hn::Mul(hero_share, factor), sample.weight[0]);
    for (int j = 1; j < 4; ++j) {
      const VF share = hn::IfThenZeroElse(sample.transmitted, hn::Mul(f[j], factor));
      sample.weight[j] = hn::IfThenElse(optics.dispersive, share, scale);
    }
  }
  return sample;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
