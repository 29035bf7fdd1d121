// What the kernels of everything that light enters read of their material and of the media on both sides.
#if defined(METAMER_SYSTEMS_DIELECTRIC_OPTICS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_DIELECTRIC_OPTICS_INL_H_
#undef METAMER_SYSTEMS_DIELECTRIC_OPTICS_INL_H_
#else
#define METAMER_SYSTEMS_DIELECTRIC_OPTICS_INL_H_
#endif

#include "systems/bsdf/dielectric-inl.h"
#include "systems/media-inl.h"
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

HWY_INLINE MF is_set(const Column<uint32_t>& flags, VI row) {
  return float_mask(hn::Ne(gather(flags.data(), row), splat_u(0)));
}

// A path that has dispersed already carries its hero only.
HWY_INLINE MF has_companions(const ShadeStream& shade, size_t i) {
  const VF companions =
      hn::Max(hn::Max(load(shade.throughput[1], i), load(shade.throughput[2], i)), load(shade.throughput[3], i));
  return hn::Gt(companions, hn::Zero(FloatTag()));
}

// Divides indices by that of a medium; vacuum's is 1.
HWY_INLINE void make_relative(const World& world, VU medium, const VF lambda_nm[4], VF eta[4]) {
  VF around[4];
  eval_spectrum4(world.spectra.view(), gather(world.media.eta.data(), as_index(medium)), lambda_nm, around);
  for (int j = 0; j < 4; ++j) eta[j] = hn::Div(eta[j], around[j]);
}

// The optics of a boundary at a vertex. `crossing` is filled where the world has interiors: then the index is that
// between the two media, and a boundary without effect has the index 1.
HWY_INLINE DielectricOptics dielectric_optics(const World& world, const ShadeStream& shade, size_t i, VI row,
                                              MediaCrossing& crossing) {
  const SpectrumView spectra = world.spectra.view();
  const DielectricColumns& table = world.dielectric;
  VF lambda_nm[4];
  load(shade.lambda_nm, i, lambda_nm);
  DielectricOptics optics;
  eval_spectrum4(spectra, gather(table.eta.data(), row), lambda_nm, optics.eta);
  optics.schlick = is_set(table.schlick, row);
  MF parts = is_set(table.dispersive, row);
  const MF partly_opaque = is_set(table.partly_opaque, row);
  optics.some_opaque = !hn::AllFalse(FloatTag(), partly_opaque);
  if (optics.some_opaque) {
    eval_spectrum4(spectra, gather(table.kappa.data(), row), lambda_nm, optics.kappa);
    for (int j = 0; j < 4; ++j)
      optics.opaque[j] = hn::And(partly_opaque, hn::Ge(optics.kappa[j], splat(refracting_kappa)));
  }
  if (world.has_interiors) {
    crossing = media_crossing(world, shade, i, gather(table.medium.data(), row));
    const VU around = hn::IfThenElseZero(uint_mask(crossing.followed), crossing.outside);
    make_relative(world, around, lambda_nm, optics.eta);
    for (int j = 0; j < 4; ++j) optics.eta[j] = hn::IfThenElse(crossing.passed, splat(1.0f), optics.eta[j]);
    optics.schlick = hn::AndNot(crossing.passed, optics.schlick);  // it reflects at grazing angles whatever the index
    parts = hn::AndNot(crossing.passed, hn::Or(parts, is_set(world.media.dispersive, as_index(around))));
    if (optics.some_opaque) {
      make_relative(world, around, lambda_nm, optics.kappa);
      for (MF& opaque : optics.opaque) opaque = hn::AndNot(crossing.passed, opaque);
    }
  }
  optics.dispersive = hn::And(parts, has_companions(shade, i));
  return optics;
}

// What the leading wavelength is worth where it goes on alone and stands for all that accumulate sums: their number, or
// where leads differ in likelihood, the inverse of its share (see PathStream).
HWY_INLINE VF lone_weight(const World& world, const ShadeStream& shade, size_t i) {
  const VF count = splat(static_cast<float>(live_wavelengths(world.settings)));
  return shade.carries_shares ? hn::Div(count, load(shade.share[0], i)) : count;
}
// No other wavelength can have led there.
HWY_INLINE void store_lone_share(const World& world, MF alone, ShadeStream& shade, size_t i) {
  if (!shade.carries_shares) return;
  const VF count = splat(static_cast<float>(live_wavelengths(world.settings)));
  store(hn::IfThenElse(alone, count, load(shade.share[0], i)), shade.share[0], i);
  for (size_t j = 1; j < 4; ++j) store(hn::IfThenZeroElse(alone, load(shade.share[j], i)), shade.share[j], i);
}

// The factor on eta_scale: eta^2 with eta = n_i / n_o seen from wo, at a refraction.
HWY_INLINE VF refraction_scale(const DielectricOptics& optics, MF inside, MF transmitted) {
  const VF eta = bsdf_detail::relative_index(optics.eta[0], inside).eta;
  return hn::IfThenElse(transmitted, hn::Mul(eta, eta), splat(1.0f));
}

// Where the sides of the shading normal and of the surface disagree about where the ray came from, the surface's own
// normal counts: the stack of media must follow the optics.
HWY_INLINE Frame boundary_frame(const World& world, const ShadeStream& shade, size_t i) {
  const Frame frame = shading_frame(world, shade, i);
  if (!world.has_interiors) return frame;
  const Vec3 wo = load(shade.wo, i), normal = load(shade.normal, i);
  const MF disagree = hn::Le(hn::Mul(dot(wo, normal), dot(wo, frame.n)), hn::Zero(FloatTag()));
  if (hn::AllFalse(FloatTag(), disagree)) return frame;
  const Frame flat = make_frame(normal);
  return {if_then_else(disagree, flat.s, frame.s), if_then_else(disagree, flat.t, frame.t),
          if_then_else(disagree, flat.n, frame.n)};
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
