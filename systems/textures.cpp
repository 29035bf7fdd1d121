#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/textures.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include <utility>

#include "engine/spectrum/spectrum-inl.h"
#include "systems/dimensions.h"
#include "systems/lanes-inl.h"
#include "systems/systems.h"
#include "systems/texture_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

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
HWY_INLINE void image_value(const TextureSet& set, const TextureOp& op, const TexturePoint& point, uint32_t nth,
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
  const VF factor = hn::IfThenElseZero(texel.inside, splat(op.number));
  for (int j = 0; j < 4; ++j) {
    const VF value = hn::Mul(factor, out[j]);
    out[j] = op.invert != 0 ? hn::Max(hn::Sub(splat(1.0f), value), hn::Zero(FloatTag())) : value;
  }
}

// The row of marble's colours is an image of one row.
HWY_INLINE void marble(const TextureSet& set, const TextureOp& op, const TexturePoint& point, VF out[4]) {
  const TextureImage& row = set.images[op.image];
  const VF x = hn::Mul(marble_phase(op, map_point(op.mapping, point)), splat(static_cast<float>(row.width)));
  look_up(set, row, {within(x, row.width), hn::Zero(IntTag()), hn::Eq(x, x)}, point, out);
}

// The patterns that are plain numbers.
HWY_INLINE VF pattern(const TextureOp& op, const TexturePoint& point) {
  if (op.code == TextureOpcode::facing) return hn::Abs(dot(point.normal, splat_vec3(op.axis_direction)));
  const Vec3 p = map_point(op.mapping, point);
  switch (op.code) {
    case TextureOpcode::coordinate: return op.axis == 0 ? p.x : op.axis == 1 ? p.y : p.z;
    case TextureOpcode::dots: return dots(p);
    case TextureOpcode::fbm: return fbm(p, op.roughness, op.octaves);
    case TextureOpcode::wrinkled: return turbulence(p, op.roughness, op.octaves);
    default: return windy(p);
  }
}

// The program's value at the point: operands are taken from the top of a stack, which holds four wavelengths a row.
HWY_INLINE void run_program(const World& world, const TextureProgram& program, const TexturePoint& point, VF out[4]) {
  const TextureSet& set = world.textures;
  VF stack[deepest_texture_stack][4];
  uint32_t top = 0;  // rows in use
  MF is_a;
  for (uint32_t i = program.begin; i < program.end; ++i) {
    const TextureOp& op = set.ops[i];
    switch (op.code) {
      case TextureOpcode::spectrum:
        eval_spectrum4(world.spectra.view(), splat_u(op.spectrum), point.lambda_nm, stack[top++]);
        break;
      case TextureOpcode::number:
        for (VF& value : stack[top]) value = splat(op.number);
        ++top;
        break;
      case TextureOpcode::image: image_value(set, op, point, i - program.begin, stack[top++]); break;
      case TextureOpcode::multiply:
        --top;
        for (int j = 0; j < 4; ++j) stack[top - 1][j] = hn::Mul(stack[top - 1][j], stack[top][j]);
        break;
      case TextureOpcode::mix:
        top -= 2;
        for (int j = 0; j < 4; ++j)
          stack[top - 1][j] =
              hn::MulAdd(stack[top + 1][j], hn::Sub(stack[top][j], stack[top - 1][j]), stack[top - 1][j]);
        break;
      case TextureOpcode::checkerboard:
        --top;
        is_a = hn::Gt(checkerboard(map_point(op.mapping, point)), hn::Zero(FloatTag()));
        for (int j = 0; j < 4; ++j) stack[top - 1][j] = hn::IfThenElse(is_a, stack[top - 1][j], stack[top][j]);
        break;
      case TextureOpcode::marble: marble(set, op, point, stack[top++]); break;
      case TextureOpcode::coordinate:
      case TextureOpcode::facing:
      case TextureOpcode::dots:
      case TextureOpcode::fbm:
      case TextureOpcode::wrinkled:
      case TextureOpcode::windy:
        stack[top][0] = pattern(op, point);
        for (int j = 1; j < 4; ++j) stack[top][j] = stack[top][0];
        ++top;
        break;
    }
  }
  for (int j = 0; j < 4; ++j) out[j] = stack[0][j];
}

// Lanes lanes[begin, end), all of one program. The last vector is filled up with its last lane, whose value is written
// more than once, the same each time.
void run_lanes(const World& world, uint32_t depth, uint32_t program, const uint32_t* lanes, uint32_t begin,
               uint32_t end, ShadeStream& shade, const Columns<float, 4>& out) {
  const uint32_t step = static_cast<uint32_t>(lane_count());
  HWY_ALIGN uint32_t rows[hn::MaxLanes(UintTag())];
  for (uint32_t i = begin; i < end; i += step) {
    for (uint32_t k = 0; k < step; ++k) rows[k] = lanes[std::min(i + k, end - 1)];
    const VI lane = as_index(hn::Load(UintTag(), rows));
    TexturePoint point;
    point.u = gather(shade.uv[0], lane);
    point.v = gather(shade.uv[1], lane);
    point.position = gather(shade.position, lane);
    point.normal = gather(shade.normal, lane);
    for (size_t j = 0; j < 4; ++j) point.lambda_nm[j] = gather(shade.lambda_nm[j], lane);
    point.key = {gather(shade.pixel_seed, lane), gather(shade.index, lane)};
    point.depth = depth;
    VF value[4];
    run_program(world, world.textures.programs[program], point, value);
    for (size_t j = 0; j < 4; ++j) {
      const VF bounded = hn::Min(hn::Max(value[j], hn::Zero(FloatTag())), splat(1.0f));
      hn::ScatterIndex(bounded, FloatTag(), out[j], lane);
    }
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
namespace {

// Lanes with a texture, and their programs.
struct TexturedLanes {
  uint32_t count = 0;
  uint32_t lane[sorted_capacity], program[sorted_capacity];
};

void collect(const ShadeStream& shade, ShadeKind kind, const Column<uint32_t>& texture_of_material,
             TexturedLanes& lanes) {
  const Group& group = shade.groups[static_cast<size_t>(kind)];
  for (uint32_t i = group.begin; i < group.end; ++i) {
    const uint32_t program = texture_of_material[shade.material[i]];
    if (program == no_index) continue;
    lanes.lane[lanes.count] = i;
    lanes.program[lanes.count++] = program;
  }
}

// Counting sorts by the bytes of the program's number, the lowest first; as many as the largest number has.
void sort_by_program(size_t programs, TexturedLanes& lanes, TexturedLanes& spare) {
  for (uint32_t shift = 0; shift < 32 && (programs - 1) >> shift != 0; shift += 8) {
    uint32_t at[257] = {};
    for (uint32_t i = 0; i < lanes.count; ++i) ++at[(lanes.program[i] >> shift & 255) + 1];
    for (uint32_t k = 0; k < 256; ++k) at[k + 1] += at[k];
    for (uint32_t i = 0; i < lanes.count; ++i) {
      const uint32_t to = at[lanes.program[i] >> shift & 255]++;
      spare.lane[to] = lanes.lane[i];
      spare.program[to] = lanes.program[i];
    }
    std::copy_n(spare.lane, lanes.count, lanes.lane);
    std::copy_n(spare.program, lanes.count, lanes.program);
  }
}

}  // namespace

HWY_EXPORT(run_lanes);

void textures(const World& world, uint32_t depth, ShadeStream& shade) {
  if (!world.has_textures()) return;
  const auto run = [&](TexturedLanes& lanes, const Columns<float, 4>& out) {
    TexturedLanes spare;
    sort_by_program(world.textures.programs.size(), lanes, spare);
    for (uint32_t begin = 0; begin < lanes.count;) {
      uint32_t end = begin + 1;
      while (end < lanes.count && lanes.program[end] == lanes.program[begin]) ++end;
      HWY_DYNAMIC_DISPATCH(run_lanes)(world, depth, lanes.program[begin], lanes.lane, begin, end, shade, out);
      begin = end;
    }
  };
  TexturedLanes reflectances, transmittances;
  collect(shade, ShadeKind::diffuse, world.diffuse.texture, reflectances);
  collect(shade, ShadeKind::diffuse_transmission, world.diffuse_transmission.reflectance_texture, reflectances);
  collect(shade, ShadeKind::smooth_coated, world.smooth_coated.texture, reflectances);
  collect(shade, ShadeKind::rough_coated, world.rough_coated.texture, reflectances);
  collect(shade, ShadeKind::layered, world.layered.texture, reflectances);
  run(reflectances, shade.reflectance);
  collect(shade, ShadeKind::diffuse_transmission, world.diffuse_transmission.transmittance_texture, transmittances);
  run(transmittances, shade.transmittance);
}

}  // namespace metamer
#endif
