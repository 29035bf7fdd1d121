// Radiance from infinity by direction, and the density of its directions.
#if defined(METAMER_SYSTEMS_ENVIRONMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_ENVIRONMENT_INL_H_
#undef METAMER_SYSTEMS_ENVIRONMENT_INL_H_
#else
#define METAMER_SYSTEMS_ENVIRONMENT_INL_H_
#endif

#include "engine/sampling/distribution-inl.h"
#include "engine/simd/math-inl.h"
#include "engine/spectrum/spectrum-inl.h"
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

HWY_INLINE ImagePoint image_point(const Environment& environment, const Vec3& local) {
  return environment.mapping == ImageMapping::equal_area ? equal_area_point(local) : latitude_longitude_point(local);
}

// factor += weight times the spectrum of a texel.
HWY_INLINE void add_texel(const Environment& environment, VI column, VI row, VF weight, const VF lambda_nm[4],
                          VF factor[4]) {
  const VI texel = hn::Add(hn::Mul(row, hn::Set(IntTag(), static_cast<int>(environment.width))), column);
  const VI at = hn::ShiftLeft<2>(texel);
  const float* texels = environment.texels.data();
  if (environment.has_coefficients) {
    for (int j = 0; j < 4; ++j)
      factor[j] = hn::MulAdd(weight, gather(texels, hn::Add(at, channel_of(lambda_nm[j]))), factor[j]);
    return;
  }
  const VF c0 = gather(texels, at), c1 = gather(texels + 1, at), c2 = gather(texels + 2, at);
  const VF scale = hn::Mul(weight, gather(texels + 3, at));
  for (int j = 0; j < 4; ++j) factor[j] = hn::MulAdd(scale, sigmoid_polynomial(c0, c1, c2, lambda_nm[j]), factor[j]);
}

// The image at (u, v), as a factor on the environment's spectrum. latitude_longitude: linear between texels' centres,
// around the circle and clamped at the poles. equal_area: the texel itself, as in pbrt, whose files these are.
// The density of directions stays constant on a texel: where a dark texel next to a bright one is never chosen, rays
// of the BSDF find its light with full weight.
HWY_INLINE void environment_image(const Environment& environment, VF u, VF v, const VF lambda_nm[4], VF factor[4]) {
  const IntTag di;
  const int width = static_cast<int>(environment.width), height = static_cast<int>(environment.height);
  const VF x = hn::Mul(u, splat(static_cast<float>(width))), y = hn::Mul(v, splat(static_cast<float>(height)));
  const VI last_column = hn::Set(di, width - 1), last_row = hn::Set(di, height - 1), zero = hn::Zero(di);
  for (int j = 0; j < 4; ++j) factor[j] = hn::Zero(FloatTag());
  if (environment.mapping == ImageMapping::equal_area) {
    add_texel(environment, hn::Min(hn::ConvertTo(di, x), last_column), hn::Min(hn::ConvertTo(di, y), last_row),
              splat(1.0f), lambda_nm, factor);
    return;
  }
  const VF one = splat(1.0f), half = splat(0.5f);
  const VF x_floor = hn::Floor(hn::Sub(x, half)), y_floor = hn::Floor(hn::Sub(y, half));
  const VF right = hn::Sub(hn::Sub(x, half), x_floor), lower = hn::Sub(hn::Sub(y, half), y_floor);
  const VI left = hn::ConvertTo(di, x_floor), top = hn::ConvertTo(di, y_floor);
  const VI column0 = hn::IfThenElse(hn::Lt(left, zero), last_column, hn::Min(left, last_column));
  const VI column1 = hn::IfThenElse(hn::Lt(left, last_column), hn::Add(left, hn::Set(di, 1)), zero);
  const VI row0 = hn::Max(hn::Min(top, last_row), zero);
  const VI row1 = hn::Max(hn::Min(hn::Add(top, hn::Set(di, 1)), last_row), zero);
  const VF left_share = hn::Sub(one, right), upper_share = hn::Sub(one, lower);
  add_texel(environment, column0, row0, hn::Mul(left_share, upper_share), lambda_nm, factor);
  add_texel(environment, column1, row0, hn::Mul(right, upper_share), lambda_nm, factor);
  add_texel(environment, column0, row1, hn::Mul(left_share, lower), lambda_nm, factor);
  add_texel(environment, column1, row1, hn::Mul(right, lower), lambda_nm, factor);
}

// Density per solid angle of a world direction, the choice of the light apart.
HWY_INLINE VF environment_pdf(const Environment& environment, const ImagePoint& point) {
  if (environment.width == 0) return splat(0.25f * inverse_pi);
  const VF pdf = square_pdf(environment.density, point.u, point.v);
  return hn::Div(pdf, hn::Max(point.solid_angle, splat(1e-20f)));
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
