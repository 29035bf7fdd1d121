// What `surface` finds out about a hit.
#if defined(METAMER_SYSTEMS_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_SURFACE_INL_H_
#undef METAMER_SYSTEMS_SURFACE_INL_H_
#else
#define METAMER_SYSTEMS_SURFACE_INL_H_
#endif

#include "engine/ecs/world.h"
#include "engine/simd/math-inl.h"
#include "systems/footprint-inl.h"
#include "systems/lanes-inl.h"
#include "systems/surface_slopes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

HWY_INLINE Vec3 abs(const Vec3& v) { return {hn::Abs(v.x), hn::Abs(v.y), hn::Abs(v.z)}; }
HWY_INLINE Vec3 max(const Vec3& a, const Vec3& b) { return {hn::Max(a.x, b.x), hn::Max(a.y, b.y), hn::Max(a.z, b.z)}; }
HWY_INLINE VF largest(const Vec3& v) { return hn::Max(hn::Max(v.x, v.y), v.z); }

struct Surface {
  Vec3 position, normal, shading_normal, tangent;
  VF u, v;
  VF offset;
  SurfaceSlopes slopes;  // where the world has bumps
  VF footprint[4];       // where it has mips; ShadeStream's
};

// Unit roundoff of float.
inline constexpr float eps = 5.9604645e-8f;

HWY_INLINE Surface select(MF mask, const Surface& yes, const Surface& no) {
  Surface s;
  s.position = if_then_else(mask, yes.position, no.position);
  s.normal = if_then_else(mask, yes.normal, no.normal);
  s.shading_normal = if_then_else(mask, yes.shading_normal, no.shading_normal);
  s.tangent = if_then_else(mask, yes.tangent, no.tangent);
  s.u = hn::IfThenElse(mask, yes.u, no.u);
  s.v = hn::IfThenElse(mask, yes.v, no.v);
  s.offset = hn::IfThenElse(mask, yes.offset, no.offset);
  s.slopes = if_then_else(mask, yes.slopes, no.slopes);
  for (int k = 0; k < 4; ++k) s.footprint[k] = hn::IfThenElse(mask, yes.footprint[k], no.footprint[k]);
  return s;
}

HWY_INLINE MF is_kind(VU kind, ShapeKind wanted) {
  return float_mask(hn::Eq(kind, splat_u(static_cast<uint32_t>(wanted))));
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
