// Where an object is: rows of its matrix in each lane, at the lane's time if it moves.
#if defined(METAMER_SYSTEMS_PLACEMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_PLACEMENT_INL_H_
#undef METAMER_SYSTEMS_PLACEMENT_INL_H_
#else
#define METAMER_SYSTEMS_PLACEMENT_INL_H_
#endif

#include "engine/ecs/world.h"
#include "engine/simd/math-inl.h"
#include "systems/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

struct Matrix {
  Vec3 row[3];
  Vec3 translation;
};
// `base` counts floats.
HWY_INLINE Matrix gather_matrix(const float* matrices, VI base) {
  Matrix m;
  VF t[3];
  for (int r = 0; r < 3; ++r) {
    m.row[r] = gather_vec3(matrices + 4 * r, base);
    t[r] = gather(matrices + 4 * r + 3, base);
  }
  m.translation = {t[0], t[1], t[2]};
  return m;
}
HWY_INLINE Vec3 transform_vector(const Matrix& m, const Vec3& v) {
  return {dot(m.row[0], v), dot(m.row[1], v), dot(m.row[2], v)};
}
HWY_INLINE Vec3 transform_point(const Matrix& m, const Vec3& p) { return transform_vector(m, p) + m.translation; }
// By the transpose: normals go to the world by the inverse's.
HWY_INLINE Vec3 transform_normal(const Matrix& inverse, const Vec3& n) {
  return mul_add(inverse.row[0], n.x, mul_add(inverse.row[1], n.y, inverse.row[2] * n.z));
}

// Which two of `count` keys, 2 or more, evenly spaced over [0, 1], lie around a time within, and how far it is from the
// first to the second. Embree's rule.
struct KeySegment {
  VI first;
  VF fraction;
};
HWY_INLINE KeySegment key_segment(VU count, VF time) {
  const VI segments = hn::Sub(as_index(count), hn::Set(IntTag(), 1));
  const VF scaled = hn::Mul(time, hn::ConvertTo(FloatTag(), segments));
  const VI last = hn::Max(hn::Sub(segments, hn::Set(IntTag(), 1)), hn::Zero(IntTag()));
  const VI first = hn::Min(hn::ConvertTo(IntTag(), scaled), last);
  return {first, hn::Sub(scaled, hn::ConvertTo(FloatTag(), first))};
}
HWY_INLINE VF lerp(VF a, VF b, VF t) { return hn::MulAdd(t, b, hn::Mul(hn::Sub(splat(1.0f), t), a)); }
HWY_INLINE Vec3 lerp(const Vec3& a, const Vec3& b, VF t) {
  return {lerp(a.x, b.x, t), lerp(a.y, b.y, t), lerp(a.z, b.z, t)};
}
HWY_INLINE Matrix lerp(const Matrix& a, const Matrix& b, VF t) {
  return {{lerp(a.row[0], b.row[0], t), lerp(a.row[1], b.row[1], t), lerp(a.row[2], b.row[2], t)},
          lerp(a.translation, b.translation, t)};
}
HWY_INLINE Matrix if_then_else(MF mask, const Matrix& yes, const Matrix& no) {
  Matrix m;
  for (int r = 0; r < 3; ++r) m.row[r] = if_then_else(mask, yes.row[r], no.row[r]);
  m.translation = if_then_else(mask, yes.translation, no.translation);
  return m;
}

// Of an affine matrix that is not singular: the adjugate over the determinant.
HWY_INLINE Matrix inverse(const Matrix& m) {
  const Vec3 x = cross(m.row[1], m.row[2]), y = cross(m.row[2], m.row[0]), z = cross(m.row[0], m.row[1]);
  const VF scale = safe_reciprocal(dot(m.row[0], x));
  Matrix result;
  result.row[0] = Vec3{x.x, y.x, z.x} * scale;
  result.row[1] = Vec3{x.y, y.y, z.y} * scale;
  result.row[2] = Vec3{x.z, y.z, z.z} * scale;
  result.translation = -transform_vector(result, m.translation);
  return result;
}

struct ObjectToWorld {
  Matrix matrix, inverse;
  MF moves;
};
// `placement` is the object's, `time` within [0, 1] and looked at only where the world has motion.
HWY_INLINE ObjectToWorld object_to_world(const World& world, VI object, VI placement, VF time) {
  const VI base = hn::ShiftLeft<5>(placement);
  ObjectToWorld place;
  place.matrix = gather_matrix(world.placements[0].to_world, base);
  place.inverse = gather_matrix(world.placements[0].to_object, base);
  place.moves = hn::Lt(time, time);
  if (!world.has_motion) return place;
  const VU count = gather(world.objects.key_count.data(), object);
  place.moves = float_mask(hn::Ne(count, splat_u(0)));
  if (hn::AllFalse(FloatTag(), place.moves)) return place;
  const KeySegment segment = key_segment(hn::IfThenElse(uint_mask(place.moves), count, splat_u(2)), time);
  const VI first_key = as_index(gather(world.objects.first_key.data(), object));
  const VI key = hn::IfThenElseZero(hn::RebindMask(IntTag(), place.moves), hn::Add(first_key, segment.first));
  const float* keys = world.motion_keys[0].to_world;
  const VI key_base = hn::ShiftLeft<4>(key);
  const Matrix m = lerp(gather_matrix(keys, key_base),
                        gather_matrix(keys + sizeof(MotionKey) / sizeof(float), key_base), segment.fraction);
  place.matrix = if_then_else(place.moves, m, place.matrix);
  place.inverse = if_then_else(place.moves, inverse(m), place.inverse);
  return place;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
