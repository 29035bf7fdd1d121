// Texture programs on lanes of points: spectra, numbers, and numbers with their slopes.
#if defined(METAMER_SYSTEMS_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_TEXTURE_INL_H_
#undef METAMER_SYSTEMS_TEXTURE_INL_H_
#else
#define METAMER_SYSTEMS_TEXTURE_INL_H_
#endif

#include <algorithm>

#include "engine/spectrum/spectrum-inl.h"
#include "systems/dimensions.h"
#include "systems/lanes-inl.h"
#include "systems/systems.h"
#include "systems/texture_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// What a program is run for, and what a row of its stack holds: a spectrum at the path's four wavelengths; a number; a
// number and its derivatives by the surface's u and v.
enum class TextureResult { spectrum, number, slopes };
constexpr int row_size(TextureResult result) {
  return result == TextureResult::spectrum ? 4 : result == TextureResult::number ? 1 : 3;
}

HWY_INLINE TexturePoint point_of(const ShadeStream& shade, VI lane) {
  TexturePoint point;
  point.u = gather(shade.uv[0], lane);
  point.v = gather(shade.uv[1], lane);
  point.position = gather(shade.position, lane);
  point.normal = gather(shade.normal, lane);
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

// A texel's column and row, and whether there is one.
struct TexelIndex {
  VI column, row;
  MF inside;
};
HWY_INLINE VI within(VF position, uint32_t size) {
  const VF bounded = hn::Min(hn::Max(position, hn::Zero(FloatTag())), splat(static_cast<float>(size)));
  return hn::Min(hn::ConvertTo(IntTag(), bounded), hn::Set(IntTag(), static_cast<int32_t>(size) - 1));
}
HWY_INLINE TexelIndex wrapped(VF x, VF y, const TextureImage& image, TextureWrap wrap) {
  const VF width = splat(static_cast<float>(image.width)), height = splat(static_cast<float>(image.height));
  const VF zero = hn::Zero(FloatTag());
  const auto is_out = [&](VF position, VF size) { return hn::Or(hn::Lt(position, zero), hn::Le(size, position)); };
  const auto repeated = [](VF position, VF size) {
    return hn::NegMulAdd(hn::Floor(hn::Div(position, size)), size, position);
  };
  const MF out_x = is_out(x, width), out_y = is_out(y, height);
  MF inside = hn::Eq(zero, zero);
  switch (wrap) {
    case TextureWrap::repeat:
      x = repeated(x, width);
      y = repeated(y, height);
      break;
    case TextureWrap::octahedral: {
      // Over an edge: to its other half, the texels next to it touching each other.
      const VF last = hn::Sub(width, splat(1.0f)), last_row = hn::Sub(height, splat(1.0f));
      const auto turned = [&](VF position, VF end) {
        return hn::IfThenElse(hn::Lt(position, zero), hn::Sub(splat(-1.0f), position),
                              hn::Sub(hn::MulAdd(end, splat(2.0f), splat(1.0f)), position));
      };
      const VF folded_x = hn::IfThenElse(out_x, turned(x, last), x),
               folded_y = hn::IfThenElse(out_y, turned(y, last_row), y);
      x = hn::IfThenElse(out_y, hn::Sub(last, folded_x), folded_x);
      y = hn::IfThenElse(out_x, hn::Sub(last_row, folded_y), folded_y);
      break;
    }
    case TextureWrap::black: inside = hn::Not(hn::Or(out_x, out_y)); break;
    case TextureWrap::clamp: break;
  }
  return {within(x, image.width), within(y, image.height), inside};
}

HWY_INLINE void look_up(const TextureSet& set, const TextureImage& image, const TexelIndex& texel,
                        const TexturePoint& point, VF out[4]) {
  const VI nth = hn::Add(hn::Mul(texel.row, hn::Set(IntTag(), static_cast<int32_t>(image.width))), texel.column);
  const VI at = hn::ShiftLeft<2>(hn::Add(nth, hn::Set(IntTag(), static_cast<int32_t>(image.first_texel))));
  const float* texels = set.texels.data();
  if (set.has_coefficients) {
    for (int j = 0; j < 4; ++j) out[j] = gather(texels, hn::Add(at, channel_of(point.lambda_nm[j])));
  } else {
    const VF c0 = gather(texels, at), c1 = gather(texels + 1, at), c2 = gather(texels + 2, at);
    const VF scale = gather(texels + 3, at);
    for (int j = 0; j < 4; ++j) out[j] = hn::Mul(scale, sigmoid_polynomial(c0, c1, c2, point.lambda_nm[j]));
  }
}

// One texel of the four around the point, chosen in proportion to its share of the linear interpolation: right on
// average, on each wavelength, at a fourth of the price.
HWY_INLINE void image_spectrum(const TextureSet& set, const TextureOp& op, const TexturePoint& point, uint32_t nth,
                               VF out[4]) {
  const TextureImage& image = set.images[op.image];
  const Vec3 at = map_point(op.mapping, point);
  VF x = hn::Mul(at.x, splat(static_cast<float>(image.width)));
  VF y = hn::Mul(hn::Sub(splat(1.0f), at.y), splat(static_cast<float>(image.height)));
  if (op.nearest == 0) {
    VF jitter_x, jitter_y;
    sample_2d(point.key, splat_u(texture_image_dimension(point.depth, nth)), &jitter_x, &jitter_y);
    x = hn::Add(x, hn::Sub(jitter_x, splat(0.5f)));
    y = hn::Add(y, hn::Sub(jitter_y, splat(0.5f)));
  }
  const TexelIndex texel = wrapped(hn::Floor(x), hn::Floor(y), image, op.wrap);
  look_up(set, image, texel, point, out);
  const VF factor = hn::IfThenElseZero(texel.inside, splat(op.scale));
  for (int j = 0; j < 4; ++j) {
    const VF value = hn::Mul(factor, out[j]);
    out[j] = op.invert != 0 ? hn::Max(hn::Sub(splat(1.0f), value), hn::Zero(FloatTag())) : value;
  }
}

// The four texels around a place in pixels, and the shares of the right and the lower ones.
struct TexelSquare {
  VI index[4];  // upper left, upper right, lower left, lower right; the upper left one of the image is 0
  MF inside[4];
  VF right, lower;
};
HWY_INLINE TexelSquare texel_square(const TextureImage& image, const Vec3& at, TextureWrap wrap) {
  const VF half = splat(0.5f);
  const VF x = hn::MulSub(at.x, splat(static_cast<float>(image.width)), half);
  const VF y = hn::MulSub(hn::Sub(splat(1.0f), at.y), splat(static_cast<float>(image.height)), half);
  const VF left = hn::Floor(x), top = hn::Floor(y);
  TexelSquare square;
  for (int k = 0; k < 4; ++k) {
    const VF step_x = splat(static_cast<float>(k & 1)), step_y = splat(static_cast<float>(k >> 1));
    const TexelIndex texel = wrapped(hn::Add(left, step_x), hn::Add(top, step_y), image, wrap);
    square.index[k] = hn::Add(hn::Mul(texel.row, hn::Set(IntTag(), static_cast<int32_t>(image.width))), texel.column);
    square.inside[k] = texel.inside;
  }
  square.right = hn::Sub(x, left);
  square.lower = hn::Sub(y, top);
  return square;
}

HWY_INLINE VF between(VF a, VF b, VF share) { return hn::MulAdd(share, hn::Sub(b, a), a); }

// Linear between texels; `slopes`, unless it is null, becomes the derivatives of this function by u and v of the image.
HWY_INLINE VF image_number(const TextureSet& set, const TextureOp& op, const TexturePoint& point, VF* slopes) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const TextureImage& image = set.images[op.image];
  TexelSquare square = texel_square(image, map_point(op.mapping, point), op.wrap);
  if (op.nearest != 0) {
    square.right = hn::IfThenElseZero(hn::Ge(square.right, splat(0.5f)), one);
    square.lower = hn::IfThenElseZero(hn::Ge(square.lower, splat(0.5f)), one);
  }
  VF texel[4];
  const float* numbers = set.numbers.data() + image.first_texel;
  for (int k = 0; k < 4; ++k) texel[k] = hn::IfThenElseZero(square.inside[k], gather(numbers, square.index[k]));
  const VF upper = between(texel[0], texel[1], square.right), lower = between(texel[2], texel[3], square.right);
  const VF value = hn::Mul(splat(op.scale), between(upper, lower, square.lower));
  if (slopes != nullptr) {
    const VF along_x = between(hn::Sub(texel[1], texel[0]), hn::Sub(texel[3], texel[2]), square.lower);
    const MF flat = op.nearest != 0 ? hn::Eq(zero, zero) : hn::Ge(value, splat(op.invert != 0 ? 1.0f : FLT_MAX));
    const VF scale = splat(op.invert != 0 ? -op.scale : op.scale);
    slopes[0] = hn::IfThenZeroElse(flat, hn::Mul(hn::Mul(scale, splat(static_cast<float>(image.width))), along_x));
    slopes[1] = hn::IfThenZeroElse(
        flat, hn::Mul(hn::Mul(scale, splat(static_cast<float>(image.height))), hn::Sub(upper, lower)));
  }
  return op.invert != 0 ? hn::Max(hn::Sub(one, value), zero) : value;
}

// The row of marble's colours is an image of one row.
HWY_INLINE void marble(const TextureSet& set, const TextureOp& op, const TexturePoint& point, VF out[4]) {
  const TextureImage& row = set.images[op.image];
  const VF x = hn::Mul(marble_phase(op, map_point(op.mapping, point)), splat(static_cast<float>(row.width)));
  look_up(set, row, {within(x, row.width), hn::Zero(IntTag()), hn::Eq(x, x)}, point, out);
}

// Images and patterns that are plain numbers.
HWY_INLINE VF pattern(const TextureSet& set, const TextureOp& op, const TexturePoint& point) {
  if (op.kind == TextureKind::image) return image_number(set, op, point, nullptr);
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
HWY_INLINE void set_pattern(const TextureSet& set, const TextureOp& op, const TexturePoint* points,
                            VF out[row_size(result)]) {
  if constexpr (result != TextureResult::slopes) {
    set_number<result>(pattern(set, op, points[0]), out);
  } else if (op.kind == TextureKind::image && op.mapping.kind == TextureMapping::Kind::uv) {
    out[0] = image_number(set, op, points[0], out + 1);
    out[1] = hn::Mul(out[1], splat(op.mapping.u_scale));
    out[2] = hn::Mul(out[2], splat(op.mapping.v_scale));
  } else {
    out[0] = pattern(set, op, points[0]);
    for (int k = 1; k < 3; ++k) out[k] = hn::Mul(hn::Sub(pattern(set, op, points[k]), out[0]), splat(1 / slope_step));
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
          if constexpr (is_spectrum) image_spectrum(set, op, *points, i - program.begin, stack[top++]);
          break;
        }
        [[fallthrough]];
      case TextureKind::coordinate:
      case TextureKind::facing:
      case TextureKind::dots:
      case TextureKind::fbm:
      case TextureKind::wrinkled:
      case TextureKind::windy: set_pattern<result>(set, op, points, stack[top++]); break;
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
