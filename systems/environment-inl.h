// Directions from infinity: the mappings of images, and the density with which directions of an environment are drawn.
#if defined(METAMER_SYSTEMS_ENVIRONMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_ENVIRONMENT_INL_H_
#undef METAMER_SYSTEMS_ENVIRONMENT_INL_H_
#else
#define METAMER_SYSTEMS_ENVIRONMENT_INL_H_
#endif

#include "engine/sampling/distribution-inl.h"
#include "engine/sampling/warps-inl.h"
#include "engine/sampling/window_distribution-inl.h"
#include "engine/simd/math-inl.h"
#include "systems/lanes-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

HWY_INLINE Vec3 rotate(const float (&m)[9], const Vec3& v) {
  const auto row = [&](int r) {
    return hn::MulAdd(splat(m[3 * r]), v.x, hn::MulAdd(splat(m[3 * r + 1]), v.y, hn::Mul(splat(m[3 * r + 2]), v.z)));
  };
  return {row(0), row(1), row(2)};
}

// A point of the environment image's unit square and the solid angle of the sphere per unit of its area there.
struct ImagePoint {
  VF u, v, solid_angle;
};

// latitude_longitude: z up; u is the longitude atan2(y, x) / 2 pi, v the angle from +z over pi.
// equal_area: Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD", JGT 13(3), 2008, as pbrt-v4.
HWY_INLINE ImagePoint latitude_longitude_point(const Vec3& d) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  VF u = hn::Mul(atan2(d.y, d.x), splat(0.5f * inverse_pi));
  u = hn::IfThenElse(hn::Lt(u, zero), hn::Add(u, one), u);
  const VF sin_theta = hn::Sqrt(hn::MulAdd(d.x, d.x, hn::Mul(d.y, d.y)));
  const VF v = hn::Mul(atan2(sin_theta, d.z), splat(inverse_pi));
  return {hn::Min(u, splat(0x1.fffffep-1f)), clamp(v, 0.0f, 0x1.fffffep-1f), hn::Mul(splat(2 * pi * pi), sin_theta)};
}
HWY_INLINE Vec3 latitude_longitude_direction(VF u, VF v, VF* solid_angle) {
  const SinCos phi = sincos_2pi(u), theta = sincos_2pi(hn::Mul(v, splat(0.5f)));
  *solid_angle = hn::Mul(splat(2 * pi * pi), theta.sin);
  return {hn::Mul(theta.sin, phi.cos), hn::Mul(theta.sin, phi.sin), theta.cos};
}

HWY_INLINE ImagePoint equal_area_point(const Vec3& d) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f), half = splat(0.5f);
  const VF x = hn::Abs(d.x), y = hn::Abs(d.y), z = hn::Abs(d.z);
  const VF r = safe_sqrt(hn::Sub(one, z));
  const VF larger = hn::Max(x, y), smaller = hn::Min(x, y);
  const VF ratio = hn::IfThenElse(hn::Gt(larger, zero), hn::Div(smaller, hn::Max(larger, splat(1e-30f))), zero);
  VF phi = hn::Mul(atan2(ratio, one), splat(2 * inverse_pi));
  phi = hn::IfThenElse(hn::Lt(x, y), hn::Sub(one, phi), phi);
  VF v = hn::Mul(phi, r), u = hn::Sub(r, v);
  const MF south = hn::Lt(d.z, zero);
  const VF folded_u = hn::Sub(one, v), folded_v = hn::Sub(one, u);
  u = hn::IfThenElse(south, folded_u, u);
  v = hn::IfThenElse(south, folded_v, v);
  u = hn::MulAdd(hn::CopySign(u, d.x), half, half);
  v = hn::MulAdd(hn::CopySign(v, d.y), half, half);
  return {clamp(u, 0.0f, 0x1.fffffep-1f), clamp(v, 0.0f, 0x1.fffffep-1f), splat(4 * pi)};
}
HWY_INLINE Vec3 equal_area_direction(VF image_u, VF image_v) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const VF u = hn::MulSub(splat(2.0f), image_u, one), v = hn::MulSub(splat(2.0f), image_v, one);
  const VF au = hn::Abs(u), av = hn::Abs(v);
  const VF signed_distance = hn::Sub(one, hn::Add(au, av));
  const VF r = hn::Sub(one, hn::Abs(signed_distance));
  const VF phi =
      hn::IfThenElse(hn::Eq(r, zero), one, hn::Add(hn::Div(hn::Sub(av, au), hn::Max(r, splat(1e-30f))), one));
  const SinCos angle = sincos_2pi(hn::Mul(phi, splat(0.125f)));  // phi pi / 4
  const VF z = hn::CopySign(hn::NegMulAdd(r, r, one), signed_distance);
  const VF radius = hn::Mul(r, safe_sqrt(hn::NegMulAdd(r, r, splat(2.0f))));
  return {hn::CopySign(hn::Mul(angle.cos, radius), u), hn::CopySign(hn::Mul(angle.sin, radius), v), z};
}

HWY_INLINE ImagePoint image_point(ImageMapping mapping, const Vec3& local) {
  return mapping == ImageMapping::equal_area ? equal_area_point(local) : latitude_longitude_point(local);
}

// Where a direction away from the scene leads through the portal's rectangle, from a point before it.
HWY_INLINE MF through_portal(const Portal& portal, const Vec3& from, const Vec3& direction) {
  const VF zero = hn::Zero(FloatTag());
  const Vec3 corner = {splat(portal.corner[0]), splat(portal.corner[1]), splat(portal.corner[2])};
  const Vec3 to_corner = rotate(portal.frame, corner - from), along = rotate(portal.frame, direction);
  const VF t = hn::Div(to_corner.z, along.z);
  const VF x = hn::MulSub(t, along.x, to_corner.x), y = hn::MulSub(t, along.y, to_corner.y);
  const MF before = hn::And(hn::Gt(to_corner.z, zero), hn::Gt(along.z, zero));
  const MF in_x = hn::And(hn::Ge(x, zero), hn::Le(x, splat(portal.width)));
  return hn::And(hn::And(before, in_x), hn::And(hn::Ge(y, zero), hn::Le(y, splat(portal.height))));
}

// The part of the square of angles (see Portal) that a point sees; empty behind the portal.
HWY_INLINE VF angle_coordinate(VF across, VF along) {
  return hn::MulAdd(atan2(across, along), splat(inverse_pi), splat(0.5f));
}
HWY_INLINE WindowV portal_window(const Portal& portal, const Vec3& from) {
  const VF zero = hn::Zero(FloatTag());
  const Vec3 corner = {splat(portal.corner[0]), splat(portal.corner[1]), splat(portal.corner[2])};
  const Vec3 q = rotate(portal.frame, corner - from);
  const MF before = hn::Gt(q.z, zero);
  const WindowV window = {angle_coordinate(q.x, q.z), angle_coordinate(q.y, q.z),
                          angle_coordinate(hn::Add(q.x, splat(portal.width)), q.z),
                          angle_coordinate(hn::Add(q.y, splat(portal.height)), q.z)};
  return {window.x0, window.y0, hn::IfThenElse(before, window.x1, window.x0), window.y1};
}
// Area of the square of angles per solid angle, at a direction in the portal's frame: z / (pi^2 (1 - x^2) (1 - y^2)).
HWY_INLINE VF portal_jacobian(const Vec3& along) {
  const VF one = splat(1.0f);
  const VF product = hn::Mul(hn::NegMulAdd(along.x, along.x, one), hn::NegMulAdd(along.y, along.y, one));
  return hn::Div(hn::Mul(along.z, splat(inverse_pi * inverse_pi)), hn::Max(product, splat(1e-20f)));
}

struct EnvironmentSample {
  Vec3 direction;
  VF pdf;  // per solid angle; 0: no light from there
  VF image_u, image_v;
};
HWY_INLINE EnvironmentSample sample_portal(const Environment& environment, const Vec3& from, VF u, VF v) {
  const Portal& portal = environment.portal;
  const WindowSampleV at = sample_window(portal.density, portal_window(portal, from), u, v);
  const SinCos a = sincos_2pi(hn::Mul(hn::Sub(at.x, splat(0.5f)), splat(0.5f)));
  const SinCos b = sincos_2pi(hn::Mul(hn::Sub(at.y, splat(0.5f)), splat(0.5f)));
  const Vec3 along = normalize(Vec3{hn::Mul(a.sin, b.cos), hn::Mul(b.sin, a.cos), hn::Mul(a.cos, b.cos)});
  const auto row = [&](int r) {
    return Vec3{splat(portal.frame[3 * r]), splat(portal.frame[3 * r + 1]), splat(portal.frame[3 * r + 2])};
  };
  const Vec3 direction = mul_add(row(0), along.x, mul_add(row(1), along.y, row(2) * along.z));
  const ImagePoint point = image_point(environment.mapping, rotate(environment.to_local, direction));
  return {direction, hn::Mul(at.pdf, portal_jacobian(along)), point.u, point.v};
}
HWY_INLINE EnvironmentSample sample_sphere(const Environment& environment, VF u, VF v) {
  const VF zero = hn::Zero(FloatTag());
  if (environment.image == no_index)
    return {rotate(environment.to_world, sample_uniform_sphere(u, v)), splat(uniform_sphere_pdf), zero, zero};
  VF solid_angle = splat(4 * pi);
  const SquareSampleV square = sample_square(environment.density, u, v);
  const Vec3 local = environment.mapping == ImageMapping::equal_area
                         ? equal_area_direction(square.x, square.y)
                         : latitude_longitude_direction(square.x, square.y, &solid_angle);
  return {rotate(environment.to_world, local), hn::Div(square.pdf, hn::Max(solid_angle, splat(1e-20f))), square.x,
          square.y};
}
HWY_INLINE EnvironmentSample sample_environment(const Environment& environment, const Vec3& from, VF u, VF v) {
  return environment.has_portal() ? sample_portal(environment, from, u, v) : sample_sphere(environment, u, v);
}

// Density per solid angle with which sample_environment draws a unit direction, whose image point this is.
HWY_INLINE VF environment_pdf(const Environment& environment, const Vec3& from, const Vec3& direction,
                              const ImagePoint& point) {
  if (environment.has_portal()) {
    const Portal& portal = environment.portal;
    const Vec3 along = rotate(portal.frame, direction);
    const VF pdf = window_pdf(portal.density, portal_window(portal, from), angle_coordinate(along.x, along.z),
                              angle_coordinate(along.y, along.z));
    return hn::Mul(pdf, portal_jacobian(along));
  }
  if (environment.image == no_index) return splat(uniform_sphere_pdf);
  const VF pdf = square_pdf(environment.density, point.u, point.v);
  return hn::Div(pdf, hn::Max(point.solid_angle, splat(1e-20f)));
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
