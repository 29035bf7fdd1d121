// How a surface's position and normal change along its coordinates u and v, for what bends shading normals.
#if defined(METAMER_SYSTEMS_SURFACE_SLOPES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_SURFACE_SLOPES_INL_H_
#undef METAMER_SYSTEMS_SURFACE_SLOPES_INL_H_
#else
#define METAMER_SYSTEMS_SURFACE_SLOPES_INL_H_
#endif

#include <cfloat>

#include "engine/ecs/world.h"
#include "engine/simd/math-inl.h"
#include "engine/simd/vec3-inl.h"
#include "systems/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

struct Slopes {
  Vec3 along_u, along_v;
};
HWY_INLINE Slopes if_then_else(MF mask, const Slopes& yes, const Slopes& no) {
  return {if_then_else(mask, yes.along_u, no.along_u), if_then_else(mask, yes.along_v, no.along_v)};
}
struct SurfaceSlopes {
  Slopes position, normal;
};
HWY_INLINE SurfaceSlopes if_then_else(MF mask, const SurfaceSlopes& yes, const SurfaceSlopes& no) {
  return {if_then_else(mask, yes.position, no.position), if_then_else(mask, yes.normal, no.normal)};
}

// Coordinates along two edges of a triangle.
struct UvEdges {
  VF du1, dv1, du2, dv2;
};
// What a function that is linear on the triangle does, from its differences along the edges; 0 where u and v are no
// coordinates of the triangle (pbrt-v4's threshold).
HWY_INLINE Slopes linear_slopes(const UvEdges& uv, const Vec3& edge1, const Vec3& edge2) {
  const VF area = hn::MulSub(uv.du1, uv.dv2, hn::Mul(uv.dv1, uv.du2));
  const VF inverse = hn::IfThenElseZero(hn::Gt(hn::Abs(area), splat(1e-9f)), hn::Div(splat(1.0f), area));
  return {(edge1 * uv.dv2 - edge2 * uv.dv1) * inverse, (edge2 * uv.du1 - edge1 * uv.du2) * inverse};
}

// Of a triangle with edges e1 and e2 and vertex normals n, used in `smooth` lanes. As in pbrt-v4 the tangent along v is
// there not that of the coordinates but perpendicular to the one along u, and as long.
HWY_INLINE SurfaceSlopes triangle_slopes(const UvEdges& uv, const Vec3& e1, const Vec3& e2, const Vec3 (&n)[3],
                                         MF smooth, const Vec3& shading_normal) {
  const VF zero = hn::Zero(FloatTag());
  const Frame any = make_frame(shading_normal);
  const Slopes p = linear_slopes(uv, e1, e2);
  const Vec3 across = cross(shading_normal, p.along_u), flat = cross(p.along_u, p.along_v);
  const MF known = hn::Gt(hn::IfThenElse(smooth, dot(across, across), dot(flat, flat)), zero);
  const Slopes turned = {cross(across, shading_normal), across};
  const Vec3 none = {zero, zero, zero};
  return {if_then_else(known, if_then_else(smooth, turned, p), Slopes{any.s, any.t}),
          if_then_else(smooth, linear_slopes(uv, n[1] - n[0], n[2] - n[0]), Slopes{none, none})};
}

// The slopes of a point of a quadric by its coordinates, those of quadric_uv in systems/surface.cpp.
HWY_INLINE Slopes quadric_slopes(const Placement& first, VI base, const Vec3& local, MF sphere, MF cylinder) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const VF radius = gather(&first.radius, base), z_min = gather(&first.z_min, base), z_max = gather(&first.z_max, base);
  const VF across = hn::Sqrt(hn::MulAdd(local.x, local.x, hn::Mul(local.y, local.y)));
  const MF centre = hn::Le(across, zero);
  const VF inverse_across = hn::Div(one, hn::Max(across, splat(FLT_MIN)));
  const VF cos_phi = hn::IfThenElse(centre, one, hn::Mul(local.x, inverse_across));
  const VF sin_phi = hn::IfThenZeroElse(centre, hn::Mul(local.y, inverse_across));
  const VF turn = gather(&first.phi_max, base), width = hn::Sub(gather(&first.inner_radius, base), radius);
  const auto polar = [&](VF z) { return atan2(safe_sqrt(hn::Mul(hn::Sub(radius, z), hn::Add(radius, z))), z); };
  const VF descent = hn::Sub(polar(hn::Min(z_max, radius)), polar(hn::Max(z_min, hn::Neg(radius))));
  const Vec3 by_polar = {hn::Mul(local.z, cos_phi), hn::Mul(local.z, sin_phi), hn::Neg(across)};
  const Vec3 inwards = {hn::Mul(width, cos_phi), hn::Mul(width, sin_phi), zero};
  const Vec3 upwards = {zero, zero, hn::IfThenElseZero(cylinder, hn::Sub(z_max, z_min))};
  return {{hn::Neg(hn::Mul(turn, local.y)), hn::Mul(turn, local.x), zero},
          if_then_else(sphere, by_polar * descent, if_then_else(cylinder, upwards, inwards))};
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
