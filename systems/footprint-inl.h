// What a texture lookup stands for: a disc as wide as a part of a pixel of the camera, seen from the camera and thrown
// onto the surface. Where the path comes from does not matter, as in pbrt-v4 (Camera::Approximate_dp_dxy): paths carry
// nothing for it, and surfaces seen in mirrors are as far away as they are from the camera itself.
#if defined(METAMER_SYSTEMS_FOOTPRINT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_FOOTPRINT_INL_H_
#undef METAMER_SYSTEMS_FOOTPRINT_INL_H_
#else
#define METAMER_SYSTEMS_FOOTPRINT_INL_H_
#endif

#include "engine/ecs/world.h"
#include "engine/simd/math-inl.h"
#include "systems/surface_slopes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// Diameters of the ellipse on the surface, metres.
struct Footprint {
  Vec3 shortest, longest;
};
// `normal` is the geometric one. Seen at a grazing angle the ellipse is at most 1000 times as long as wide.
HWY_INLINE Footprint footprint(const CameraRow& camera, const Vec3& position, const Vec3& normal) {
  const VF one = splat(1.0f);
  const auto splat_of = [](const float(&v)[3]) { return Vec3{splat(v[0]), splat(v[1]), splat(v[2])}; };
  const bool parallel = camera.kind == CameraKind::orthographic;
  const Vec3 from_camera = parallel ? splat_of(camera.axis) : position - splat_of(camera.origin);
  const VF distance = hn::Sqrt(dot(from_camera, from_camera));
  const Vec3 direction = from_camera * safe_reciprocal(distance);
  const VF width = hn::MulAdd(splat(camera.footprint_angle), distance, splat(camera.footprint_width));
  const VF cosine = hn::Max(hn::Abs(dot(direction, normal)), splat(1e-3f));
  const Vec3 across = cross(normal, direction);
  const VF sine2 = dot(across, across);
  const MF oblique = hn::Gt(sine2, splat(1e-8f));
  const Vec3 unit =
      if_then_else(oblique, across * hn::Div(one, hn::Sqrt(hn::Max(sine2, splat(1e-8f)))), make_frame(normal).s);
  return {unit * width, cross(normal, unit) * hn::Div(width, cosine)};
}

// The same as steps of the surface's coordinates: u and v along the shortest diameter, u and v along the longest one;
// by least squares, 0 where the coordinates do not span the surface.
HWY_INLINE void uv_footprint(const CameraRow& camera, const Vec3& position, const Vec3& normal, const Slopes& slopes,
                             VF out[4]) {
  const Footprint on_surface = footprint(camera, position, normal);
  // The longer slope becomes 1: squares of squares stay within float's range.
  const VF uu = dot(slopes.along_u, slopes.along_u), vv = dot(slopes.along_v, slopes.along_v);
  const VF inverse_u = safe_reciprocal(hn::Sqrt(uu)), inverse_v = safe_reciprocal(hn::Sqrt(vv));
  const Vec3 unit_u = slopes.along_u * inverse_u, unit_v = slopes.along_v * inverse_v;
  const VF uv = dot(unit_u, unit_v);
  const VF sine2 = hn::NegMulAdd(uv, uv, splat(1.0f));
  const MF known = hn::And(hn::Gt(hn::Min(uu, vv), hn::Zero(FloatTag())), hn::Gt(sine2, splat(1e-6f)));
  const VF inverse = hn::IfThenElseZero(known, hn::Div(splat(1.0f), hn::Max(sine2, splat(1e-6f))));
  const Vec3 steps[2] = {on_surface.shortest, on_surface.longest};
  for (int k = 0; k < 2; ++k) {
    const VF along_u = dot(steps[k], unit_u), along_v = dot(steps[k], unit_v);
    out[2 * k] = hn::Mul(hn::Mul(hn::NegMulAdd(uv, along_v, along_u), inverse), inverse_u);
    out[2 * k + 1] = hn::Mul(hn::Mul(hn::NegMulAdd(uv, along_u, along_v), inverse), inverse_v);
  }
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
