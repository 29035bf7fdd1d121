// What happens to rays between the surfaces. A ray's way is cut into stretches by the interfaces that it passes;
// `order` lists the rays that are still on theirs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/volumes.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "engine/sampling/points-inl.h"
#include "systems/dimensions.h"
#include "systems/grid_track.h"
#include "systems/volumes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

HWY_INLINE void scatter(MF mask, VF v, float* column, VI row) {
  const VF old = gather(column, row);
  HWY_ALIGN float values[hn::MaxLanes(FloatTag())];
  HWY_ALIGN int32_t rows[hn::MaxLanes(FloatTag())];
  hn::Store(hn::IfThenElse(mask, v, old), FloatTag(), values);
  hn::Store(row, IntTag(), rows);
  uint8_t bits[8] = {};
  hn::StoreMaskBits(FloatTag(), mask, bits);
  for (uint32_t left = bits[0] | uint32_t{bits[1]} << 8; left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    column[rows[lane]] = values[lane];
  }
}

void start_kernel(uint32_t depth, const PathStream& paths, HitStream& hits) {
  for (size_t i = 0; i < paths.size; i += lane_count()) {
    const PointKey key = {load(paths.pixel_seed, i), load(paths.index, i)};
    const VF u = sample_1d(key, splat_u(bounce_dimension(depth, free_path_dimension)));
    store(hn::Neg(log(hn::Sub(splat(1.0f), u))), hits.depth_left, i);
    store(hn::Zero(FloatTag()), hits.passed, i);
    store(hn::Inf(FloatTag()), hits.reach, i);
  }
}

void stretch_lanes(const World& world, const VolumeRays& rays, size_t k) {
  const FloatTag d;
  const VU ordered = load(rays.order, k);
  const auto listed = hn::Ne(ordered, splat_u(dead_lane));
  const VI row = as_index(hn::IfThenElseZero(listed, ordered));
  const VU volume = hn::IfThenElseZero(listed, gather(rays.paths.volume, row));
  const MF inside = float_mask(hn::Ne(volume, splat_u(0)));
  if (hn::AllFalse(d, inside)) return;
  const VF passed = gather(rays.hits.passed, row);
  const VF metres = hn::Max(hn::Sub(gather(rays.hits.distance, row), passed), hn::Zero(d));
  VF lambda_nm[4], throughput[4];
  for (size_t j = 0; j < 4; ++j) {
    lambda_nm[j] = gather(rays.paths.lambda_nm[j], row);
    throughput[j] = gather(rays.paths.throughput[j], row);
  }
  const VolumeCoefficients c = volume_coefficients(world, volume, lambda_nm);
  if (rays.slots != nullptr) {
    VF radiance[4];
    glow(world, volume, lambda_nm, c, metres, radiance);
    const VU slot = gather(rays.paths.slot, row);
    for (size_t j = 0; j < 4; ++j)
      add_to_slots(inside, hn::Mul(throughput[j], radiance[j]), rays.slots->radiance[j], slot);
  }
  VF factor[4];
  for (size_t j = 0; j < 4; ++j) factor[j] = exp(hn::Neg(optical_depth(c.extinction[j], metres)));
  MF scattering = hn::And(inside, float_mask(hn::Ne(gather(world.volumes.scatters.data(), as_index(volume)),
                                                    splat_u(rays.scatters ? 0u : dead_lane))));
  if (!rays.scatters) scattering = hn::Lt(metres, hn::Zero(d));  // none
  if (!hn::AllFalse(d, scattering)) {
    VF share[4];
    if (world.shares_paths)
      for (size_t j = 0; j < 4; ++j) share[j] = gather(rays.paths.share[j], row);
    const VF depth_left = gather(rays.hits.depth_left, row);
    const float live = static_cast<float>(live_wavelengths(world.settings));
    const FreePath path = sample_free_path(c, metres, depth_left, live, world.shares_paths ? share : nullptr);
    for (size_t j = 0; j < 4; ++j) factor[j] = hn::IfThenElse(scattering, path.factor[j], factor[j]);
    const MF ends = hn::And(scattering, path.is_scattered);
    scatter(ends, hn::Add(passed, path.metres), rays.hits.distance, row);
    scatter(ends, hn::BitCast(d, splat_u(scattered)), reinterpret_cast<float*>(rays.hits.object), row);
    scatter(scattering, hn::Sub(depth_left, optical_depth(c.extinction[0], metres)), rays.hits.depth_left, row);
    if (world.shares_paths)
      for (size_t j = 0; j < 4; ++j) scatter(scattering, share[j], rays.paths.share[j], row);
  }
  for (size_t j = 0; j < 4; ++j) scatter(inside, hn::Mul(throughput[j], factor[j]), rays.paths.throughput[j], row);
}

void stretch_kernel(const World& world, const VolumeRays& rays) {
  for (size_t k = 0; k < rays.count; k += lane_count()) stretch_lanes(world, rays, k);
}

// What the last stretch before the surfaces in `shade` lets through.
void dim_kernel(const World& world, const HitStream& hits, const PathStream& paths, const uint32_t* order,
                ShadeStream& shade) {
  for (size_t k = 0; k < shade.size; k += lane_count()) {
    const VU ordered = load(order, k);
    const auto listed = hn::Ne(ordered, splat_u(dead_lane));
    const VI row = as_index(hn::IfThenElseZero(listed, ordered));
    VF lambda_nm[4];
    load(shade.lambda_nm, k, lambda_nm);
    const VU volume = hn::IfThenElseZero(listed, gather(paths.volume, row));
    const VolumeCoefficients c = volume_coefficients(world, volume, lambda_nm);
    const VF metres = hn::Max(hn::Sub(gather(hits.distance, row), gather(hits.passed, row)), hn::Zero(FloatTag()));
    for (size_t j = 0; j < 4; ++j) {
      const VF passes = exp(hn::Neg(optical_depth(c.extinction[j], metres)));
      store(hn::Mul(load(shade.throughput[j], k), passes), shade.throughput[j], k);
    }
  }
}

// Behind the surfaces in `shade`, which are those of rays.order.
void cross_kernel(const ShadeStream& shade, const VolumeRays& rays) {
  for (size_t k = 0; k < rays.count; k += lane_count()) {
    const VU ordered = load(rays.order, k);
    const MF listed = is_live(ordered);
    const VI row = as_index(hn::IfThenElseZero(uint_mask(listed), ordered));
    const MF inwards = hn::Gt(dot(load(shade.wo, k), load(shade.normal, k)), hn::Zero(FloatTag()));
    const VU volume = hn::IfThenElse(uint_mask(inwards), load(shade.volumes[0], k), load(shade.volumes[1], k));
    scatter(listed, hn::BitCast(FloatTag(), volume), reinterpret_cast<float*>(rays.paths.volume), row);
    scatter(listed, gather(rays.hits.distance, row), rays.hits.passed, row);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>

#include "engine/sampling/hash.h"

namespace metamer {

HWY_EXPORT(start_kernel);
HWY_EXPORT(stretch_kernel);
HWY_EXPORT(dim_kernel);
HWY_EXPORT(cross_kernel);

namespace {

// The rays among those listed for which `stays` is true, in their order.
template <class Stays>
void keep(VolumeRays& rays, const Stays& stays) {
  uint32_t kept = 0;
  for (uint32_t k = 0; k < rays.count; ++k)
    if (stays(rays.order[k])) rays.order[kept++] = rays.order[k];
  rays.count = kept;
  for (uint32_t k = kept; k < padded_to_lanes(kept); ++k) rays.order[k] = dead_lane;
}

void list_all(uint32_t size, VolumeRays& rays) {
  for (uint32_t i = 0; i < size; ++i) rays.order[i] = i;
  rays.count = size;
  keep(rays, [](uint32_t) { return true; });
}

bool is_kind(const World& world, uint32_t object, ShadeKind kind) {
  return object < scattered && world.objects.shade_kind[object] == static_cast<uint32_t>(kind);
}

// What the listed rays hit, as a stream of one group.
void find_surfaces(const World& world, const VolumeRays& rays, const uint32_t* order, uint32_t count,
                   ShadeStream& shade) {
  shade.groups = {};
  const Group all = {0, count};
  shade.groups[static_cast<size_t>(ShadeKind::interface)] = all;
  shade.groups[static_cast<size_t>(ShadeKind::miss)] = {all.padded_end(), all.padded_end()};
  shade.size = all.padded_end();
  surface(world, rays.paths, rays.hits, order, shade);
}

// Shapes that shine, seen through what scatters: their light is dimmed, not lost by chance, and then `emission` must
// not count it again, which HitStream::depth_left tells. A small lamp in fog would be a few bright paths among many
// dark.
class DimmedLights {
 public:
  DimmedLights(const World& world, const VolumeRays& rays) {
    if (!rays.scatters || world.lights.empty()) return;
    for (uint32_t k = 0; k < rays.count; ++k) {
      const uint32_t path = rays.order[k], object = rays.hits.object[path];
      const bool shines = object < scattered && world.objects.first_light[object] != no_index;
      if (!shines || is_kind(world, object, ShadeKind::interface)) continue;
      const uint32_t volume = rays.paths.volume[path];
      if (world.volumes.scatters[volume] != 0 && world.volumes.grid[volume] == no_index) order_[count_++] = path;
    }
    std::fill(order_ + count_, order_ + padded_to_lanes(count_), dead_lane);
  }

  void add(const World& world, const VolumeRays& rays, ShadeStream& shade) const {
    if (count_ == 0) return;
    find_surfaces(world, rays, order_, count_, shade);
    HWY_DYNAMIC_DISPATCH(dim_kernel)(world, rays.hits, rays.paths, order_, shade);
    if (world.has_interiors) media(world, shade);
    emission(world, shade, *rays.slots);
  }

  void mark(HitStream& hits) const {
    for (uint32_t k = 0; k < count_; ++k) hits.depth_left[order_[k]] = light_is_counted;
  }

 private:
  uint32_t order_[batch_capacity + column_lanes], count_ = 0;
};

// A stretch of the listed rays: those in homogeneous volumes, then those in each volume of grids.
void stretch(const World& world, const VolumeRays& rays, GridWork& work) {
  if (!world.has_grids) return HWY_DYNAMIC_DISPATCH(stretch_kernel)(world, rays);
  uint32_t homogeneous[batch_capacity + column_lanes], listed[batch_capacity + column_lanes];
  std::pair<uint32_t, uint32_t> in_grids[batch_capacity];  // volume and row
  VolumeRays others = rays;
  others.order = homogeneous;
  others.count = 0;
  uint32_t count = 0;
  for (uint32_t k = 0; k < rays.count; ++k) {
    const uint32_t row = rays.order[k], volume = rays.paths.volume[row];
    if (world.volumes.grid[volume] == no_index)
      homogeneous[others.count++] = row;
    else
      in_grids[count++] = {volume, row};
  }
  std::fill(homogeneous + others.count, homogeneous + padded_to_lanes(others.count), dead_lane);
  HWY_DYNAMIC_DISPATCH(stretch_kernel)(world, others);
  std::sort(in_grids, in_grids + count);
  for (uint32_t begin = 0, end = 0; begin < count; begin = end) {
    uint32_t size = 0;
    for (; end < count && in_grids[end].first == in_grids[begin].first; ++end) listed[size++] = in_grids[end].second;
    std::fill(listed + size, listed + padded_to_lanes(size), dead_lane);
    track_grid(world, in_grids[begin].first, rays, listed, size, work);
  }
}

// The listed rays up to what they meet, on through all interfaces. `mask`: what they see; before_stretch(n) is called
// before the n-th stretch. Returns how many are given up.
template <class BeforeStretch>
uint32_t follow(const World& world, uint32_t mask, VolumeRays& rays, ShadeStream& shade, GridWork& work,
                double* embree_seconds, const BeforeStretch& before_stretch) {
  const uint32_t key = rays.key;
  const auto is_at_interface = [&](uint32_t i) { return is_kind(world, rays.hits.object[i], ShadeKind::interface); };
  for (uint32_t passed = 0;; ++passed) {
    before_stretch(passed);
    const DimmedLights lights(world, rays);
    lights.add(world, rays, shade);
    rays.key = hash_combine(key, passed);
    stretch(world, rays, work);
    lights.mark(rays.hits);
    keep(rays, is_at_interface);
    if (rays.count == 0) return 0;
    if (passed == most_interfaces) break;
    find_surfaces(world, rays, rays.order, rays.count, shade);
    if (rays.slots != nullptr) emission(world, shade, *rays.slots);
    HWY_DYNAMIC_DISPATCH(cross_kernel)(shade, rays);
    intersect_onward(world, rays.paths, rays.order, rays.count, mask, rays.hits, embree_seconds);
  }
  for (uint32_t k = 0; k < rays.count; ++k) {
    for (float* throughput : rays.paths.throughput) throughput[rays.order[k]] = 0;
    rays.hits.object[rays.order[k]] = no_index;
  }
  return rays.count;
}

// Light of points that the listed rays get on their n-th stretch, found by its angles.
void add_scattered_light(const World& world, uint32_t depth, uint32_t n, const VolumeRays& rays, Batch& batch,
                         Counters& counters) {
  ShadowStream& shadow = batch.shadow;
  shadow.size = 0;
  scattered_light(world, rays, bounce_dimension(depth, free_path_dimension) + (n + 1) * 0x10000, shadow);
  if (shadow.size == 0) return;
  if (!batch.crossings) batch.crossings = std::make_unique<Batch>();
  occlude(world, shadow, &counters.embree_seconds);
  constexpr uint32_t first_key = 0x80000000u;  // no number of a light
  counters.lost_rays +=
      transmit(world, depth, first_key + n, shadow, *batch.crossings, counters.grids, &counters.embree_seconds);
  add_light(shadow, batch.slots);
  counters.shadow_rays += shadow.size;
}

}  // namespace

void volumes(const World& world, uint32_t depth, Batch& batch, Counters& counters) {
  const RenderSettings& settings = world.settings;
  VolumeRays rays{batch.paths, batch.hits, &batch.slots, settings.integrator == Integrator::path, batch.order};
  rays.key = hash_combine(depth, 0);
  HWY_DYNAMIC_DISPATCH(start_kernel)(depth, batch.paths, batch.hits);
  list_all(batch.paths.size, rays);
  const bool finds_points = world.positional_choice.size() > 0 && depth < settings.max_depth;
  counters.lost_rays += follow(world, depth == 0 ? visible_to_camera : visible_to_bounces, rays, batch.shade,
                               counters.grids, &counters.embree_seconds, [&](uint32_t n) {
                                 if (finds_points) add_scattered_light(world, depth, n, rays, batch, counters);
                               });
}

uint32_t transmit(const World& world, uint32_t depth, uint32_t light, ShadowStream& shadow, Batch& crossings,
                  GridWork& work, double* embree_seconds) {
  PathStream& paths = crossings.paths;
  HitStream& hits = crossings.hits;
  VolumeRays rays{paths, hits, nullptr, false, crossings.order};
  rays.key = hash_combine(hash_combine(depth, 1), light);
  const auto copy = [&](const auto& from, auto& to) {
    for (size_t c = 0; c < from.size(); ++c) std::copy_n(from[c], shadow.size, to[c]);
  };
  copy(shadow.origin, paths.origin);
  copy(shadow.direction, paths.direction);
  copy(shadow.lambda_nm, paths.lambda_nm);
  copy(shadow.contribution, paths.throughput);
  std::copy_n(shadow.volume, shadow.size, paths.volume);
  if (world.has_motion) std::copy_n(shadow.time, shadow.size, paths.time);
  if (world.has_grids) {
    std::copy_n(shadow.pixel_seed, shadow.size, paths.pixel_seed);
    std::copy_n(shadow.index, shadow.size, paths.index);
  }
  paths.size = shadow.size;
  for (uint32_t i = 0; i < shadow.size; ++i) {
    hits.passed[i] = 0;
    hits.distance[i] = hits.reach[i] = shadow.t_far[i] / shadow_ray_share;
    hits.object[i] = no_index;
  }
  list_all(shadow.size, rays);
  keep(rays, [&](uint32_t i) { return shadow.slot[i] != dead_lane; });
  if (world.has_interfaces)
    intersect_onward(world, paths, rays.order, rays.count, visible_to_crossings, hits, embree_seconds);
  const uint32_t lost =
      follow(world, visible_to_crossings, rays, crossings.shade, work, embree_seconds, [](uint32_t) {});
  copy(paths.throughput, shadow.contribution);
  return lost;
}

}  // namespace metamer
#endif
