// Hero wavelengths for a vector of paths; see wavelengths.h. Included once per instruction set.
#if defined(METAMER_ENGINE_SPECTRUM_WAVELENGTHS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_ENGINE_SPECTRUM_WAVELENGTHS_INL_H_
#undef METAMER_ENGINE_SPECTRUM_WAVELENGTHS_INL_H_
#else
#define METAMER_ENGINE_SPECTRUM_WAVELENGTHS_INL_H_
#endif

#include "engine/simd/vec3-inl.h"
#include "engine/spectrum/wavelengths.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// Four wavelengths in nm, within 360..830, and the reciprocals of their densities in nm, from u and u_rotation in
// [0, 1). `table` is wavelength_table(). Twin: metamer::sample_wavelengths. Error: lambda 5e-5 nm (one rounding),
// inv_pdf none.
HWY_INLINE void sample_wavelengths(const WavelengthTable& table, VF u, VF u_rotation, VF lambda_nm[4],
                                   VF inv_pdf_nm[4]) {
  static_assert(wavelengths_per_path == 4);
  constexpr int segments_per_stratum = static_cast<int>(wavelength_segments / wavelengths_per_path);
  const FloatTag d;
  const IntTag di;
  // Products with powers of two: segment and fraction are exact.
  const VF position = hn::Mul(u, splat(static_cast<float>(segments_per_stratum)));
  // The bounds hold for u in [0, 1); they keep whatever is in dead lanes inside the table.
  const VI within = hn::Max(hn::Min(hn::ConvertTo(di, position), hn::Set(di, segments_per_stratum - 1)), hn::Zero(di));
  const VF fraction = hn::Sub(position, hn::ConvertTo(d, within));
  const VI rotation = hn::ConvertTo(di, hn::Mul(u_rotation, splat(4.0f)));
  for (int j = 0; j < 4; ++j) {
    const VI stratum = hn::And(hn::Add(rotation, hn::Set(di, j)), hn::Set(di, 3));
    const VI segment = hn::Add(hn::Mul(stratum, hn::Set(di, segments_per_stratum)), within);
    const VF lower = hn::GatherIndex(d, table.lower_nm.data(), segment);
    const VF width = hn::GatherIndex(d, table.width_nm.data(), segment);
    lambda_nm[j] = hn::Min(hn::MulAdd(fraction, width, lower), splat(static_cast<float>(lambda_max_nm)));
    inv_pdf_nm[j] = hn::Mul(width, splat(static_cast<float>(wavelength_segments)));
  }
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
