#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/scattered_light.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "engine/sampling/distribution-inl.h"
#include "engine/sampling/points-inl.h"
#include "systems/bsdf/phase-inl.h"
#include "systems/dimensions.h"
#include "systems/equiangular-inl.h"
#include "systems/grid_track.h"
#include "systems/media-inl.h"
#include "systems/positional_lights-inl.h"
#include "systems/volumes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

void scattered_light_lanes(const World& world, const VolumeRays& rays, uint32_t dimension, size_t k,
                           ShadowStream& shadow) {
  const FloatTag d;
  const PathStream& paths = rays.paths;
  const VolumeColumns& table = world.volumes;
  const VU ordered = load(rays.order, k);
  const auto listed = hn::Ne(ordered, splat_u(dead_lane));
  const VI row = as_index(hn::IfThenElseZero(listed, ordered));
  const VU volume = hn::IfThenElseZero(listed, gather(paths.volume, row));
  const auto scatters = hn::Ne(gather(table.scatters.data(), as_index(volume)), splat_u(0));
  const auto is_even = hn::Eq(gather(table.grid.data(), as_index(volume)), splat_u(no_index));
  MF counts = float_mask(hn::And(listed, hn::And(scatters, is_even)));
  if (hn::AllFalse(d, counts)) return;
  const VF zero = hn::Zero(d), one = splat(1.0f);
  VF u, v, lambda_nm[4];
  sample_2d({gather(paths.pixel_seed, row), gather(paths.index, row)}, splat_u(dimension), &u, &v);
  const DiscreteSampleV chosen = sample_discrete(world.positional_choice, u);
  const LightFields light(world, chosen.index);
  const Vec3 origin = gather(paths.origin, row), direction = gather(paths.direction, row);
  const Equiangular angles = equiangular(light.vector(offsetof(LightRow, p)) - origin, direction);
  const VF t = sample_equiangular(angles, v), pdf = equiangular_pdf(angles, t);
  const VF passed = gather(rays.hits.passed, row);
  counts = hn::And(counts, hn::And(hn::Gt(t, passed), hn::Lt(t, gather(rays.hits.distance, row))));
  if (hn::AllFalse(d, counts)) return;
  const Vec3 place = mul_add(direction, t, origin);
  const LightSample sample = sample_positional(light, place);
  for (size_t j = 0; j < 4; ++j) lambda_nm[j] = gather(paths.lambda_nm[j], row);
  const VolumeCoefficients c = volume_coefficients(world, volume, lambda_nm);
  const VF chosen_by = discrete_probability(world.positional_choice, chosen.index);
  const VF share = free_path_share(angles, t, c.extinction, live_wavelengths(world.settings),
                                   light.number(offsetof(LightRow, choice_probability)), chosen_by);
  const VI v_row = as_index(volume);
  const PhaseLobes lobes = {gather(table.g.data(), v_row), gather(table.g2.data(), v_row),
                            gather(table.g2_share.data(), v_row)};
  const VF phase = eval_phase(clamp(dot(direction, sample.direction), -1.0f, 1.0f), lobes);
  const VF likely = hn::Mul(pdf, chosen_by);
  const VF weight =
      hn::Div(hn::Mul(hn::Mul(hn::Sub(one, share), phase), sample.weight), hn::Max(likely, splat(1e-37f)));
  VF radiance[4], solid[4] = {one, one, one, one}, contribution[4];
  light_spectrum(world, light, lambda_nm, radiance);
  apply_image(world, light, sample.image_u, sample.image_v, lambda_nm, radiance);
  if (world.has_interiors)
    medium_transmittance(world, hn::And(gather(paths.media[0], row), splat_u(largest_medium)), lambda_nm,
                         hn::Add(t, sample.distance), solid);
  const VF inside = hn::Sub(t, passed);
  for (size_t j = 0; j < 4; ++j) {
    const VF scattered_here = hn::Mul(c.scattering[j], exp(hn::Neg(optical_depth(c.extinction[j], inside))));
    const VF through = hn::Mul(hn::Mul(gather(paths.throughput[j], row), scattered_here), solid[j]);
    contribution[j] = hn::Mul(hn::Mul(through, radiance[j]), weight);
  }
  const VF t_far = hn::Mul(sample.distance, splat(shadow_ray_share));
  counts = hn::And(counts, hn::And(hn::Gt(max_of(contribution), zero), hn::Gt(t_far, zero)));
  counts = hn::And(counts, is_traceable(place, sample.direction));
  append(counts, place, shadow.origin, shadow.size);
  append(counts, sample.direction, shadow.direction, shadow.size);
  append(counts, t_far, shadow.t_far, shadow.size);
  append(counts, contribution, shadow.contribution, shadow.size);
  append(counts, gather(paths.slot, row), shadow.slot, shadow.size);
  append(counts, lambda_nm, shadow.lambda_nm, shadow.size);
  append(counts, volume, shadow.volume, shadow.size);
  append(counts, gather(paths.pixel_seed, row), shadow.pixel_seed, shadow.size);
  append(counts, gather(paths.index, row), shadow.index, shadow.size);
  if (world.has_motion) append(counts, gather(paths.time, row), shadow.time, shadow.size);
  shadow.size += static_cast<uint32_t>(hn::CountTrue(d, counts));
}

void scattered_light_kernel(const World& world, const VolumeRays& rays, uint32_t dimension, ShadowStream& shadow) {
  for (size_t k = 0; k < rays.count; k += lane_count()) scattered_light_lanes(world, rays, dimension, k, shadow);
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(scattered_light_kernel);

void scattered_light(const World& world, const VolumeRays& rays, uint32_t dimension, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(scattered_light_kernel)(world, rays, dimension, shadow);
}

}  // namespace metamer
#endif
