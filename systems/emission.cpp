#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/emission.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/lights-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

HWY_INLINE void add_radiance(MF mask, const ShadeStream& shade, size_t i, const VF radiance[4], VF weight,
                             Slots& slots) {
  const VU slot = load(shade.slot, i);
  VF seen[4];
  for (size_t j = 0; j < 4; ++j) seen[j] = hn::Mul(hn::Mul(load(shade.throughput[j], i), radiance[j]), weight);
  const VF mean = hn::Mul(hn::Add(hn::Add(seen[0], seen[1]), hn::Add(seen[2], seen[3])), splat(0.25f));
  const VF limit = splat(slots.limit);
  const VF kept = hn::IfThenElse(hn::Gt(mean, limit), hn::Div(limit, mean), splat(1.0f));
  for (size_t j = 0; j < 4; ++j) add_to_slots(mask, hn::Mul(seen[j], kept), slots.radiance[j], slot);
}

// 1 where light sampling could not have found the light: straight from the camera, or after a mirror. Without shadows
// light samples stand for all the rest.
HWY_INLINE VF weight_of(const World& world, VF pdf_direction, VF pdf_light) {
  const MF sampled = hn::Gt(pdf_direction, hn::Zero(FloatTag()));
  const VF found = world.settings.shadows ? power_heuristic(pdf_direction, pdf_light) : hn::Zero(FloatTag());
  return hn::IfThenElse(sampled, found, splat(1.0f));
}

void hit_emission(const World& world, const ShadeStream& shade, size_t i, Slots& slots) {
  const FloatTag d;
  const VF zero = hn::Zero(d);
  const VU light_row = load(shade.light, i);
  const MF emits = hn::And(is_live(load(shade.slot, i)), float_mask(hn::Ne(light_row, splat_u(no_index))));
  if (hn::AllFalse(d, emits)) return;
  const LightFields light(world, as_index(hn::IfThenElseZero(uint_mask(emits), light_row)));
  const Vec3 wo = load(shade.wo, i), position = load(shade.position, i), normal = load(shade.normal, i);
  const VF distance = load(shade.distance, i);
  const MF two_sided = float_mask(hn::Ne(light.word(offsetof(LightRow, two_sided)), splat_u(0)));
  const MF seen = hn::And(emits, hn::Or(two_sided, hn::Gt(dot(wo, normal), zero)));
  if (hn::AllFalse(d, seen)) return;
  VF lambda_nm[4], radiance[4];
  load(shade.lambda_nm, i, lambda_nm);
  light_spectrum(world, light, lambda_nm, radiance);
  const VF profile = emission_profile(light, dot(wo, normal));
  for (VF& value : radiance) value = hn::Mul(value, profile);
  if (world.has_shape_images)
    apply_image(world, light, load(shade.uv[0], i), hn::Sub(splat(1.0f), load(shade.uv[1], i)), lambda_nm, radiance);
  const Vec3 from = mul_add(wo, distance, position);
  const VF pdf_light = area_light_pdf(light, from, position, normal, -wo, distance);
  add_radiance(seen, shade, i, radiance, weight_of(world, load(shade.pdf_direction, i), pdf_light), slots);
}

void miss_emission(const World& world, const Environment& environment, const ShadeStream& shade, size_t i,
                   Slots& slots) {
  const LightFields light(world, hn::Set(IntTag(), static_cast<int>(environment.light)));
  const Vec3 direction = -load(shade.wo, i);
  MF seen = is_live(load(shade.slot, i));
  Vec3 from = direction;  // matters to portals only
  if (environment.has_portal()) {
    from = load(shade.position, i);
    seen = hn::And(seen, through_portal(environment.portal, from, direction));
    if (hn::AllFalse(FloatTag(), seen)) return;
  }
  VF lambda_nm[4], radiance[4];
  load(shade.lambda_nm, i, lambda_nm);
  light_spectrum(world, light, lambda_nm, radiance);
  const ImagePoint point = image_point(environment.mapping, rotate(environment.to_local, direction));
  apply_image(world, light, point.u, point.v, lambda_nm, radiance);
  const VF pdf_light = hn::Mul(environment_pdf(environment, from, direction, point),
                               light.number(offsetof(LightRow, choice_probability)));
  add_radiance(seen, shade, i, radiance, weight_of(world, load(shade.pdf_direction, i), pdf_light), slots);
}

void disk_emission(const World& world, uint32_t row, const ShadeStream& shade, size_t i, Slots& slots) {
  const LightFields light(world, hn::Set(IntTag(), static_cast<int>(row)));
  // 1 - cos of the angle to the disc's centre.
  const Vec3 off = -load(shade.wo, i) - light.vector(offsetof(LightRow, p));
  const VF half = light.number(offsetof(LightRow, axes));
  const MF seen = hn::And(is_live(load(shade.slot, i)), hn::Le(hn::Mul(splat(0.5f), dot(off, off)), half));
  if (hn::AllFalse(FloatTag(), seen)) return;
  VF lambda_nm[4], radiance[4];
  load(shade.lambda_nm, i, lambda_nm);
  light_spectrum(world, light, lambda_nm, radiance);
  const VF pdf_light = hn::Mul(uniform_cone_pdf(half), light.number(offsetof(LightRow, choice_probability)));
  add_radiance(seen, shade, i, radiance, weight_of(world, load(shade.pdf_direction, i), pdf_light), slots);
}

void emission_kernel(const World& world, const ShadeStream& shade, Slots& slots) {
  const size_t step = lane_count();
  const Group& miss = shade.groups[static_cast<size_t>(ShadeKind::miss)];
  if (!world.lights.empty())
    for (size_t i = 0; i < miss.begin; i += step) hit_emission(world, shade, i, slots);
  for (const Environment& environment : world.environments)
    for (size_t i = miss.begin; i < miss.padded_end(); i += step) miss_emission(world, environment, shade, i, slots);
  for (const uint32_t row : world.distant_disks)
    for (size_t i = miss.begin; i < miss.padded_end(); i += step) disk_emission(world, row, shade, i, slots);
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(emission_kernel);

void emission(const World& world, const ShadeStream& shade, Slots& slots) {
  HWY_DYNAMIC_DISPATCH(emission_kernel)(world, shade, slots);
}

}  // namespace metamer
#endif
