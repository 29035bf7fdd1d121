// What a light emits and with which density light_sample would have chosen a direction towards it: shared by
// light_sample and emission, so that the two sides of multiple importance sampling cannot disagree.
#if defined(METAMER_SYSTEMS_LIGHTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_LIGHTS_INL_H_
#undef METAMER_SYSTEMS_LIGHTS_INL_H_
#else
#define METAMER_SYSTEMS_LIGHTS_INL_H_
#endif

#include "engine/sampling/distribution-inl.h"
#include "engine/sampling/warps-inl.h"
#include "engine/simd/math-inl.h"
#include "engine/spectrum/spectrum-inl.h"
#include "systems/environment-inl.h"
#include "systems/lanes-inl.h"
#include "systems/light_image-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// The rows of World::lights as floats, for gathers; `offset` names a field.
struct LightFields {
  const float* base;
  VI light;
  VI row;  // first float of each lane's row
  HWY_INLINE LightFields(const World& world, VI lights)
      : base(reinterpret_cast<const float*>(world.lights.data())), light(lights), row(hn::ShiftLeft<5>(lights)) {}
  HWY_INLINE VF number(size_t offset) const { return gather(base + offset / sizeof(float), row); }
  HWY_INLINE VU word(size_t offset) const { return hn::BitCast(UintTag(), number(offset)); }
  HWY_INLINE Vec3 vector(size_t offset) const { return gather_vec3(base + offset / sizeof(float), row); }
};

HWY_INLINE MF is_shape(VU shape, LightShape wanted) {
  return float_mask(hn::Eq(shape, splat_u(static_cast<uint32_t>(wanted))));
}

// Veach's power heuristic with exponent 2 for a sample drawn with pdf `a` where `b` could have drawn it, too
// (Robust Monte Carlo Methods for Light Transport Simulation, 1997, section 9.2.2). In the ratio, so as not to
// overflow.
HWY_INLINE VF power_heuristic(VF a, VF b) {
  const VF ratio = hn::Div(b, a);
  return hn::Div(splat(1.0f), hn::MulAdd(ratio, ratio, splat(1.0f)));
}

// Radiance of the lanes' lights (spectrum times scale) at the path's wavelengths, images apart.
HWY_INLINE void light_spectrum(const World& world, const LightFields& light, const VF lambda_nm[4], VF out[4]) {
  eval_spectrum4(world.spectra.view(), light.word(offsetof(LightRow, spectrum)), lambda_nm, out);
  const VF scale = light.number(offsetof(LightRow, scale));
  for (int j = 0; j < 4; ++j) out[j] = hn::Mul(out[j], scale);
}

// Times the images of the lanes' lights at these points, where they have one.
HWY_INLINE void apply_image(const World& world, const LightFields& light, VF u, VF v, const VF lambda_nm[4],
                            VF radiance[4]) {
  if (world.light_images.rows.empty()) return;
  const VU image = gather(world.image_of_light.data(), light.light);
  const auto has_image = hn::Ne(image, splat_u(no_index));
  if (hn::AllFalse(UintTag(), has_image)) return;
  VF factor[4];
  light_image(world.light_images, as_index(hn::IfThenElseZero(has_image, image)), u, v, lambda_nm, factor);
  for (int j = 0; j < 4; ++j)
    radiance[j] = hn::Mul(radiance[j], hn::IfThenElse(float_mask(has_image), factor[j], splat(1.0f)));
}

// How much of its radiance a shape sends to the angle whose cosine (of either sign) this is.
HWY_INLINE VF emission_profile(const LightFields& light, VF cos_light) {
  const VF power = light.number(offsetof(LightRow, cosine_power)), one = splat(1.0f);
  if (hn::AllTrue(FloatTag(), hn::Eq(power, hn::Zero(FloatTag())))) return one;
  return pow(hn::Min(hn::Abs(cos_light), one), power);
}

// How much of its intensity a spot sends along a unit direction: smoothstep in the cosine of the angle to the axis,
// from 1 where the falloff starts to 0 at the cone, as pbrt-v4. 1 - cos of two unit vectors is half their difference
// squared, which keeps its digits in narrow cones.
HWY_INLINE VF spot_falloff(const LightFields& light, const Vec3& direction) {
  const Vec3 off = direction - light.vector(offsetof(LightRow, normal));
  const size_t cone = offsetof(LightRow, axes);
  const VF inside = hn::NegMulAdd(splat(0.5f), dot(off, off), light.number(cone));
  const VF t = clamp(hn::Mul(inside, light.number(cone + 4)), 0.0f, 1.0f);
  return hn::Mul(hn::Mul(t, t), hn::NegMulAdd(splat(2.0f), t, splat(3.0f)));
}

// The image point to which a goniometric light or a projection sends a direction, with any length; `inside`: it does.
struct LightImagePoint {
  VF u, v;
  MF inside;
};
HWY_INLINE Vec3 light_local(const LightFields& light, const Vec3& v) {
  const size_t inverse = offsetof(LightRow, inverse);
  return {dot(light.vector(inverse), v), dot(light.vector(inverse + 12), v), dot(light.vector(inverse + 24), v)};
}
HWY_INLINE LightImagePoint goniometric_point(const LightFields& light, const Vec3& direction) {
  const Vec3 local = normalize(light_local(light, direction));
  const ImagePoint equal_area = equal_area_point(local), angles = latitude_longitude_point(local);
  const VU mapping = light.word(offsetof(LightRow, mapping));
  const MF is_equal_area = float_mask(hn::Eq(mapping, splat_u(static_cast<uint32_t>(ImageMapping::equal_area))));
  return {hn::IfThenElse(is_equal_area, equal_area.u, angles.u), hn::IfThenElse(is_equal_area, equal_area.v, angles.v),
          hn::Eq(local.x, local.x)};
}
HWY_INLINE LightImagePoint projection_point(const LightFields& light, const Vec3& direction) {
  const VF zero = hn::Zero(FloatTag()), half = splat(0.5f);
  const Vec3 local = light_local(light, direction);
  const MF ahead = hn::Gt(local.z, zero);
  const size_t extent = offsetof(LightRow, axes);
  const VF right = hn::Div(local.x, hn::Mul(local.z, light.number(extent)));
  const VF up = hn::Div(local.y, hn::Mul(local.z, light.number(extent + 4)));
  const MF inside = hn::And(hn::Le(hn::Abs(right), splat(1.0f)), hn::Le(hn::Abs(up), splat(1.0f)));
  const VF u = hn::MulAdd(half, right, half), v = hn::NegMulAdd(half, up, half);
  const MF all = hn::And(ahead, inside);
  return {hn::IfThenElseZero(all, u), hn::IfThenElseZero(all, v), all};
}

// The image point of a surface's (u, v), v up.
HWY_INLINE void store_uv(MF mask, VF u, VF v, VF* image_u, VF* image_v) {
  *image_u = hn::IfThenElse(mask, u, *image_u);
  *image_v = hn::IfThenElse(mask, hn::Sub(splat(1.0f), v), *image_v);
}
// Of a sphere's (u, v) at a point of the unit sphere, as in systems/surface.cpp: v is down from the pole, as the
// image's, or from the highest circle to the lowest one of a part.
HWY_INLINE void store_sphere_uv(const LightFields& light, MF mask, const Vec3& q, VF* image_u, VF* image_v) {
  const VF one = splat(1.0f), zero = hn::Zero(FloatTag());
  const ImagePoint point = latitude_longitude_point(q);
  const Vec3 range = light.vector(offsetof(LightRow, normal));
  const auto from_pole = [&](VF z) {
    return hn::Mul(atan2(safe_sqrt(hn::Mul(hn::Sub(one, z), hn::Add(one, z))), z), splat(inverse_pi));
  };
  const VF top = from_pole(range.y), width = hn::Sub(from_pole(range.x), top);
  const VF u = hn::Mul(point.u, safe_reciprocal(range.z));
  const VF v = hn::Mul(hn::Sub(point.v, top), safe_reciprocal(width));
  *image_u = hn::IfThenElse(mask, hn::Min(u, one), *image_u);
  *image_v = hn::IfThenElse(mask, hn::Min(hn::Max(v, zero), one), *image_v);
}

// The cone under which a sphere is seen from outside.
struct SphereCone {
  Vec3 axis;              // unit, to the centre
  VF distance2, radius2;  // of the centre; of the sphere
  VF one_minus_cos;       // of the half angle, without cancellation for small spheres
  MF outside;
};
HWY_INLINE SphereCone sphere_cone(const LightFields& light, const Vec3& from) {
  const VF one = splat(1.0f);
  const Vec3 to_centre = light.vector(offsetof(LightRow, p)) - from;
  const Vec3 axis_x = light.vector(offsetof(LightRow, axes));
  SphereCone cone;
  cone.radius2 = dot(axis_x, axis_x);
  cone.distance2 = dot(to_centre, to_centre);
  cone.outside = hn::Gt(cone.distance2, hn::Mul(cone.radius2, splat(1.0001f)));
  cone.axis = to_centre * hn::Div(one, hn::Sqrt(hn::Max(cone.distance2, splat(1e-30f))));
  const VF sin2 = hn::Min(hn::Div(cone.radius2, hn::Max(cone.distance2, splat(1e-30f))), one);
  cone.one_minus_cos = hn::Max(one_minus_cos(sin2), splat(1e-30f));
  return cone;
}

// Density per area of the ellipsoid's points, at a point of it: uniform on the part of the unit sphere it is the image
// of.
HWY_INLINE VF ellipsoid_area_pdf(const LightFields& light, const Vec3& unit_point) {
  const Vec3 a = light.vector(offsetof(LightRow, axes)), b = light.vector(offsetof(LightRow, axes) + 12);
  const Vec3 c = light.vector(offsetof(LightRow, axes) + 24);
  // The cofactor matrix maps the unit sphere's normal to the area vector of its image.
  const Vec3 area = mul_add(cross(b, c), unit_point.x, mul_add(cross(c, a), unit_point.y, cross(a, b) * unit_point.z));
  const Vec3 range = light.vector(offsetof(LightRow, normal));
  const VF unit_area = hn::Mul(hn::Mul(splat(2 * pi), range.z), hn::Sub(range.y, range.x));
  return hn::Div(splat(1.0f), hn::Mul(unit_area, hn::Sqrt(hn::Max(dot(area, area), splat(1e-38f)))));
}
HWY_INLINE Vec3 ellipsoid_unit_point(const LightFields& light, const Vec3& position) {
  return normalize(light_local(light, position - light.vector(offsetof(LightRow, p))));
}

// The cylinder's area vector, outwards where the axes are right-handed, per radian and part of its height.
HWY_INLINE Vec3 cylinder_area(const LightFields& light, VF cos_phi, VF sin_phi) {
  const Vec3 a = light.vector(offsetof(LightRow, axes)), b = light.vector(offsetof(LightRow, axes) + 12);
  return cross(b * cos_phi - a * sin_phi, light.vector(offsetof(LightRow, axes) + 24));
}
HWY_INLINE VF cylinder_area_pdf(const LightFields& light, const Vec3& area) {
  const VF angle = hn::Mul(splat(2 * pi), light.number(offsetof(LightRow, normal) + 8));
  return hn::Div(splat(1.0f), hn::Mul(angle, hn::Sqrt(hn::Max(dot(area, area), splat(1e-38f)))));
}

HWY_INLINE VF area_to_solid_angle(VF pdf_area, VF distance2, VF cos_light) {
  return hn::Div(hn::Mul(pdf_area, distance2), hn::Max(hn::Abs(cos_light), splat(1e-12f)));
}

// Per solid angle at `from`, with which light_sample chooses the direction to `position` on an area light of that
// normal, the choice of the light included. direction = (position - from) / distance.
HWY_INLINE VF area_light_pdf(const LightFields& light, const Vec3& from, const Vec3& position, const Vec3& normal,
                             const Vec3& direction, VF distance) {
  const VU shape = light.word(offsetof(LightRow, shape));
  VF pdf_area = hn::Div(splat(1.0f), hn::Max(light.number(offsetof(LightRow, area)), splat(1e-38f)));
  const MF ellipsoid = is_shape(shape, LightShape::ellipsoid);
  if (!hn::AllFalse(FloatTag(), ellipsoid))
    pdf_area = hn::IfThenElse(ellipsoid, ellipsoid_area_pdf(light, ellipsoid_unit_point(light, position)), pdf_area);
  const MF cylinder = is_shape(shape, LightShape::cylinder);
  if (!hn::AllFalse(FloatTag(), cylinder)) {
    const Vec3 q = light_local(light, position - light.vector(offsetof(LightRow, p)));
    const Vec3 around = normalize(Vec3{q.x, q.y, hn::Zero(FloatTag())});
    pdf_area = hn::IfThenElse(cylinder, cylinder_area_pdf(light, cylinder_area(light, around.x, around.y)), pdf_area);
  }
  VF pdf = area_to_solid_angle(pdf_area, hn::Mul(distance, distance), dot(normal, direction));
  const MF sphere = is_shape(shape, LightShape::sphere);
  if (!hn::AllFalse(FloatTag(), sphere)) {
    const SphereCone cone = sphere_cone(light, from);
    pdf = hn::IfThenElse(hn::And(sphere, cone.outside), uniform_cone_pdf(cone.one_minus_cos), pdf);
  }
  return hn::Mul(pdf, light.number(offsetof(LightRow, choice_probability)));
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
