// What a stretch of a homogeneous volume does to the rays that go through it, on four wavelengths.
#if defined(METAMER_SYSTEMS_VOLUMES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_VOLUMES_INL_H_
#undef METAMER_SYSTEMS_VOLUMES_INL_H_
#else
#define METAMER_SYSTEMS_VOLUMES_INL_H_
#endif

#include "engine/simd/math-inl.h"
#include "engine/spectrum/spectrum-inl.h"
#include "systems/lanes-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// Per metre.
struct VolumeCoefficients {
  VF absorption[4], scattering[4], extinction[4];
};

HWY_INLINE VolumeCoefficients volume_coefficients(const World& world, VU volume, const VF lambda_nm[4]) {
  const VolumeColumns& table = world.volumes;
  const SpectrumView spectra = world.spectra.view();
  const VI row = as_index(volume);
  const VF scale = gather(table.scale.data(), row);
  VolumeCoefficients c;
  eval_spectrum4(spectra, gather(table.sigma_a.data(), row), lambda_nm, c.absorption);
  eval_spectrum4(spectra, gather(table.sigma_s.data(), row), lambda_nm, c.scattering);
  for (size_t j = 0; j < 4; ++j) {
    c.absorption[j] = hn::Mul(c.absorption[j], scale);
    c.scattering[j] = hn::Mul(c.scattering[j], scale);
    c.extinction[j] = hn::Add(c.absorption[j], c.scattering[j]);
  }
  return c;
}

// 0 where there is nothing, however far.
HWY_INLINE VF optical_depth(VF per_metre, VF metres) {
  return hn::IfThenElseZero(hn::Gt(per_metre, hn::Zero(FloatTag())), hn::Mul(per_metre, metres));
}

// (1 - exp(-x)) / x for x >= 0, infinity included: the mean of exp over a stretch. By its series below 0.03, where the
// difference cancels. Relative error 5e-6.
HWY_INLINE VF mean_transmittance(VF x) {
  const VF one = splat(1.0f);
  const VF series = hn::NegMulAdd(x, hn::NegMulAdd(x, splat(1.0f / 6), splat(0.5f)), one);
  const VF small = splat(0.03f);
  return hn::IfThenElse(hn::Lt(x, small), series, hn::Div(hn::Sub(one, exp(hn::Neg(x))), hn::Max(x, small)));
}

// What a stretch adds to the radiance that comes through it, divided by the throughput there: the integral of sigma_a
// L_e exp(-sigma_t s) over its length. Nothing where nothing glows.
HWY_INLINE void glow(const World& world, VU volume, const VF lambda_nm[4], const VolumeCoefficients& c, VF metres,
                     VF out[4]) {
  const VI row = as_index(volume);
  const VF zero = hn::Zero(FloatTag());
  eval_spectrum4(world.spectra.view(), gather(world.volumes.emission.data(), row), lambda_nm, out);
  const VF scale = gather(world.volumes.emission_scale.data(), row);
  const MF endless = hn::Eq(metres, hn::Inf(FloatTag()));
  for (size_t j = 0; j < 4; ++j) {
    const VF mean = mean_transmittance(optical_depth(c.extinction[j], hn::IfThenZeroElse(endless, metres)));
    const VF length = hn::IfThenElse(endless, hn::Div(splat(1.0f), c.extinction[j]), hn::Mul(metres, mean));
    const MF glows = hn::And(hn::Gt(c.absorption[j], zero), hn::Gt(out[j], zero));
    out[j] = hn::IfThenElseZero(glows, hn::Mul(hn::Mul(out[j], scale), hn::Mul(c.absorption[j], length)));
  }
}

// What happens on a stretch of so many metres to rays whose leading wavelength is scattered after `depth_left`, an
// optical depth: whether and where they are scattered, and the factor of throughput on each wavelength. With `share`
// not null that is by multiple importance over the leads (A. Wilkie et al., "Hero Wavelength Spectral Sampling", CGF
// 33(4), 2014; B. Miller, I. Georgiev, W. Jarosz, "A Null-Scattering Path Integral Formulation of Light Transport", ACM
// TOG 38(4), 2019, section 5.1): f_j / mean_i(share_i p_i), with `live` wavelengths in the mean; the shares follow. p_j
// is the density of being scattered there, or the probability of getting through, had wavelength j led.
struct FreePath {
  MF is_scattered;
  VF metres;  // to the scattering
  VF factor[4];
};
HWY_INLINE FreePath sample_free_path(const VolumeCoefficients& c, VF metres, VF depth_left, float live, VF* share) {
  const VF one = splat(1.0f), zero = hn::Zero(FloatTag());
  FreePath path;
  path.is_scattered = hn::Gt(optical_depth(c.extinction[0], metres), depth_left);
  path.metres = hn::Div(depth_left, hn::IfThenElse(path.is_scattered, c.extinction[0], one));
  if (share == nullptr) {  // the same on all wavelengths
    const VF extinction = hn::IfThenElse(path.is_scattered, c.extinction[0], one);
    for (size_t j = 0; j < 4; ++j)
      path.factor[j] = hn::IfThenElse(path.is_scattered, hn::Div(c.scattering[j], extinction), one);
    return path;
  }
  const VF length = hn::IfThenElse(path.is_scattered, path.metres, metres);
  VF p[4], sum = zero;
  for (size_t j = 0; j < 4; ++j) {
    const VF passes = exp(hn::Neg(optical_depth(c.extinction[j], length)));
    p[j] = hn::Mul(passes, hn::IfThenElse(path.is_scattered, c.extinction[j], one));
    path.factor[j] = hn::Mul(passes, hn::IfThenElse(path.is_scattered, c.scattering[j], one));
    sum = hn::MulAdd(share[j], p[j], sum);
  }
  // Where the lead's own likelihood is gone to rounding nothing is left to weigh; the path ends.
  const VF mean = hn::Mul(sum, splat(1 / live));
  const VF inverse = hn::IfThenElseZero(hn::Gt(mean, zero), hn::Div(one, hn::Max(mean, splat(1e-37f))));
  for (size_t j = 0; j < 4; ++j) {
    path.factor[j] = hn::Mul(path.factor[j], inverse);
    share[j] = hn::Mul(hn::Mul(share[j], p[j]), inverse);
  }
  return path;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
