#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/surface.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "engine/simd/math-inl.h"
#include "systems/curve_surface-inl.h"
#include "systems/lanes-inl.h"
#include "systems/placement-inl.h"
#include "systems/surface-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// The point where the ray meets the plane of the triangle, as barycentrics clamped into the triangle: computed here
// and not taken from Embree, whose arithmetic depends on how it traced the ray. Moeller & Trumbore, JGT 2(1), 1997.
//
// How far a new ray must start away so that Embree's own rounding cannot find this triangle again: the position is a
// sum of products b_j v_j, each rounded (a few eps of |b_j v_j| along the normal), and Embree evaluates the plane at
// the new origin with a few eps of the distance to its vertices, more for slivers, whose normal is less certain.
HWY_INLINE Surface triangle_surface(const World& world, const Vec3& origin, const Vec3& direction, VF time, VI object,
                                    VU primitive, MF live) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = splat(1.0f);
  const VU first = gather(world.objects.first_triangle.data(), object);
  const VU triangle = hn::IfThenElseZero(uint_mask(live), hn::Add(first, primitive));
  const VI corner = as_index(hn::Mul(triangle, splat_u(3)));
  VI vertex[3];
  Vec3 p[3], n[3];
  for (int k = 0; k < 3; ++k) {
    const VU v = gather(world.triangle_vertices.data() + k, corner);
    vertex[k] = as_index(v);
    const VI at = as_index(hn::Mul(v, splat_u(3)));
    p[k] = gather_vec3(world.positions.data(), at);
    n[k] = gather_vec3(world.normals.data(), at);
  }
  VF side = one;
  ObjectToWorld place;
  MF placed = hn::Lt(one, zero);
  if (world.has_instances) {
    const VI placement = as_index(gather(world.objects.placement.data(), object));
    placed = hn::RebindMask(d, hn::Ne(placement, hn::Zero(IntTag())));
    place = object_to_world(world, object, placement, time);
    side = hn::IfThenElse(placed, gather(&world.placements[0].normal_sign, hn::ShiftLeft<5>(placement)), one);
    for (int k = 0; k < 3; ++k) p[k] = if_then_else(placed, transform_point(place.matrix, p[k]), p[k]);
  }
  const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0], s = origin - p[0];
  const Vec3 h = cross(direction, e2), q = cross(s, e1);
  const VF determinant = dot(e1, h);
  const VF inverse_determinant = safe_reciprocal(determinant);
  VF b1 = hn::Min(hn::Max(hn::Mul(dot(s, h), inverse_determinant), zero), one);
  VF b2 = hn::Min(hn::Max(hn::Mul(dot(direction, q), inverse_determinant), zero), one);
  const VF excess = hn::Max(hn::Add(b1, b2), one);
  b1 = hn::Div(b1, excess);
  b2 = hn::Div(b2, excess);
  const VF b0 = hn::Max(hn::Sub(hn::Sub(one, b1), b2), zero);

  Surface surface;
  surface.position = mul_add(p[0], b0, mul_add(p[1], b1, p[2] * b2));
  // Edges relative to the longest: the square of an area leaves float's range for edges of 1e-10 and of 1e10 metres.
  const VF edge = hn::Sqrt(hn::Max(dot(e1, e1), dot(e2, e2)));
  const VF inverse_edge = safe_reciprocal(edge);
  const Vec3 crossed = cross(e1 * inverse_edge, e2 * inverse_edge);
  const VF inverse_length = safe_reciprocal(hn::Sqrt(dot(crossed, crossed)));
  surface.normal = crossed * hn::Mul(inverse_length, side);
  Vec3 shading = mul_add(n[0], b0, mul_add(n[1], b1, n[2] * b2));
  if (world.has_instances) shading = if_then_else(placed, transform_normal(place.inverse, shading), shading);
  const VF shading_length2 = dot(shading, shading);
  const MF smooth = hn::Gt(shading_length2, splat(1e-20f));
  shading =
      if_then_else(smooth, shading * hn::Div(one, hn::Sqrt(hn::Max(shading_length2, splat(1e-20f)))), surface.normal);
  surface.shading_normal = shading;

  const Vec3 terms = mul_add(abs(p[0]), b0, mul_add(abs(p[1]), b1, abs(p[2]) * b2));
  const VF sliver = hn::Min(inverse_length, splat(64.0f));
  surface.offset = hn::MulAdd(splat(8 * eps), dot(abs(surface.normal), terms),
                              hn::Mul(hn::Mul(splat(4 * eps), edge), hn::Add(one, sliver)));
  // Far from the origin Embree's difference of two coordinates rounds by their size.
  const Vec3 reach = max(max(abs(p[0]), abs(p[1])), abs(p[2]));
  surface.offset = hn::MulAdd(splat(2 * eps), dot(abs(surface.normal), reach), surface.offset);
  // Embree interpolates a moving object's matrix itself, and inverts it, in single precision.
  if (world.has_instances && world.has_motion) {
    const Vec3 extent = reach + abs(place.matrix.translation);
    surface.offset =
        hn::IfThenElse(place.moves, hn::MulAdd(splat(16 * eps), largest(extent), surface.offset), surface.offset);
  }

  if (world.needs_tangents || world.needs_uvs()) {
    VF u[3], v[3];
    for (int k = 0; k < 3; ++k) {
      const VI at = hn::Add(vertex[k], vertex[k]);
      u[k] = gather(world.uvs.data(), at);
      v[k] = gather(world.uvs.data() + 1, at);
      const MF missing = hn::IsNaN(u[k]);
      u[k] = hn::IfThenElse(missing, splat(k > 0 ? 1.0f : 0.0f), u[k]);
      v[k] = hn::IfThenElse(missing, splat(k > 1 ? 1.0f : 0.0f), v[k]);
    }
    surface.u = hn::MulAdd(b0, u[0], hn::MulAdd(b1, u[1], hn::Mul(b2, u[2])));
    surface.v = hn::MulAdd(b0, v[0], hn::MulAdd(b1, v[1], hn::Mul(b2, v[2])));
    const VF du1 = hn::Sub(u[1], u[0]), dv1 = hn::Sub(v[1], v[0]);
    const VF du2 = hn::Sub(u[2], u[0]), dv2 = hn::Sub(v[2], v[0]);
    const VF uv_area = hn::MulSub(du1, dv2, hn::Mul(dv1, du2));
    const Vec3 along_u = (e1 * dv2 - e2 * dv1) * hn::CopySign(one, uv_area);
    surface.tangent = if_then_else(hn::Eq(uv_area, zero), make_frame(shading).s, along_u);
    if (world.has_mips)
      uv_footprint(world.camera, surface.position, surface.normal, linear_slopes({du1, dv1, du2, dv2}, e1, e2),
                   surface.footprint);
    if (world.has_bumps) {
      if (world.has_instances)
        for (Vec3& normal : n) normal = if_then_else(placed, transform_normal(place.inverse, normal), normal);
      surface.slopes = triangle_slopes({du1, dv1, du2, dv2}, e1, e2, n, smooth, shading);
    }
  }
  return surface;
}

// As pbrt-v4. u is the angle around z over the largest one. v runs on a sphere from its lowest circle to its highest,
// by angle; on a cylinder from end to end; on a disk from its rim (0) to its inner edge (1).
HWY_INLINE void quadric_uv(const Placement& first, VI base, const Vec3& local, VU kind, Surface& surface) {
  const VF zero = hn::Zero(FloatTag());
  const VF radius = gather(&first.radius, base), phi_max = gather(&first.phi_max, base);
  VF around = atan2(local.y, local.x);
  around = hn::IfThenElse(hn::Lt(around, zero), hn::Add(around, splat(two_pi)), around);
  // Rounding must not take the first edge to behind the last one.
  around = hn::IfThenElseZero(hn::Le(around, hn::MulAdd(phi_max, splat(0.5f), splat(pi))), around);
  surface.u = hn::Min(hn::Div(around, phi_max), splat(1.0f));
  const VF across = hn::Sqrt(hn::MulAdd(local.x, local.x, hn::Mul(local.y, local.y)));
  const auto polar = [&](VF z) {
    const VF r2 = hn::Mul(hn::Sub(radius, z), hn::Add(radius, z));
    return atan2(safe_sqrt(r2), z);
  };
  const VF z_min = gather(&first.z_min, base), z_max = gather(&first.z_max, base);
  const VF lowest = polar(hn::Max(z_min, hn::Neg(radius))), highest = polar(hn::Min(z_max, radius));
  const MF sphere = is_kind(kind, ShapeKind::sphere), cylinder = is_kind(kind, ShapeKind::cylinder);
  const VF rim = hn::IfThenElse(cylinder, z_min, radius),
           end = hn::IfThenElse(cylinder, z_max, gather(&first.inner_radius, base));
  const VF from = hn::IfThenElse(sphere, lowest, rim), to = hn::IfThenElse(sphere, highest, end);
  const VF at = hn::IfThenElse(sphere, atan2(across, local.z), hn::IfThenElse(cylinder, local.z, across));
  surface.v = hn::Min(hn::Max(hn::Mul(hn::Sub(at, from), safe_reciprocal(hn::Sub(to, from))), zero), splat(1.0f));
}

// The distance comes from our own double-precision callback; the point is put back onto the quadric.
HWY_INLINE Surface quadric_surface(const World& world, const Vec3& origin, const Vec3& direction, VF time, VI object,
                                   VF distance) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = splat(1.0f);
  const VI placement = as_index(gather(world.objects.placement.data(), object));
  const VI base = hn::ShiftLeft<5>(placement);
  const Placement& first = world.placements[0];
  const auto [m, inverse, moves] = object_to_world(world, object, placement, time);
  const VF radius = gather(&first.radius, base);
  const VU kind = gather(world.objects.kind.data(), object);
  const MF sphere = is_kind(kind, ShapeKind::sphere), cylinder = is_kind(kind, ShapeKind::cylinder);
  Vec3 local = transform_point(inverse, mul_add(direction, distance, origin));
  const VF to_sphere = hn::Div(radius, hn::Sqrt(hn::Max(dot(local, local), splat(1e-30f))));
  const VF across = hn::Sqrt(hn::MulAdd(local.x, local.x, hn::Mul(local.y, local.y)));
  const VF to_cylinder = hn::IfThenElse(cylinder, hn::Div(radius, hn::Max(across, splat(1e-30f))), one);
  const VF z_min = gather(&first.z_min, base), z_max = gather(&first.z_max, base);
  const Vec3 between = {hn::Mul(local.x, to_cylinder), hn::Mul(local.y, to_cylinder),
                        hn::Min(hn::Max(local.z, z_min), z_max)};
  local = if_then_else(sphere, local * to_sphere, between);
  Surface surface;
  const Vec3 linear = transform_vector(m, local);
  surface.position = linear + m.translation;
  const Vec3 outwards = {hn::IfThenElseZero(cylinder, local.x), hn::IfThenElseZero(cylinder, local.y),
                         hn::IfThenElse(cylinder, zero, one)};
  const Vec3 normal = transform_normal(inverse, if_then_else(sphere, local, outwards));
  const VF side = gather(&first.normal_sign, base);
  surface.normal = normalize(normal) * side;
  surface.shading_normal = surface.normal;
  // On a sphere a step along the tangent plane leaves the surface, so distances are uncertain by their own rounding
  // only; the callback works in double.
  const Vec3 extent = {dot(abs(m.row[0]), abs(local)), dot(abs(m.row[1]), abs(local)), dot(abs(m.row[2]), abs(local))};
  surface.offset = hn::Mul(splat(16 * eps), largest(extent + abs(m.translation)));
  if (world.has_motion) surface.offset = hn::IfThenElse(moves, hn::Add(surface.offset, surface.offset), surface.offset);
  const Vec3 along = {hn::Neg(local.y), local.x, zero};
  const MF pole = hn::Eq(hn::Add(hn::Abs(local.x), hn::Abs(local.y)), zero);
  surface.tangent = transform_vector(m, if_then_else(pole, Vec3{one, zero, zero}, along));
  if (world.needs_uvs()) quadric_uv(first, base, local, kind, surface);
  if (world.has_bumps || world.has_mips) {
    // The normal of a sphere or cylinder turns as the point does; on a cylinder not along it.
    const VF bend = hn::Div(side, hn::Sqrt(dot(normal, normal)));
    const VF around = hn::IfThenElseZero(hn::Or(sphere, cylinder), bend), down = hn::IfThenElseZero(sphere, bend);
    const Slopes p = quadric_slopes(first, base, local, sphere, cylinder);
    const Slopes placed = {transform_vector(m, p.along_u), transform_vector(m, p.along_v)};
    if (world.has_mips) uv_footprint(world.camera, surface.position, surface.normal, placed, surface.footprint);
    surface.slopes = {placed,
                      {transform_normal(inverse, p.along_u) * around, transform_normal(inverse, p.along_v) * down}};
  }
  return surface;
}

// A scattering in a volume: there is no surface, so the normal is any direction and rays start at the point itself.
HWY_INLINE void store_scattering(const PathStream& paths, const HitStream& hits, VI path, ShadeStream& shade,
                                 size_t i) {
  const VF distance = gather(hits.distance, path);
  const Vec3 direction = gather(paths.direction, path);
  store(mul_add(direction, distance, gather(paths.origin, path)), shade.position, i);
  store(-direction, shade.normal, i);
  store(-direction, shade.shading_normal, i);
  store(hn::Zero(FloatTag()), shade.offset, i);
  store(distance, shade.distance, i);
  const VU volume = gather(paths.volume, path);
  store(volume, shade.material, i);
  store(splat_u(no_index), shade.light, i);
  for (uint32_t* side : shade.volumes) store(volume, side, i);
}

// What the ray is in behind the surface, on either side of it.
HWY_INLINE void store_volumes(const World& world, const PathStream& paths, VI path, VI object, ShadeStream& shade,
                              size_t i) {
  const VU before = gather(paths.volume, path);
  const VU inside = gather(world.objects.volume_inside.data(), object);
  const VU outside = gather(world.objects.volume_outside.data(), object);
  const auto kept = hn::Eq(inside, splat_u(keeps_volume));
  store(before, shade.volume, i);
  store(hn::IfThenElse(kept, before, inside), shade.volumes[0], i);
  store(hn::IfThenElse(kept, before, outside), shade.volumes[1], i);
}

// What goes along with the path whatever it met.
HWY_INLINE void carry(const PathStream& paths, VI path, MF live, ShadeStream& shade, size_t i) {
  store(-gather(paths.direction, path), shade.wo, i);
  for (size_t j = 0; j < 4; ++j) {
    store(gather(paths.lambda_nm[j], path), shade.lambda_nm[j], i);
    store(hn::IfThenElseZero(live, gather(paths.throughput[j], path)), shade.throughput[j], i);
  }
  store(gather(paths.pdf_direction, path), shade.pdf_direction, i);
  store(gather(paths.eta_scale, path), shade.eta_scale, i);
  store(gather(paths.pixel_seed, path), shade.pixel_seed, i);
  store(gather(paths.index, path), shade.index, i);
  store(hn::IfThenElse(uint_mask(live), gather(paths.slot, path), splat_u(dead_lane)), shade.slot, i);
  if (shade.carries_time) store(gather(paths.time, path), shade.time, i);
  if (shade.carries_media)
    for (size_t k = 0; k < 2; ++k) store(gather(paths.media[k], path), shade.media[k], i);
  if (shade.carries_shares)
    for (size_t j = 0; j < 4; ++j) store(gather(paths.share[j], path), shade.share[j], i);
}

void surface_kernel(const World& world, const PathStream& paths, const HitStream& hits, const uint32_t* order,
                    ShadeStream& shade) {
  const size_t step = lane_count();
  shade.carries_media = world.has_interiors;
  shade.carries_volumes = world.has_volumes;
  shade.carries_shares = world.shares_paths;
  shade.carries_keys = world.has_grids;
  const Group& phase = shade.groups[static_cast<size_t>(ShadeKind::phase)];
  shade.carries_time = world.has_motion;
  const uint32_t miss_begin = shade.groups[static_cast<size_t>(ShadeKind::miss)].begin;
  for (size_t i = 0; i < shade.size; i += step) {
    const VU ordered = load(order, i);
    const auto live_u = hn::Ne(ordered, splat_u(dead_lane));
    const MF live = float_mask(live_u);
    // Dead lanes look at the batch's first path and are forgotten.
    const VI path = as_index(hn::IfThenElseZero(live_u, ordered));
    carry(paths, path, live, shade, i);
    if (i >= miss_begin) {
      if (world.has_portals) store(gather(paths.origin, path), shade.position, i);
      continue;
    }
    if (i >= phase.begin && i < phase.padded_end()) {
      store_scattering(paths, hits, path, shade, i);
      continue;
    }
    const VU met = gather(hits.object, path);
    const VI object = as_index(hn::IfThenElseZero(hn::And(live_u, hn::Ne(met, splat_u(no_index))), met));
    const VU primitive = gather(hits.primitive, path);
    const Vec3 origin = gather(paths.origin, path), direction = gather(paths.direction, path);
    const VF time = world.has_motion ? gather(paths.time, path) : hn::Zero(FloatTag());
    const VU kind = gather(world.objects.kind.data(), object);
    const MF triangle = hn::And(live, is_kind(kind, ShapeKind::mesh));
    const VU last_quadric = splat_u(static_cast<uint32_t>(ShapeKind::cylinder));
    const MF curve = hn::And(live, float_mask(hn::Lt(last_quadric, kind)));
    const MF quadric = hn::AndNot(triangle, hn::AndNot(curve, live));
    // Lanes that are all dead look at what there is.
    const FloatTag d;
    const bool idle = hn::AllFalse(d, live);
    const bool quadrics = world.has_quadrics && (idle || !hn::AllFalse(d, quadric));
    const bool curves = world.has_curves && ((idle && !quadrics) || !hn::AllFalse(d, curve));
    const bool triangles = (idle && !quadrics && !curves) || !hn::AllFalse(d, triangle);
    const VF distance = gather(hits.distance, path);
    Surface s;
    if (triangles) s = triangle_surface(world, origin, direction, time, object, primitive, triangle);
    if (quadrics) {
      const Surface q = quadric_surface(world, origin, direction, time, object, distance);
      s = triangles ? select(quadric, q, s) : q;
    }
    if (curves) {
      const VF u = gather(hits.u, path);
      const Surface c = curve_surface(world, origin, direction, time, object, primitive, u, distance, curve);
      s = triangles || quadrics ? select(curve, c, s) : c;
    }
    store(s.position, shade.position, i);
    store(s.normal, shade.normal, i);
    store(s.shading_normal, shade.shading_normal, i);
    if (world.needs_tangents) store(s.tangent, shade.tangent, i);
    if (world.needs_uvs()) {
      store(s.u, shade.uv[0], i);
      store(s.v, shade.uv[1], i);
    }
    if (world.has_mips) store(s.footprint, shade.footprint, i);
    if (world.has_bumps) {
      store(s.slopes.position.along_u, shade.dp_du, i);
      store(s.slopes.position.along_v, shade.dp_dv, i);
      store(s.slopes.normal.along_u, shade.dn_du, i);
      store(s.slopes.normal.along_v, shade.dn_dv, i);
    }
    store(s.offset, shade.offset, i);
    const Vec3 travelled = s.position - origin;
    store(hn::Sqrt(dot(travelled, travelled)), shade.distance, i);
    store(gather(hits.material, path), shade.material, i);
    if (shade.carries_volumes) store_volumes(world, paths, path, object, shade, i);
    const VU first_light = gather(world.objects.first_light.data(), object);
    auto emits = hn::And(live_u, hn::Ne(first_light, splat_u(no_index)));
    if (shade.carries_volumes)
      emits = hn::AndNot(uint_mask(hn::Eq(gather(hits.depth_left, path), splat(light_is_counted))), emits);
    const VU light = hn::Add(first_light, hn::IfThenZeroElse(uint_mask(quadric), primitive));
    store(hn::IfThenElse(emits, light, splat_u(no_index)), shade.light, i);
  }
}

SurfacePoint surface_point_kernel(const World& world, const RayHit& hit) {
  const Vec3 origin = {splat(hit.origin[0]), splat(hit.origin[1]), splat(hit.origin[2])};
  const Vec3 direction = {splat(hit.direction[0]), splat(hit.direction[1]), splat(hit.direction[2])};
  const VI object = hn::Set(IntTag(), static_cast<int32_t>(hit.object));
  const auto kind = static_cast<ShapeKind>(world.objects.kind[hit.object]);
  const MF all = hn::Eq(origin.x, origin.x);
  const VF time = splat(hit.time);
  const VU primitive = splat_u(hit.primitive);
  const VF distance = splat(hit.distance);
  Surface s;
  if (kind == ShapeKind::mesh)
    s = triangle_surface(world, origin, direction, time, object, primitive, all);
  else if (is_curves(kind))
    s = curve_surface(world, origin, direction, time, object, primitive, splat(hit.u), distance, all);
  else
    s = quadric_surface(world, origin, direction, time, object, distance);
  const auto first = [](VF v) { return hn::GetLane(v); };
  SurfacePoint point = {{first(s.u), first(s.v)},
                        {first(s.position.x), first(s.position.y), first(s.position.z)},
                        {first(s.normal.x), first(s.normal.y), first(s.normal.z)},
                        {}};
  if (world.has_mips)
    for (int k = 0; k < 4; ++k) point.footprint[k] = first(s.footprint[k]);
  return point;
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(surface_kernel);
HWY_EXPORT(surface_point_kernel);

void surface(const World& world, const PathStream& paths, const HitStream& hits, const uint32_t* order,
             ShadeStream& shade) {
  HWY_DYNAMIC_DISPATCH(surface_kernel)(world, paths, hits, order, shade);
}

SurfacePoint surface_point(const World& world, const RayHit& hit) {
  return HWY_DYNAMIC_DISPATCH(surface_point_kernel)(world, hit);
}

}  // namespace metamer
#endif
