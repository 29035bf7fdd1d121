#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/light_sample.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "engine/sampling/points-inl.h"
#include "engine/sampling/warps-inl.h"
#include "systems/dimensions.h"
#include "systems/media-inl.h"
#include "systems/positional_lights-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// Uniform on the part of the unit sphere that the light's is the image of.
HWY_INLINE Vec3 sample_unit_sphere_part(const LightFields& light, VF u, VF v) {
  const Vec3 range = light.vector(offsetof(LightRow, normal));
  const VF z = hn::NegMulAdd(u, hn::Sub(range.y, range.x), range.y);
  const VF r = safe_sqrt(hn::Mul(hn::Sub(splat(1.0f), z), hn::Add(splat(1.0f), z)));
  const SinCos phi = sincos_2pi(hn::Mul(v, range.z));
  return {hn::Mul(r, phi.cos), hn::Mul(r, phi.sin), z};
}

// Uniform over the shape's area; works for a reference point anywhere.
HWY_INLINE void sample_area(const World& world, const LightFields& light, VU shape, const Vec3& from, VF u, VF v,
                            LightSample& sample) {
  const VF one = splat(1.0f), zero = hn::Zero(FloatTag());
  const Vec3 p = light.vector(offsetof(LightRow, p));
  const Vec3 a = light.vector(offsetof(LightRow, axes)), b = light.vector(offsetof(LightRow, axes) + 12);
  const BarycentricV corner = sample_uniform_triangle(u, v);
  Vec3 point = mul_add(a, corner.b1, mul_add(b, corner.b2, p));
  Vec3 normal = light.vector(offsetof(LightRow, normal));
  VF pdf_area = hn::Div(one, hn::Max(light.number(offsetof(LightRow, area)), splat(1e-38f)));
  if (world.has_shape_images) {
    const size_t uv = offsetof(LightRow, inverse);
    const VF across = hn::MulAdd(corner.b1, light.number(uv + 8), light.number(uv));
    const VF up = hn::MulAdd(corner.b1, light.number(uv + 12), light.number(uv + 4));
    store_uv(is_shape(shape, LightShape::triangle), hn::MulAdd(corner.b2, light.number(uv + 16), across),
             hn::MulAdd(corner.b2, light.number(uv + 20), up), &sample.image_u, &sample.image_v);
  }
  const MF disk = is_shape(shape, LightShape::disk);
  if (!hn::AllFalse(FloatTag(), disk)) {
    const VF inner = light.number(offsetof(LightRow, inner));
    const VF inner2 = hn::Mul(inner, inner);
    const VF r = hn::Sqrt(hn::MulAdd(u, hn::Sub(one, inner2), inner2));
    const SinCos phi = sincos_2pi(hn::Mul(v, light.number(offsetof(LightRow, inverse))));
    const Vec3 on_disk = mul_add(a, hn::Mul(r, phi.cos), mul_add(b, hn::Mul(r, phi.sin), p));
    point = if_then_else(disk, on_disk, point);
    const VF from_rim = hn::Div(hn::Sub(one, r), hn::Max(hn::Sub(one, inner), splat(1e-38f)));
    store_uv(disk, v, from_rim, &sample.image_u, &sample.image_v);
  }
  const MF round = hn::Or(is_shape(shape, LightShape::sphere), is_shape(shape, LightShape::ellipsoid));
  if (!hn::AllFalse(FloatTag(), round)) {
    const Vec3 c = light.vector(offsetof(LightRow, axes) + 24);
    const Vec3 q = sample_unit_sphere_part(light, u, v);
    point = if_then_else(round, mul_add(a, q.x, mul_add(b, q.y, mul_add(c, q.z, p))), point);
    const VF sign = hn::IfThenElse(hn::Lt(dot(cross(a, b), c), zero), splat(-1.0f), one);
    const Vec3 area = mul_add(cross(b, c), q.x, mul_add(cross(c, a), q.y, cross(a, b) * q.z)) * sign;
    const Vec3 outside = normalize(area) * light.number(offsetof(LightRow, normal_sign));
    normal = if_then_else(round, outside, normal);
    pdf_area = hn::IfThenElse(round, ellipsoid_area_pdf(light, q), pdf_area);
    if (world.has_shape_images) store_sphere_uv(light, round, q, &sample.image_u, &sample.image_v);
  }
  const MF cylinder = is_shape(shape, LightShape::cylinder);
  if (!hn::AllFalse(FloatTag(), cylinder)) {
    const Vec3 c = light.vector(offsetof(LightRow, axes) + 24);
    const SinCos phi = sincos_2pi(hn::Mul(v, light.number(offsetof(LightRow, normal) + 8)));
    point = if_then_else(cylinder, mul_add(a, phi.cos, mul_add(b, phi.sin, mul_add(c, u, p))), point);
    const Vec3 area = cylinder_area(light, phi.cos, phi.sin);
    const VF sign = hn::IfThenElse(hn::Lt(dot(cross(a, b), c), zero), splat(-1.0f), one);
    normal =
        if_then_else(cylinder, normalize(area) * hn::Mul(sign, light.number(offsetof(LightRow, normal_sign))), normal);
    pdf_area = hn::IfThenElse(cylinder, cylinder_area_pdf(light, area), pdf_area);
    store_uv(cylinder, v, u, &sample.image_u, &sample.image_v);
  }
  const Vec3 to_light = point - from;
  const VF distance2 = hn::Max(dot(to_light, to_light), splat(1e-30f));
  sample.distance = hn::Sqrt(distance2);
  sample.direction = to_light * hn::Div(one, sample.distance);
  const VF cos_light = hn::Neg(dot(normal, sample.direction));
  const MF two_sided = float_mask(hn::Ne(light.word(offsetof(LightRow, two_sided)), splat_u(0)));
  const MF faces = hn::And(hn::Ne(cos_light, zero), hn::Or(two_sided, hn::Gt(cos_light, zero)));
  sample.pdf = area_to_solid_angle(pdf_area, distance2, cos_light);
  sample.weight = hn::IfThenElseZero(faces, hn::Div(emission_profile(light, cos_light), sample.pdf));
}

// Uniform in the cone under which a sphere is seen: Shirley, Wang, Zimmerman, "Monte Carlo Techniques for Direct
// Lighting Calculations", ACM TOG 15(1), 1996. From inside it has no cone: sample_area serves.
HWY_INLINE void sample_sphere_cone(const World& world, const LightFields& light, const Vec3& from, VF u, VF v,
                                   LightSample& sample) {
  const VF zero = hn::Zero(FloatTag());
  const SphereCone cone = sphere_cone(light, from);
  const Vec3 in_cone = sample_uniform_cone(u, v, cone.one_minus_cos);
  const Vec3 direction = to_world(make_frame(cone.axis), in_cone);
  const VF sin2 = hn::MulAdd(in_cone.x, in_cone.x, hn::Mul(in_cone.y, in_cone.y));
  const VF half_chord = safe_sqrt(hn::NegMulAdd(cone.distance2, sin2, cone.radius2));
  const VF distance = hn::MulSub(hn::Sqrt(cone.distance2), in_cone.z, half_chord);
  // The near side of a sphere that emits inwards is dark.
  const MF two_sided = float_mask(hn::Ne(light.word(offsetof(LightRow, two_sided)), splat_u(0)));
  const MF lit = hn::Or(two_sided, hn::Gt(light.number(offsetof(LightRow, normal_sign)), zero));
  const MF outside = cone.outside;
  const VF pdf = uniform_cone_pdf(cone.one_minus_cos);
  sample.direction = if_then_else(outside, direction, sample.direction);
  sample.distance = hn::IfThenElse(outside, distance, sample.distance);
  sample.pdf = hn::IfThenElse(outside, pdf, sample.pdf);
  const VF cos_light = hn::Div(half_chord, hn::Sqrt(hn::Max(cone.radius2, splat(1e-38f))));
  const VF weight = hn::Div(emission_profile(light, cos_light), pdf);
  sample.weight = hn::IfThenElse(outside, hn::IfThenElseZero(lit, weight), sample.weight);
  if (world.has_shape_images)
    store_sphere_uv(light, outside, ellipsoid_unit_point(light, mul_add(direction, distance, from)), &sample.image_u,
                    &sample.image_v);
}

// Uniform in the disc's solid angle.
HWY_INLINE void sample_distant_disk(const LightFields& light, VF u, VF v, LightSample& sample) {
  const VF half = light.number(offsetof(LightRow, axes));
  sample.direction = to_world(make_frame(light.vector(offsetof(LightRow, p))), sample_uniform_cone(u, v, half));
  sample.distance = hn::Inf(FloatTag());
  sample.pdf = uniform_cone_pdf(half);
  sample.weight = hn::Div(splat(1.0f), sample.pdf);
}

HWY_INLINE void sample_directional(const LightFields& light, LightSample& sample) {
  sample.direction = light.vector(offsetof(LightRow, p));
  sample.distance = hn::Inf(FloatTag());
  sample.pdf = hn::Zero(FloatTag());
  sample.weight = splat(1.0f);
}

HWY_INLINE void sample_environments(const World& world, const LightFields& light, const Vec3& from, VF u, VF v,
                                    LightSample& sample) {
  for (const Environment& environment : world.environments) {
    const VI row = hn::Set(IntTag(), static_cast<int>(environment.light));
    const MF chosen = hn::RebindMask(FloatTag(), hn::Eq(light.light, row));
    if (hn::AllFalse(FloatTag(), chosen)) continue;
    const EnvironmentSample drawn = sample_environment(environment, from, u, v);
    sample.direction = if_then_else(chosen, drawn.direction, sample.direction);
    sample.pdf = hn::IfThenElse(chosen, drawn.pdf, sample.pdf);
    sample.image_u = hn::IfThenElse(chosen, drawn.image_u, sample.image_u);
    sample.image_v = hn::IfThenElse(chosen, drawn.image_v, sample.image_v);
  }
  sample.distance = hn::Inf(FloatTag());
  sample.weight = hn::IfThenElseZero(hn::Gt(sample.pdf, hn::Zero(FloatTag())), hn::Div(splat(1.0f), sample.pdf));
}

HWY_INLINE LightSample select(MF mask, const LightSample& yes, const LightSample& no) {
  return {if_then_else(mask, yes.direction, no.direction), hn::IfThenElse(mask, yes.distance, no.distance),
          hn::IfThenElse(mask, yes.pdf, no.pdf),           hn::IfThenElse(mask, yes.weight, no.weight),
          hn::IfThenElse(mask, yes.image_u, no.image_u),   hn::IfThenElse(mask, yes.image_v, no.image_v)};
}

HWY_INLINE LightSample sample_light(const World& world, const LightFields& light, const Vec3& from, VF u, VF v) {
  const FloatTag d;
  const VU shape = light.word(offsetof(LightRow, shape));
  const VF zero = hn::Zero(d);
  LightSample sample{{zero, zero, zero}, zero, zero, zero, zero, zero};
  const MF area = float_mask(hn::Lt(shape, splat_u(static_cast<uint32_t>(LightShape::point))));
  if (!hn::AllFalse(d, area)) sample_area(world, light, shape, from, u, v, sample);
  const MF sphere = is_shape(shape, LightShape::sphere);
  LightSample other = sample;
  if (!hn::AllFalse(d, sphere)) {
    sample_sphere_cone(world, light, from, u, v, other);
    sample = select(sphere, other, sample);
  }
  const MF point = is_shape(shape, LightShape::point);
  if (!hn::AllFalse(d, point)) {
    sample_point_light(light, from, other);
    sample = select(point, other, sample);
  }
  const MF spot = is_shape(shape, LightShape::spot);
  if (!hn::AllFalse(d, spot)) {
    sample_spot(light, from, other);
    sample = select(spot, other, sample);
  }
  const MF image = hn::Or(is_shape(shape, LightShape::goniometric), is_shape(shape, LightShape::projection));
  if (!hn::AllFalse(d, image)) {
    sample_image_light(light, shape, from, other);
    sample = select(image, other, sample);
  }
  const MF distant_disk = is_shape(shape, LightShape::distant_disk);
  if (!hn::AllFalse(d, distant_disk)) {
    sample_distant_disk(light, u, v, other);
    sample = select(distant_disk, other, sample);
  }
  const MF directional = is_shape(shape, LightShape::directional);
  if (!hn::AllFalse(d, directional)) {
    sample_directional(light, other);
    sample = select(directional, other, sample);
  }
  const MF environment = is_shape(shape, LightShape::environment);
  if (!hn::AllFalse(d, environment)) {
    sample_environments(world, light, from, u, v, other);
    sample = select(environment, other, sample);
  }
  return sample;
}

// What comes of a light that was chosen with `probability`.
HWY_INLINE void store_light_sample(const World& world, const LightFields& light, const LightSample& sample,
                                   VF probability, ShadeKind kind, ShadeStream& shade, size_t i) {
  VF lambda_nm[4], radiance[4];
  load(shade.lambda_nm, i, lambda_nm);
  light_spectrum(world, light, lambda_nm, radiance);
  apply_image(world, light, sample.image_u, sample.image_v, lambda_nm, radiance);
  const VF weight = hn::Div(sample.weight, probability);
  for (int j = 0; j < 4; ++j) radiance[j] = hn::Mul(radiance[j], weight);
  // What lets light in looks into two media: its kernel knows which of them lies before the light.
  if (world.has_interiors && kind != ShadeKind::rough_dielectric) {
    VF passes[4];
    medium_transmittance(world, load_media(shade.media, i).entry[0], lambda_nm, sample.distance, passes);
    for (int j = 0; j < 4; ++j) radiance[j] = hn::Mul(radiance[j], passes[j]);
  }
  store(sample.direction, shade.light_direction, i);
  store(sample.distance, shade.light_distance, i);
  store(radiance, shade.light_radiance, i);
  // Where no ray looks for a light (and none does without shadows) the sample speaks for all of its light.
  const VU finding = gather(world.light_finding.data(), hn::ShiftRight<5>(light.row));
  const MF by_rays = float_mask(hn::Ne(finding, splat_u(static_cast<uint32_t>(LightFinding::samples))));
  const VF pdf = hn::IfThenElseZero(by_rays, hn::Mul(sample.pdf, probability));
  store(world.settings.shadows ? pdf : hn::Zero(FloatTag()), shade.light_pdf, i);
}

void light_sample_lanes(const World& world, uint32_t depth, ShadeKind kind, ShadeStream& shade, size_t i) {
  const PointKey key = {load(shade.pixel_seed, i), load(shade.index, i)};
  const VF choice = sample_1d(key, splat_u(bounce_dimension(depth, light_choice_dimension)));
  VF u, v;
  sample_2d(key, splat_u(bounce_dimension(depth, light_point_dimension)), &u, &v);
  const LightFields light(world, sample_discrete(world.light_choice, choice).index);
  const LightSample sample = sample_light(world, light, load(shade.position, i), u, v);
  store_light_sample(world, light, sample, light.number(offsetof(LightRow, choice_probability)), kind, shade, i);
  if (kind == ShadeKind::phase) store(hn::BitCast(UintTag(), light.light), shade.light, i);
}

void light_sample_kernel(const World& world, uint32_t depth, ShadeStream& shade) {
  for (const ShadeKind kind : rough_kinds) {
    const Group& group = shade.groups[static_cast<size_t>(kind)];
    for (size_t i = group.begin; i < group.padded_end(); i += lane_count())
      light_sample_lanes(world, depth, kind, shade, i);
  }
}

void light_towards_kernel(const World& world, uint32_t row, ShadeStream& shade) {
  const VF zero = hn::Zero(FloatTag());
  const LightFields light(world, hn::Set(IntTag(), static_cast<int>(row)));
  for (const ShadeKind kind : rough_kinds) {
    const Group& group = shade.groups[static_cast<size_t>(kind)];
    for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
      const LightSample sample = sample_light(world, light, load(shade.position, i), zero, zero);
      store_light_sample(world, light, sample, splat(1.0f), kind, shade, i);
    }
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(light_sample_kernel);
HWY_EXPORT(light_towards_kernel);

void light_sample(const World& world, uint32_t depth, ShadeStream& shade) {
  HWY_DYNAMIC_DISPATCH(light_sample_kernel)(world, depth, shade);
}

void light_towards(const World& world, uint32_t row, ShadeStream& shade) {
  HWY_DYNAMIC_DISPATCH(light_towards_kernel)(world, row, shade);
}

}  // namespace metamer
#endif
