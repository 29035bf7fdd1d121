// Planck's law at temperatures that come from grids.
#if defined(METAMER_SYSTEMS_BLACKBODY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BLACKBODY_INL_H_
#undef METAMER_SYSTEMS_BLACKBODY_INL_H_
#else
#define METAMER_SYSTEMS_BLACKBODY_INL_H_
#endif

#include "engine/ecs/world.h"
#include "engine/simd/math-inl.h"
#include "engine/spectrum/spectrum-inl.h"
#include "systems/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// Planck's radiance divided by its peak over all wavelengths, for kelvin > 0: with y = c2 / (lambda T) that is
// (y / x)^5 (e^x - 1) / (e^y - 1), x = 4.965 where the peak is (Wien). Twin: planck_radiance(). Relative error below
// 1e-6 + 1.5e-7 y; 0 where y is beyond 87.
HWY_INLINE VF blackbody_shape(VF kelvin, VF lambda_nm) {
  constexpr float second_radiation_constant = 1.438776877e7f;  // nm K, CODATA 2018
  constexpr float peak = 0.0471666172f;                        // (e^x - 1) / x^5
  const VF one = splat(1.0f);
  const VF y = hn::Div(splat(second_radiation_constant), hn::Mul(kelvin, lambda_nm));
  const VF series =
      hn::Mul(y, hn::MulAdd(y, hn::MulAdd(y, hn::MulAdd(y, splat(1.0f / 24), splat(1.0f / 6)), splat(0.5f)), one));
  const VF bounded = hn::Min(y, splat(87.0f));
  const VF less_one = hn::IfThenElse(hn::Lt(y, splat(0.1f)), series, hn::Sub(exp(bounded), one));
  const VF y2 = hn::Mul(y, y);
  const VF value = hn::Div(hn::Mul(splat(peak), hn::Mul(hn::Mul(y2, y2), y)), less_one);
  return hn::IfThenElseZero(hn::Lt(y, splat(87.0f)), value);
}

// The peak, W m^-2 sr^-1 nm^-1: as the fifth power of the temperature.
HWY_INLINE VF blackbody_peak(VF kelvin) {
  constexpr float at_1_kelvin = 4.09567467e-15f;
  const VF k2 = hn::Mul(kelvin, kelvin);
  return hn::Mul(hn::Mul(hn::Mul(k2, k2), splat(at_1_kelvin)), kelvin);
}

// The same as paths carry it: on a wavelength, or in the modes of coefficients of the channel that stands for.
HWY_INLINE VF blackbody(const World& world, VF kelvin, VF lambda_nm) {
  if (world.blackbody_coefficients.empty()) return blackbody_shape(kelvin, lambda_nm);
  constexpr float first = 4.60517019f, last = 13.8155106f;  // logarithms of blackbody_coldest and blackbody_hottest
  constexpr float steps = static_cast<float>(blackbody_steps - 1);
  const VF place = clamp(hn::Mul(hn::Sub(log(kelvin), splat(first)), splat(steps / (last - first))), 0.0f, steps);
  const VF below = hn::Min(hn::Floor(place), splat(steps - 1));
  VI index = hn::ConvertTo(IntTag(), below);
  index = hn::Add(hn::Add(index, hn::Add(index, index)), channel_of(lambda_nm));
  const float* const table = world.blackbody_coefficients.data();
  const VF a = gather(table, index), b = gather(table + 3, index);
  return hn::MulAdd(hn::Sub(place, below), hn::Sub(b, a), a);
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
