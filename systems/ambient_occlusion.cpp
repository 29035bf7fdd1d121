#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/ambient_occlusion.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "engine/sampling/warps-inl.h"
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// Around the geometric normal on the viewer's side. The cosine over pi is the direction's density: in sight it is worth
// the light's whole radiance, on average the share of the hemisphere that is open.
void occlusion_lanes(const World& world, const ShadeStream& shade, size_t i, ShadowStream& shadow) {
  const VU slot = load(shade.slot, i);
  VF u, v, lambda_nm[4], contribution[4];
  sample_2d(point_key(shade, i), splat_u(bounce_dimension(0, direction_dimension)), &u, &v);
  const Vec3 normal = load(shade.normal, i);
  const VF side = hn::CopySign(splat(1.0f), dot(normal, load(shade.wo, i)));
  const Vec3 direction = to_world(make_frame(normal * side), sample_cosine_hemisphere(u, v));
  const Vec3 origin = ray_origin(shade, i, direction);
  load(shade.lambda_nm, i, lambda_nm);
  eval_spectrum4(world.spectra.view(), splat_u(world.ambient_light), lambda_nm, contribution);
  for (size_t j = 0; j < 4; ++j) contribution[j] = hn::Mul(contribution[j], load(shade.throughput[j], i));
  const MF counts = hn::And(is_live(slot), is_traceable(origin, direction));
  append(counts, origin, shadow.origin, shadow.size);
  append(counts, direction, shadow.direction, shadow.size);
  append(counts, splat(world.settings.occlusion_distance), shadow.t_far, shadow.size);
  append(counts, contribution, shadow.contribution, shadow.size);
  append(counts, slot, shadow.slot, shadow.size);
  if (shade.carries_time) append(counts, load(shade.time, i), shadow.time, shadow.size);
  shadow.size += static_cast<uint32_t>(hn::CountTrue(FloatTag(), counts));
}

// Where the eye ray was scattered in a volume there is no surface.
void ambient_occlusion_kernel(const World& world, const ShadeStream& shade, ShadowStream& shadow) {
  for (uint32_t kind = 0; kind < static_cast<uint32_t>(ShadeKind::miss); ++kind) {
    if (static_cast<ShadeKind>(kind) == ShadeKind::phase) continue;
    const Group& group = shade.groups[kind];
    for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) occlusion_lanes(world, shade, i, shadow);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(ambient_occlusion_kernel);

void ambient_occlusion(const World& world, const ShadeStream& shade, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(ambient_occlusion_kernel)(world, shade, shadow);
}

}  // namespace metamer
#endif
