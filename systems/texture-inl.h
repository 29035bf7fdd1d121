// Texture programs on lanes of points: spectra, numbers, and numbers with their slopes.
#if defined(METAMER_SYSTEMS_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_TEXTURE_INL_H_
#undef METAMER_SYSTEMS_TEXTURE_INL_H_
#else
#define METAMER_SYSTEMS_TEXTURE_INL_H_
#endif

#include <algorithm>

#include "engine/spectrum/spectrum-inl.h"
#include "systems/lanes-inl.h"
#include "systems/systems.h"
#include "systems/texture_images-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// What a program is run for, and what a row of its stack holds: a spectrum at the path's four wavelengths; a number; a
// number and its derivatives by the surface's u and v.
enum class TextureResult { spectrum, number, slopes };
constexpr int row_size(TextureResult result) {
  return result == TextureResult::spectrum ? 4 : result == TextureResult::number ? 1 : 3;
}

HWY_INLINE TexturePoint point_of(const World& world, const ShadeStream& shade, VI lane) {
  TexturePoint point;
  point.u = gather(shade.uv[0], lane);
  point.v = gather(shade.uv[1], lane);
  point.position = gather(shade.position, lane);
  point.normal = gather(shade.normal, lane);
  if (world.has_mips)
    for (size_t k = 0; k < 4; ++k) point.footprint[k] = gather(shade.footprint[k], lane);
  return point;
}

// Calls run(lanes) for vectors of `count` lanes. The last one is filled up with the last lane, whose results are
// written more than once, the same each time.
template <class Run>
HWY_INLINE void for_each_vector(const uint32_t* lanes, uint32_t count, const Run& run) {
  const auto step = static_cast<uint32_t>(lane_count());
  HWY_ALIGN uint32_t some[hn::MaxLanes(UintTag())];
  for (uint32_t i = 0; i < count; i += step) {
    for (uint32_t k = 0; k < step; ++k) some[k] = lanes[std::min(i + k, count - 1)];
    run(as_index(hn::Load(UintTag(), some)));
  }
}

// The row of marble's colours is an image of one row.
HWY_INLINE void marble(const TextureSet& set, const TextureOp& op, const TexturePoint& point, VF out[4]) {
  const ImageLevel row = level_of(set.images[op.image], {}, op.image);
  const VF x = hn::Mul(marble_phase(op, map_point(op.mapping, point)), row.width);
  look_up(set, row, {within(x, row.width), hn::Zero(IntTag()), hn::Eq(x, x)}, point, out);
}

// Images and patterns that are plain numbers.
HWY_INLINE VF pattern(const World& world, const TextureOp& op, const TexturePoint& point) {
  if (op.kind == TextureKind::image) return image_number(world, op, point, nullptr);
  if (op.kind == TextureKind::facing) return hn::Abs(dot(point.normal, splat_vec3(op.axis_direction)));
  const Vec3 p = map_point(op.mapping, point);
  switch (op.kind) {
    case TextureKind::coordinate: return op.axis == 0 ? p.x : op.axis == 1 ? p.y : p.z;
    case TextureKind::dots: return dots(p);
    case TextureKind::fbm: return fbm(p, op.roughness, op.octaves);
    case TextureKind::wrinkled: return turbulence(p, op.roughness, op.octaves);
    default: return windy(p);
  }
}

template <TextureResult result>
HWY_INLINE void set_number(VF number, VF out[row_size(result)]) {
  for (int j = 0; j < row_size(result); ++j)
    out[j] = j == 0 || result == TextureResult::spectrum ? number : splat(0.0f);
}

// a = a b
template <TextureResult result>
HWY_INLINE void multiply(VF a[row_size(result)], const VF b[row_size(result)]) {
  if constexpr (result == TextureResult::slopes)
    for (int k = 1; k < 3; ++k) a[k] = hn::MulAdd(a[k], b[0], hn::Mul(a[0], b[k]));
  for (int j = 0; j < (result == TextureResult::slopes ? 1 : row_size(result)); ++j) a[j] = hn::Mul(a[j], b[j]);
}

// a = (1 - amount) a + amount b
template <TextureResult result>
HWY_INLINE void mix(VF a[row_size(result)], const VF b[row_size(result)], const VF amount[row_size(result)]) {
  if constexpr (result == TextureResult::slopes) {
    for (int k = 1; k < 3; ++k) a[k] = hn::MulAdd(amount[k], hn::Sub(b[0], a[0]), between(a[k], b[k], amount[0]));
    a[0] = between(a[0], b[0], amount[0]);
  } else {
    for (int j = 0; j < row_size(result); ++j) a[j] = between(a[j], b[j], amount[j]);
  }
}

template <TextureResult result>
HWY_INLINE void square_root(VF a[row_size(result)]) {
  const VF root = hn::Sqrt(hn::Max(a[0], hn::Zero(FloatTag())));
  if constexpr (result == TextureResult::slopes) {
    const VF slope = hn::Div(splat(0.5f), hn::Max(root, splat(1e-6f)));
    for (int k = 1; k < 3; ++k) a[k] = hn::Mul(a[k], slope);
  }
  a[0] = root;
  if constexpr (result == TextureResult::spectrum) a[1] = a[2] = a[3] = root;
}

// Where slopes are taken: the point, and it moved along u and along v; else the point alone.
constexpr float slope_step = 0.0005f;  // of u and v; pbrt-v4's where it knows no better
HWY_INLINE void move_points(const Vec3& dp_du, const Vec3& dp_dv, TexturePoint (&points)[3]) {
  const VF step = splat(slope_step);
  points[1] = points[2] = points[0];
  points[1].u = hn::Add(points[0].u, step);
  points[1].position = mul_add(dp_du, step, points[0].position);
  points[2].v = hn::Add(points[0].v, step);
  points[2].position = mul_add(dp_dv, step, points[0].position);
}

// Slopes are exact for images that follow the surface's coordinates.
template <TextureResult result>
HWY_INLINE void set_pattern(const World& world, const TextureOp& op, const TexturePoint* points,
                            VF out[row_size(result)]) {
  if constexpr (result != TextureResult::slopes) {
    set_number<result>(pattern(world, op, points[0]), out);
  } else if (op.kind == TextureKind::image && op.mapping.kind == TextureMapping::Kind::uv) {
    out[0] = image_number(world, op, points[0], out + 1);
    out[1] = hn::Mul(out[1], splat(op.mapping.u_scale));
    out[2] = hn::Mul(out[2], splat(op.mapping.v_scale));
  } else {
    out[0] = pattern(world, op, points[0]);
    for (int k = 1; k < 3; ++k) out[k] = hn::Mul(hn::Sub(pattern(world, op, points[k]), out[0]), splat(1 / slope_step));
  }
}

// The program's value at the point, of `slopes` at the first of three: operands are taken from the top of a stack. A
// program for spectra may hold numbers, one for numbers no spectra.
template <TextureResult result>
HWY_INLINE void run_program(const World& world, const TextureProgram& program, const TexturePoint* points,
                            VF out[row_size(result)]) {
  constexpr bool is_spectrum = result == TextureResult::spectrum;
  const TextureSet& set = world.textures;
  VF stack[deepest_texture_stack][row_size(result)];
  uint32_t top = 0;  // rows in use
  MF is_a;
  for (uint32_t i = program.begin; i < program.end; ++i) {
    const TextureOp& op = set.ops[i];
    const bool is_number = op.is_number != 0;
    switch (op.kind) {
      case TextureKind::constant:
        if (is_number) set_number<result>(splat(op.value), stack[top++]);
        if constexpr (is_spectrum)
          if (!is_number) eval_spectrum4(world.spectra.view(), splat_u(op.spectrum), points->lambda_nm, stack[top++]);
        break;
      case TextureKind::marble:
        if constexpr (is_spectrum) marble(set, op, *points, stack[top++]);
        break;
      case TextureKind::image:
        if (!is_number) {
          if constexpr (is_spectrum) image_spectrum(world, op, *points, i - program.begin, stack[top++]);
          break;
        }
        [[fallthrough]];
      case TextureKind::coordinate:
      case TextureKind::facing:
      case TextureKind::dots:
      case TextureKind::fbm:
      case TextureKind::wrinkled:
      case TextureKind::windy: set_pattern<result>(world, op, points, stack[top++]); break;
      case TextureKind::scale:
        --top;
        multiply<result>(stack[top - 1], stack[top]);
        break;
      case TextureKind::mix:
        top -= 2;
        mix<result>(stack[top - 1], stack[top], stack[top + 1]);
        break;
      case TextureKind::checkerboard:  // its steps have no slope
        --top;
        is_a = hn::Gt(checkerboard(map_point(op.mapping, *points)), hn::Zero(FloatTag()));
        for (int j = 0; j < row_size(result); ++j)
          stack[top - 1][j] = hn::IfThenElse(is_a, stack[top - 1][j], stack[top][j]);
        break;
      case TextureKind::square_root: square_root<result>(stack[top - 1]); break;
    }
  }
  for (int j = 0; j < row_size(result); ++j) out[j] = stack[0][j];
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
