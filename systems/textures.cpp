#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/textures.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include <utility>

#include "engine/sampling/points-inl.h"
#include "engine/spectrum/spectrum-inl.h"
#include "systems/dimensions.h"
#include "systems/lanes-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// What a texture may ask about a lane.
struct TexturePoint {
  VF u, v;
  VF lambda_nm[4];
  PointKey key;
  uint32_t depth;
};

// A texel's row or column, and whether there is one.
struct TexelIndex {
  VI index;
  MF inside;
};
HWY_INLINE TexelIndex wrapped(VF position, uint32_t size, TextureWrap wrap) {
  const VF extent = splat(static_cast<float>(size)), zero = hn::Zero(FloatTag());
  const VI last = hn::Set(IntTag(), static_cast<int32_t>(size) - 1);
  const MF inside = hn::And(hn::Le(zero, position), hn::Lt(position, extent));
  if (wrap == TextureWrap::repeat) position = hn::NegMulAdd(hn::Floor(hn::Div(position, extent)), extent, position);
  const VI index = hn::ConvertTo(IntTag(), hn::Min(hn::Max(position, zero), extent));
  const MF there = wrap == TextureWrap::black ? inside : hn::Eq(zero, zero);
  return {hn::Min(index, last), there};
}

// One texel of the four around the point, chosen in proportion to its share of the linear interpolation: right on
// average, on each wavelength, at a fourth of the price.
HWY_INLINE void image_value(const TextureSet& set, const TextureOp& op, const TexturePoint& point, uint32_t nth,
                            VF out[4]) {
  const TextureImage& image = set.images[op.image];
  const VF u = hn::MulAdd(point.u, splat(op.mapping.u_scale), splat(op.mapping.u_offset));
  const VF v = hn::MulAdd(point.v, splat(op.mapping.v_scale), splat(op.mapping.v_offset));
  VF x = hn::Mul(u, splat(static_cast<float>(image.width)));
  VF y = hn::Mul(hn::Sub(splat(1.0f), v), splat(static_cast<float>(image.height)));
  if (op.nearest == 0) {
    VF jitter_x, jitter_y;
    sample_2d(point.key, splat_u(texture_image_dimension(point.depth, nth)), &jitter_x, &jitter_y);
    x = hn::Add(x, hn::Sub(jitter_x, splat(0.5f)));
    y = hn::Add(y, hn::Sub(jitter_y, splat(0.5f)));
  }
  const TexelIndex column = wrapped(hn::Floor(x), image.width, op.wrap);
  const TexelIndex row = wrapped(hn::Floor(y), image.height, op.wrap);
  const VI texel = hn::Add(hn::Mul(row.index, hn::Set(IntTag(), static_cast<int32_t>(image.width))), column.index);
  const VI at = hn::ShiftLeft<2>(hn::Add(texel, hn::Set(IntTag(), static_cast<int32_t>(image.first_texel))));
  const float* texels = set.texels.data();
  if (set.has_coefficients) {
    for (int j = 0; j < 4; ++j) out[j] = gather(texels, hn::Add(at, channel_of(point.lambda_nm[j])));
  } else {
    const VF c0 = gather(texels, at), c1 = gather(texels + 1, at), c2 = gather(texels + 2, at);
    const VF scale = gather(texels + 3, at);
    for (int j = 0; j < 4; ++j) out[j] = hn::Mul(scale, sigmoid_polynomial(c0, c1, c2, point.lambda_nm[j]));
  }
  const VF factor = hn::IfThenElseZero(hn::And(column.inside, row.inside), splat(op.number));
  for (int j = 0; j < 4; ++j) {
    const VF value = hn::Mul(factor, out[j]);
    out[j] = op.invert != 0 ? hn::Max(hn::Sub(splat(1.0f), value), hn::Zero(FloatTag())) : value;
  }
}

HWY_INLINE void checkerboard(const TextureOp& op, const TexturePoint& point, const VF a[4], const VF b[4], VF out[4]) {
  const VF u = hn::Floor(hn::MulAdd(point.u, splat(op.mapping.u_scale), splat(op.mapping.u_offset)));
  const VF v = hn::Floor(hn::MulAdd(point.v, splat(op.mapping.v_scale), splat(op.mapping.v_offset)));
  const VF half = hn::Mul(hn::Add(u, v), splat(0.5f));
  const MF even = hn::Eq(half, hn::Floor(half));
  for (int j = 0; j < 4; ++j) out[j] = hn::IfThenElse(even, a[j], b[j]);
}

// The program's value at the point: operands are taken from the top of a stack, which holds four wavelengths a row.
HWY_INLINE void run_program(const World& world, const TextureProgram& program, const TexturePoint& point, VF out[4]) {
  const TextureSet& set = world.textures;
  VF stack[deepest_texture_stack][4];
  uint32_t top = 0;  // rows in use
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
        checkerboard(op, point, stack[top - 1], stack[top], stack[top - 1]);
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
  run(reflectances, shade.reflectance);
  collect(shade, ShadeKind::diffuse_transmission, world.diffuse_transmission.transmittance_texture, transmittances);
  run(transmittances, shade.transmittance);
}

}  // namespace metamer
#endif
