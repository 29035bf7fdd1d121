// Where on a texture a point of a surface lies, and the patterns that are computed there. Formulas: pbrt-v4,
// https://pbrt.org/fileformat-v4#textures and chapter 10 of the book (pbr-book.org/4ed).
#if defined(METAMER_SYSTEMS_TEXTURE_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_TEXTURE_POINTS_INL_H_
#undef METAMER_SYSTEMS_TEXTURE_POINTS_INL_H_
#else
#define METAMER_SYSTEMS_TEXTURE_POINTS_INL_H_
#endif

#include "engine/ecs/texture.h"
#include "engine/sampling/points-inl.h"
#include "engine/simd/math-inl.h"
#include "systems/noise-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// What a texture may ask about a lane.
struct TexturePoint {
  VF u, v;
  Vec3 position, normal;  // in the world; the normal is the geometric one
  VF footprint[4];        // ShadeStream's; where the world has mips
  VF lambda_nm[4];
  PointKey key;
  uint32_t depth;
};

HWY_INLINE Vec3 splat_vec3(const float (&v)[3]) { return {splat(v[0]), splat(v[1]), splat(v[2])}; }

HWY_INLINE Vec3 to_texture_space(const TextureMapping& mapping, const Vec3& p) {
  const float(&m)[12] = mapping.to_texture;
  const auto row = [&](int i) {
    return hn::MulAdd(splat(m[i]), p.x,
                      hn::MulAdd(splat(m[i + 1]), p.y, hn::MulAdd(splat(m[i + 2]), p.z, splat(m[i + 3]))));
  };
  return {row(0), row(4), row(8)};
}

// Coordinates of the point on its texture; z is 0 but for TextureMapping::Kind::point.
HWY_INLINE Vec3 map_point(const TextureMapping& mapping, const TexturePoint& point) {
  const VF zero = hn::Zero(FloatTag());
  const VF u_offset = splat(mapping.u_offset), v_offset = splat(mapping.v_offset);
  if (mapping.kind == TextureMapping::Kind::uv)
    return {hn::MulAdd(point.u, splat(mapping.u_scale), u_offset),
            hn::MulAdd(point.v, splat(mapping.v_scale), v_offset), zero};
  const Vec3 p = to_texture_space(mapping, point.position);
  // The azimuth as a turn, from 0 to 1 for spheres, and counted from the far side for cylinders.
  const VF turn = hn::Mul(atan2(p.y, p.x), splat(0.5f * inverse_pi));
  switch (mapping.kind) {
    case TextureMapping::Kind::spherical: {
      const VF theta = atan2(hn::Sqrt(hn::MulAdd(p.x, p.x, hn::Mul(p.y, p.y))), p.z);
      const VF around = hn::IfThenElse(hn::Lt(turn, zero), hn::Add(turn, splat(1.0f)), turn);
      return {hn::Mul(theta, splat(inverse_pi)), around, zero};
    }
    case TextureMapping::Kind::cylindrical: return {hn::Add(turn, splat(0.5f)), p.z, zero};
    case TextureMapping::Kind::planar:
      return {hn::Add(dot(p, splat_vec3(mapping.u_axis)), u_offset),
              hn::Add(dot(p, splat_vec3(mapping.v_axis)), v_offset), zero};
    default: return p;
  }
}

// 1 in fields of one colour of the board, 0 in the others; in three dimensions of the cubes.
HWY_INLINE VF checkerboard(const Vec3& p) {
  const VF half = hn::Mul(hn::Add(hn::Floor(p.x), hn::Add(hn::Floor(p.y), hn::Floor(p.z))), splat(0.5f));
  return hn::IfThenElseZero(hn::Eq(half, hn::Floor(half)), splat(1.0f));
}

// 1 within dots of radius 0.35, of which a cell around every second or so integer point has one, shifted at random.
HWY_INLINE VF dots(const Vec3& p) {
  const VF half = splat(0.5f);
  const VF s = hn::Floor(hn::Add(p.x, half)), t = hn::Floor(hn::Add(p.y, half));
  const auto noise_at = [&](float x, float y) { return noise(Vec3{hn::Add(s, splat(x)), hn::Add(t, splat(y)), half}); };
  constexpr float radius = 0.35f;
  const VF shift = splat(0.5f - radius);
  const VF from_s = hn::Sub(p.x, hn::MulAdd(shift, noise_at(1.5f, 2.8f), s));
  const VF from_t = hn::Sub(p.y, hn::MulAdd(shift, noise_at(4.5f, 9.8f), t));
  const MF is_near = hn::Lt(hn::MulAdd(from_s, from_s, hn::Mul(from_t, from_t)), splat(radius * radius));
  return hn::IfThenElseZero(hn::And(is_near, hn::Gt(noise_at(0.5f, 0.5f), hn::Zero(FloatTag()))), splat(1.0f));
}

// Waves whose height follows the wind, itself a slower noise.
HWY_INLINE VF windy(const Vec3& p) { return hn::Mul(hn::Abs(fbm(p * splat(0.1f), 0.5f, 3)), fbm(p, 0.5f, 6)); }

// Where in the row of marble's colours the point lies, from 0 to 1.
HWY_INLINE VF marble_phase(const TextureOp& op, const Vec3& p) {
  const Vec3 scaled = p * splat(op.scale);
  const VF angle = hn::MulAdd(splat(op.variation), fbm(scaled, op.roughness, op.octaves), scaled.y);
  return hn::MulAdd(sincos(angle).sin, splat(0.5f), splat(0.5f));
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
