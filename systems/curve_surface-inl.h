// Hits of flat, round and oriented curves.
#if defined(METAMER_SYSTEMS_CURVE_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_CURVE_SURFACE_INL_H_
#undef METAMER_SYSTEMS_CURVE_SURFACE_INL_H_
#else
#define METAMER_SYSTEMS_CURVE_SURFACE_INL_H_
#endif

#include "systems/placement-inl.h"
#include "systems/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// A point of a Bezier curve of degree 3 and, without a factor of 3, its derivative, by de Casteljau.
struct CurvePoint {
  Vec3 position, derivative;
};
HWY_INLINE CurvePoint bezier(const Vec3 (&p)[4], VF u) {
  const Vec3 a = lerp(p[0], p[1], u), b = lerp(p[1], p[2], u), c = lerp(p[2], p[3], u);
  const Vec3 ab = lerp(a, b, u), bc = lerp(b, c, u);
  const Vec3 derivative = bc - ab;
  // Where the first two or the last two points are one: towards the other end.
  const MF stands = hn::Le(dot(derivative, derivative), hn::Zero(FloatTag()));
  return {lerp(ab, bc, u), if_then_else(stands, p[3] - p[0], derivative)};
}

HWY_INLINE Vec3 unit_or(const Vec3& v, const Vec3& fallback) {
  const VF length2 = dot(v, v), least = splat(1e-30f);
  return if_then_else(hn::Gt(length2, least), v * hn::Div(splat(1.0f), hn::Sqrt(hn::Max(length2, least))), fallback);
}

// Curves keep Embree's hit. What belongs to it is pbrt-v4's (shapes.cpp, Curve::RecursiveIntersect) but for one thing:
// the normals of flat and round curves are on the side that is seen, there on the other. Flat curves stand in the plane
// of the tangent that is turned to the ray; round ones have the normals of half a tube across their width; ribbons
// those they were given. A new ray starts more than half a width away from a flat or round curve, which will turn to
// it: then it never comes within half a width of a straight one again. (Embree also overlooks hits nearer than a
// width.)
HWY_INLINE Surface curve_surface(const World& world, const Vec3& origin, const Vec3& direction, VF time, VI object,
                                 VU primitive, VF u, VF distance, MF live) {
  const FloatTag d;
  const VF zero = hn::Zero(d), one = splat(1.0f), half = splat(0.5f);
  const VI placement = as_index(hn::IfThenElseZero(uint_mask(live), gather(world.objects.placement.data(), object)));
  const VI placed = hn::IfThenElseZero(hn::RebindMask(IntTag(), live), object);
  const auto [m, inverse, moves] = object_to_world(world, placed, placement, time);
  const VU row = hn::Add(gather(world.objects.first_triangle.data(), object), primitive);
  const VI segment = as_index(hn::IfThenElseZero(uint_mask(live), row));
  const VU first_point = gather(world.curve_segments.data(), segment);
  const MF ribbon = hn::And(live, is_kind(gather(world.objects.kind.data(), object), ShapeKind::ribbons));
  Vec3 p[4], n[4], half_width[4];
  for (uint32_t k = 0; k < 4; ++k) {
    const VU point = hn::Add(first_point, splat_u(k));
    const VI at = as_index(hn::ShiftLeft<2>(point));
    p[k] = gather_vec3(world.curve_points.data(), at);
    half_width[k] = {gather(world.curve_points.data() + 3, at), zero, zero};
    n[k] = {zero, zero, zero};
    if (!world.curve_normals.empty())
      n[k] = gather_vec3(world.curve_normals.data(), as_index(hn::Mul(point, splat_u(3))));
  }
  const CurvePoint centre = bezier(p, u);
  const VF width = hn::Max(hn::Mul(splat(2.0f), bezier(half_width, u).position.x), splat(1e-30f));
  const Vec3 along = centre.derivative * safe_reciprocal(hn::Sqrt(dot(centre.derivative, centre.derivative)));
  const Vec3 unscaled = transform_vector(inverse, direction);
  const Vec3 ray = unscaled * safe_reciprocal(largest(abs(unscaled)));
  const Vec3 local = transform_point(inverse, mul_add(direction, distance, origin));
  // The width's direction as pbrt counts v: to the left of the tangent for who looks along the ray.
  const Vec3 across = unit_or(cross(ray, along), make_frame(along).s);
  const Vec3 faces = cross(across, along);
  const Vec3 given = unit_or(bezier(n, u).position, faces);
  const Vec3 ribbon_across = unit_or(cross(given, along), across);
  const VF side = hn::CopySign(one, dot(ribbon_across, across));
  const Vec3 v_axis = if_then_else(ribbon, ribbon_across * side, across);
  const VF off_centre = hn::Div(dot(local - centre.position, v_axis), width);
  const VF v = hn::Min(hn::Max(hn::Add(off_centre, half), zero), one);
  const SinCos around = sincos_2pi(hn::MulSub(v, half, splat(0.25f)));  // from -90 to 90 degrees
  const MF round = is_kind(gather(world.objects.kind.data(), object), ShapeKind::round_curves);
  Vec3 normal = if_then_else(round, mul_add(across, around.sin, faces * around.cos), faces);
  normal = if_then_else(ribbon, cross(along, ribbon_across), normal);
  Surface surface;
  surface.position = mul_add(direction, distance, origin);
  surface.normal = normalize(transform_normal(inverse, normal)) *
                   gather(&world.placements[0].normal_sign, hn::ShiftLeft<5>(placement));
  surface.shading_normal = surface.normal;
  surface.tangent = transform_vector(m, along);
  const VI span = hn::Add(segment, segment);
  if (world.has_bumps || world.has_mips) {
    // Bumps along the fibre and across; the normal counts as constant.
    const Vec3 none = {zero, zero, zero};
    const Slopes along_and_across = {transform_vector(m, centre.derivative * splat(3.0f)),
                                     transform_vector(m, v_axis * width)};
    surface.slopes = {along_and_across, {none, none}};
    if (world.has_mips) {
      // The fibre's own u runs over several segments.
      const VF per_u = safe_reciprocal(gather(world.curve_u.data() + 1, span));
      uv_footprint(world.camera, surface.position, surface.normal,
                   {along_and_across.along_u * per_u, along_and_across.along_v}, surface.footprint);
    }
  }
  surface.u = hn::MulAdd(u, gather(world.curve_u.data() + 1, span), gather(world.curve_u.data(), span));
  surface.v = v;
  const Vec3 ones = {one, one, one};
  const Vec3 widths = Vec3{dot(abs(m.row[0]), ones), dot(abs(m.row[1]), ones), dot(abs(m.row[2]), ones)} * width;
  const VF away = hn::Mul(dot(abs(surface.normal), widths), hn::IfThenElse(ribbon, splat(1e-3f), splat(0.55f)));
  surface.offset = hn::MulAdd(splat(64 * eps), largest(abs(surface.position)), away);
  return surface;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
