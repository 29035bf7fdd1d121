#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/camera_rays.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "engine/sampling/filters-inl.h"
#include "engine/sampling/points-inl.h"
#include "engine/sampling/warps-inl.h"
#include "engine/spectrum/color_mode.h"
#include "engine/spectrum/wavelengths-inl.h"
#include "systems/dimensions.h"
#include "systems/environment-inl.h"
#include "systems/placement-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

HWY_INLINE Vec3 splat3(const float (&v)[3]) { return {splat(v[0]), splat(v[1]), splat(v[2])}; }

// begin <= x < end, all below 2^31.
HWY_INLINE hn::Mask<UintTag> is_within(VU x, uint32_t begin, uint32_t end) {
  const IntTag di;
  const VI at = as_index(x);
  const auto before = hn::Lt(at, hn::Set(di, static_cast<int32_t>(begin)));
  return hn::RebindMask(UintTag(), hn::AndNot(before, hn::Lt(at, hn::Set(di, static_cast<int32_t>(end)))));
}

// CameraRow's vectors in each lane.
struct CameraVectors {
  Vec3 origin, axis, right, down, lens_x, lens_y, forward;
};
HWY_INLINE CameraVectors still_camera(const CameraRow& c) {
  return {splat3(c.origin), splat3(c.axis),   splat3(c.right),  splat3(c.down),
          splat3(c.lens_x), splat3(c.lens_y), splat3(c.forward)};
}
HWY_INLINE CameraVectors moving_camera(const Column<CameraKey>& keys, VF time) {
  constexpr size_t stride = sizeof(CameraKey) / sizeof(float);
  const KeySegment segment = key_segment(splat_u(static_cast<uint32_t>(keys.size())), time);
  const VI base = hn::ShiftLeft<5>(segment.first);
  const auto vector = [&](const float* field) {
    return lerp(gather_vec3(field, base), gather_vec3(field + stride, base), segment.fraction);
  };
  const CameraKey& first = keys[0];
  return {vector(first.origin), vector(first.axis),   vector(first.right),  vector(first.down),
          vector(first.lens_x), vector(first.lens_y), vector(first.forward)};
}

struct Ray {
  Vec3 origin, direction;
};

// A place beside the equal-area square lies on it, across the edge: its edges are folded onto themselves.
HWY_INLINE Point2V wrap_equal_area(VF u, VF v) {
  const VF one = splat(1.0f), two = splat(2.0f), zero = hn::Zero(FloatTag());
  const MF u_out = hn::Or(hn::Lt(u, zero), hn::Gt(u, one));
  u = hn::IfThenElse(hn::Lt(u, zero), hn::Neg(u), hn::IfThenElse(hn::Gt(u, one), hn::Sub(two, u), u));
  v = hn::IfThenElse(u_out, hn::Sub(one, v), v);
  const MF v_out = hn::Or(hn::Lt(v, zero), hn::Gt(v, one));
  v = hn::IfThenElse(hn::Lt(v, zero), hn::Neg(v), hn::IfThenElse(hn::Gt(v, one), hn::Sub(two, v), v));
  return {hn::IfThenElse(v_out, hn::Sub(one, u), u), v};
}

HWY_INLINE Ray spherical_ray(const CameraRow& camera, const CameraVectors& c, VF x, VF y) {
  const VF u = hn::Mul(x, splat(camera.x_step)), v = hn::Mul(y, splat(camera.y_step));
  VF solid_angle;
  Vec3 d;
  if (camera.mapping == ImageMapping::equal_area) {
    const Point2V place = wrap_equal_area(u, v);
    d = equal_area_direction(place.x, place.y);
  } else {
    d = latitude_longitude_direction(u, v, &solid_angle);
  }
  // The images' z axis points up.
  return {c.origin, normalize(mul_add(c.right, d.x, mul_add(c.axis, d.z, c.down * d.y)))};
}

// The ray through film coordinate (x, y), y down; lens_u, lens_v in [0, 1) choose the point of the lens.
HWY_INLINE Ray camera_ray(const CameraRow& camera, const CameraVectors& c, VF x, VF y, bool has_lens, VF lens_u,
                          VF lens_v) {
  if (camera.kind == CameraKind::spherical) return spherical_ray(camera, c, x, y);
  const Vec3 across = mul_add(c.right, x, c.down * y);
  const bool perspective = camera.kind == CameraKind::perspective;
  Ray ray;
  ray.origin = perspective ? c.origin : c.origin + across;
  ray.direction = normalize(perspective ? c.axis + across : c.axis);
  if (has_lens) {
    // All rays of a film point meet at depth focal_distance.
    const VF depth = hn::Div(splat(camera.focal_distance), dot(ray.direction, c.forward));
    const Vec3 focus = mul_add(ray.direction, depth, ray.origin);
    const Point2V lens = sample_concentric_disk(lens_u, lens_v);
    ray.origin = mul_add(c.lens_x, lens.x, mul_add(c.lens_y, lens.y, ray.origin));
    ray.direction = normalize(focus - ray.origin);
  }
  return ray;
}

// Whether a path's first wavelength decides for the others.
bool has_leads(const World& world) { return world.disperses || world.shares_paths; }

// RGB mode: the wavelengths that stand for the channels. Where indices of refraction or free paths differ between them
// the first leads, so it must be each channel equally often: u in [0, 1) chooses it, the others follow in turn.
HWY_INLINE void channel_wavelengths(const World& world, VF u, VF lambda_nm[4], VF inv_pdf_nm[4]) {
  const std::array<double, 3>& channels = coefficient_space(world.settings.color).lambda_nm;
  const VF third = splat(1.0f / 3), two_thirds = splat(2.0f / 3);
  const MF keep = hn::Lt(u, third), turn_twice = hn::Ge(u, two_thirds);
  const auto nm = [&](size_t j) { return splat(static_cast<float>(channels[j % 3])); };
  for (size_t j = 0; j < 3; ++j) {
    const VF turned = hn::IfThenElse(keep, nm(j), hn::IfThenElse(turn_twice, nm(j + 2), nm(j + 1)));
    lambda_nm[j] = has_leads(world) ? turned : nm(j);
  }
  lambda_nm[3] = lambda_nm[2];
  for (size_t j = 0; j < 4; ++j) inv_pdf_nm[j] = splat(1.0f);
}

void camera_rays_kernel(const World& world, std::span<const RayPacket> packets, const TileRect& tile, PathStream& paths,
                        Slots& slots) {
  const UintTag du;
  const size_t step = lane_count();
  const VU lane = hn::Iota(du, 0);
  const WavelengthTable& wavelengths = wavelength_table();
  const bool is_spectral = world.settings.color == ColorMode::spectral;
  const bool jitter = world.settings.pixel_jitter, has_lens = jitter && world.camera.lens_radius > 0;
  const bool needs_time = world.has_motion || !world.camera_keys.empty();
  const size_t live = live_wavelengths(world.settings);
  size_t i = 0;
  for (const RayPacket& packet : packets) {
    for (size_t first = 0; first < column_lanes; first += step, i += step) {
      const VU within = hn::Add(lane, splat_u(static_cast<uint32_t>(first)));
      const VU x = hn::Add(splat_u(packet.x), hn::And(within, splat_u(3)));
      const VU y = hn::Add(splat_u(packet.y), hn::ShiftRight<2>(within));
      const VU sample = splat_u(packet.sample);
      const PointKey key = make_point_key(x, y, sample, world.settings.seed);
      VF u, v;
      sample_2d(key, splat_u(film_dimension), &u, &v);
      const VF no_offset = hn::Zero(FloatTag());
      const Point2V offset = jitter ? sample_filter(world.filter, u, v) : Point2V{no_offset, no_offset};
      store(jitter ? filter_weight(world.filter, u, v) : splat(1.0f), slots.weight, i);
      const VF film_x = hn::Add(hn::Add(hn::ConvertTo(FloatTag(), as_index(x)), splat(0.5f)), offset.x);
      const VF film_y = hn::Add(hn::Add(hn::ConvertTo(FloatTag(), as_index(y)), splat(0.5f)), offset.y);
      VF lens_u = hn::Zero(FloatTag()), lens_v = lens_u;
      if (has_lens) sample_2d(key, splat_u(lens_dimension), &lens_u, &lens_v);
      VF time = hn::Zero(FloatTag());
      if (needs_time) time = jitter ? sample_1d(key, splat_u(time_dimension)) : splat(0.5f);
      const CameraVectors camera =
          world.camera_keys.empty() ? still_camera(world.camera) : moving_camera(world.camera_keys, time);
      const Ray ray = camera_ray(world.camera, camera, film_x, film_y, has_lens, lens_u, lens_v);
      VF rotation, lambda_nm[4], inv_pdf_nm[4];
      if (is_spectral || has_leads(world)) sample_2d(key, splat_u(wavelength_dimension), &u, &rotation);
      if (is_spectral)
        sample_wavelengths(wavelengths, u, rotation, lambda_nm, inv_pdf_nm);
      else
        channel_wavelengths(world, u, lambda_nm, inv_pdf_nm);

      // A ray that cannot be traced still takes its place in the packet; NaN has its sample refused and counted.
      const VF zero = hn::Zero(FloatTag());
      const MF traceable = is_traceable(ray.origin, ray.direction);
      const VF radiance = hn::IfThenElse(traceable, zero, hn::NaN(FloatTag()));
      store(if_then_else(traceable, ray.origin, Vec3{zero, zero, zero}), paths.origin, i);
      store(if_then_else(traceable, ray.direction, Vec3{zero, zero, splat(1.0f)}), paths.direction, i);
      store(lambda_nm, paths.lambda_nm, i);
      const VU slot = hn::Add(lane, splat_u(static_cast<uint32_t>(i)));
      for (size_t j = 0; j < 4; ++j) {
        store(splat(j < live ? 1.0f : 0.0f), paths.throughput[j], i);
        store(lambda_nm[j], slots.lambda_nm[j], i);
        store(inv_pdf_nm[j], slots.inv_pdf_nm[j], i);
        store(radiance, slots.radiance[j], i);
      }
      store(zero, paths.pdf_direction, i);
      store(splat(1.0f), paths.eta_scale, i);
      store(key.pixel_seed, paths.pixel_seed, i);
      store(key.index_reversed, paths.index, i);
      store(slot, paths.slot, i);
      if (world.has_motion) store(time, paths.time, i);
      if (world.has_interiors)
        for (size_t k = 0; k < 2; ++k) store(splat_u(world.camera_media[k]), paths.media[k], i);
      if (world.has_volumes) store(splat_u(world.camera_volume), paths.volume, i);
      if (world.shares_paths)
        for (size_t j = 0; j < 4; ++j) store(splat(j < live ? 1.0f : 0.0f), paths.share[j], i);
      const auto inside = hn::And(is_within(x, tile.x0, tile.x1), is_within(y, tile.y0, tile.y1));
      const VU pixel =
          hn::Add(hn::Mul(hn::Sub(y, splat_u(tile.y0)), splat_u(tile.width())), hn::Sub(x, splat_u(tile.x0)));
      store(hn::IfThenElse(inside, pixel, splat_u(dead_lane)), slots.pixel, i);
      store(sample, slots.sample, i);
    }
  }
  paths.size = slots.size = static_cast<uint32_t>(i);
  slots.are_roots = true;
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(camera_rays_kernel);

void camera_rays(const World& world, std::span<const RayPacket> packets, const TileRect& tile, PathStream& paths,
                 Slots& slots) {
  HWY_DYNAMIC_DISPATCH(camera_rays_kernel)(world, packets, tile, paths, slots);
}

}  // namespace metamer
#endif
