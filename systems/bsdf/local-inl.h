// Small things every BSDF kernel shares. Local shading frame: z = shading normal, directions are unit vectors and
// point away from the surface.
#if defined(METAMER_SYSTEMS_BSDF_LOCAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_BSDF_LOCAL_INL_H_
#undef METAMER_SYSTEMS_BSDF_LOCAL_INL_H_
#else
#define METAMER_SYSTEMS_BSDF_LOCAL_INL_H_
#endif

#include "engine/simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The sign bit of x alone: flip_sign(y, sign_bit(x)) turns y over where x is negative.
HWY_INLINE VF sign_bit(VF x) { return hn::And(x, hn::SignBit(FloatTag())); }
HWY_INLINE VF flip_sign(VF y, VF sign) { return hn::Xor(y, sign); }

// A direction drawn from a BSDF. weight = f_cos / pdf for each of the four wavelengths; 0 with pdf = 0 where the draw
// is void (a microfacet that reflects below the surface). A delta lobe's pdf is its probability.
struct BsdfSample {
  Vec3 wi;
  VF weight[4];
  VF pdf;
};

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
