#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/surface.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "engine/simd/math-inl.h"
#include "systems/lanes-inl.h"
#include "systems/placement-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

HWY_INLINE Vec3 abs(const Vec3& v) { return {hn::Abs(v.x), hn::Abs(v.y), hn::Abs(v.z)}; }
HWY_INLINE Vec3 max(const Vec3& a, const Vec3& b) { return {hn::Max(a.x, b.x), hn::Max(a.y, b.y), hn::Max(a.z, b.z)}; }
HWY_INLINE VF largest(const Vec3& v) { return hn::Max(hn::Max(v.x, v.y), v.z); }

struct Surface {
  Vec3 position, normal, shading_normal, tangent;
  VF u, v;
  VF offset;
};

// Unit roundoff of float.
constexpr float eps = 5.9604645e-8f;

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

  if (world.needs_tangents || world.carries_uvs()) {
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
  }
  return surface;
}

// u is the angle around z over 2 pi. v runs on a sphere from the lower pole to the upper one, by angle; on a disk from
// its rim (0) to its inner edge (1).
HWY_INLINE void quadric_uv(const Vec3& local, VF radius, VF inner_radius, MF sphere, Surface& surface) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const VF around = hn::Mul(atan2(local.y, local.x), splat(0.5f * inverse_pi));
  surface.u = hn::IfThenElse(hn::Lt(around, zero), hn::Add(around, one), around);
  const VF across = hn::Sqrt(hn::MulAdd(local.x, local.x, hn::Mul(local.y, local.y)));
  const VF from_top = hn::Mul(atan2(across, local.z), splat(inverse_pi));
  const VF width = hn::Max(hn::Sub(radius, inner_radius), splat(FLT_MIN));
  surface.v = hn::IfThenElse(sphere, hn::Sub(one, from_top), hn::Div(hn::Sub(radius, across), width));
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
  const MF sphere = float_mask(hn::Eq(kind, splat_u(static_cast<uint32_t>(ShapeKind::sphere))));
  Vec3 local = transform_point(inverse, mul_add(direction, distance, origin));
  const VF to_sphere = hn::Div(radius, hn::Sqrt(hn::Max(dot(local, local), splat(1e-30f))));
  local = if_then_else(sphere, local * to_sphere, Vec3{local.x, local.y, gather(&first.height, base)});
  Surface surface;
  const Vec3 linear = transform_vector(m, local);
  surface.position = linear + m.translation;
  const Vec3 up = {zero, zero, one};
  const Vec3 normal = normalize(transform_normal(inverse, if_then_else(sphere, local, up)));
  surface.normal = normal * gather(&first.normal_sign, base);
  surface.shading_normal = surface.normal;
  // On a sphere a step along the tangent plane leaves the surface, so distances are uncertain by their own rounding
  // only; the callback works in double.
  const Vec3 extent = {dot(abs(m.row[0]), abs(local)), dot(abs(m.row[1]), abs(local)), dot(abs(m.row[2]), abs(local))};
  surface.offset = hn::Mul(splat(16 * eps), largest(extent + abs(m.translation)));
  if (world.has_motion) surface.offset = hn::IfThenElse(moves, hn::Add(surface.offset, surface.offset), surface.offset);
  const Vec3 along = {hn::Neg(local.y), local.x, zero};
  const MF pole = hn::Eq(hn::Add(hn::Abs(local.x), hn::Abs(local.y)), zero);
  surface.tangent = transform_vector(m, if_then_else(pole, Vec3{one, zero, zero}, along));
  if (world.carries_uvs()) quadric_uv(local, radius, gather(&first.inner_radius, base), sphere, surface);
  return surface;
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
  if (!shade.carries_media) return;
  for (size_t k = 0; k < 2; ++k) store(gather(paths.media[k], path), shade.media[k], i);
}

void surface_kernel(const World& world, const PathStream& paths, const HitStream& hits, const uint32_t* order,
                    ShadeStream& shade) {
  const size_t step = lane_count();
  shade.carries_media = world.has_interiors;
  shade.carries_time = world.has_motion;
  const uint32_t miss_begin = shade.groups[static_cast<size_t>(ShadeKind::miss)].begin;
  for (size_t i = 0; i < shade.size; i += step) {
    const VU ordered = load(order, i);
    const auto live_u = hn::Ne(ordered, splat_u(dead_lane));
    const MF live = float_mask(live_u);
    // Dead lanes look at the batch's first path and are forgotten.
    const VI path = as_index(hn::IfThenElseZero(live_u, ordered));
    carry(paths, path, live, shade, i);
    if (i >= miss_begin) continue;
    const VU met = gather(hits.object, path);
    const VI object = as_index(hn::IfThenElseZero(hn::And(live_u, hn::Ne(met, splat_u(no_index))), met));
    const VU primitive = gather(hits.primitive, path);
    const Vec3 origin = gather(paths.origin, path), direction = gather(paths.direction, path);
    const VF time = world.has_motion ? gather(paths.time, path) : hn::Zero(FloatTag());
    const VU kind = gather(world.objects.kind.data(), object);
    const MF quadric = hn::And(live, float_mask(hn::Ne(kind, splat_u(static_cast<uint32_t>(ShapeKind::mesh)))));
    const MF triangle = hn::AndNot(quadric, live);
    // Lanes that are all dead count as quadrics where there are any: then there need be no triangle to look at.
    const bool any_quadric =
        world.has_quadrics && (!hn::AllFalse(FloatTag(), quadric) || hn::AllFalse(FloatTag(), triangle));
    Surface s;
    if (!any_quadric) {
      s = triangle_surface(world, origin, direction, time, object, primitive, triangle);
    } else {
      const Surface q = quadric_surface(world, origin, direction, time, object, gather(hits.distance, path));
      s = q;
      if (!hn::AllFalse(FloatTag(), triangle))
        s = triangle_surface(world, origin, direction, time, object, primitive, triangle);
      s.position = if_then_else(quadric, q.position, s.position);
      s.normal = if_then_else(quadric, q.normal, s.normal);
      s.shading_normal = if_then_else(quadric, q.shading_normal, s.shading_normal);
      s.tangent = if_then_else(quadric, q.tangent, s.tangent);
      s.u = hn::IfThenElse(quadric, q.u, s.u);
      s.v = hn::IfThenElse(quadric, q.v, s.v);
      s.offset = hn::IfThenElse(quadric, q.offset, s.offset);
    }
    store(s.position, shade.position, i);
    store(s.normal, shade.normal, i);
    store(s.shading_normal, shade.shading_normal, i);
    if (world.needs_tangents) store(s.tangent, shade.tangent, i);
    if (world.carries_uvs()) {
      store(s.u, shade.uv[0], i);
      store(s.v, shade.uv[1], i);
    }
    store(s.offset, shade.offset, i);
    const Vec3 travelled = s.position - origin;
    store(hn::Sqrt(dot(travelled, travelled)), shade.distance, i);
    store(gather(hits.material, path), shade.material, i);
    const VU first_light = gather(world.objects.first_light.data(), object);
    const auto emits = hn::And(live_u, hn::Ne(first_light, splat_u(no_index)));
    const VU light = hn::Add(first_light, hn::IfThenZeroElse(uint_mask(quadric), primitive));
    store(hn::IfThenElse(emits, light, splat_u(no_index)), shade.light, i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(surface_kernel);

void surface(const World& world, const PathStream& paths, const HitStream& hits, const uint32_t* order,
             ShadeStream& shade) {
  HWY_DYNAMIC_DISPATCH(surface_kernel)(world, paths, hits, order, shade);
}

}  // namespace metamer
#endif
