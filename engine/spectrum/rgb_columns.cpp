#include "engine/spectrum/rgb_columns.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/spectrum/rgb_columns.cpp"
#include <hwy/foreach_target.h>

#include "engine/simd/vec3-inl.h"
#include "engine/spectrum/rgb_fit.h"
#include "engine/spectrum/rgb_start_table.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

constexpr int largest_iterations = 16;
constexpr float relative_tolerance = 2e-4f;
constexpr float absolute_tolerance = 1e-5f;

HWY_INLINE VF clamped_to_unit(VF x) {
  return hn::Min(hn::Max(hn::IfThenZeroElse(hn::IsNaN(x), x), splat(0.0f)), splat(1.0f));
}

struct Hsl {
  VF hue, saturation, lightness;
};

HWY_INLINE Hsl hsl_of_rgb(const Vec3& rgb, VF high, VF low) {
  const VF one = splat(1.0f);
  const VF chroma = hn::Sub(high, low);
  const VF safe_chroma = hn::Max(chroma, splat(1e-30f));
  const VF lightness = hn::Mul(splat(0.5f), hn::Add(high, low));
  const VF reach = hn::Sub(one, hn::Abs(hn::MulAdd(splat(2.0f), lightness, splat(-1.0f))));
  const VF saturation = hn::Min(one, hn::Div(chroma, hn::Max(reach, safe_chroma)));
  const VF from_red = hn::Div(hn::Sub(rgb.y, rgb.z), safe_chroma);
  const VF from_green = hn::Add(splat(2.0f), hn::Div(hn::Sub(rgb.z, rgb.x), safe_chroma));
  const VF from_blue = hn::Add(splat(4.0f), hn::Div(hn::Sub(rgb.x, rgb.y), safe_chroma));
  const VF red_hue = hn::IfThenElse(hn::Lt(from_red, splat(0.0f)), hn::Add(from_red, splat(6.0f)), from_red);
  const VF hue =
      hn::IfThenElse(hn::Eq(high, rgb.x), red_hue, hn::IfThenElse(hn::Eq(high, rgb.y), from_green, from_blue));
  return {hue, saturation, lightness};
}

// Grid cell and fraction of a position in 0..cells.
struct Cell {
  VI index;
  VF fraction;
};
HWY_INLINE Cell cell_of(VF position, size_t cells) {
  const VI index = hn::Min(hn::ConvertTo(IntTag(), position), hn::Set(IntTag(), static_cast<int32_t>(cells) - 1));
  return {index, hn::Sub(position, hn::ConvertTo(FloatTag(), index))};
}

HWY_INLINE VF lerp(VF a, VF b, VF fraction) { return hn::MulAdd(fraction, hn::Sub(b, a), a); }

// Trilinear lookup in the start table, scaled back to coefficients.
HWY_INLINE Vec3 start_coefficients(const float* HWY_RESTRICT table, const Hsl& hsl, VF inverse_scale) {
  const FloatTag d;
  const IntTag di;
  const Cell hue = cell_of(hn::Mul(hsl.hue, splat(start_hues / 6.0f)), start_hues);
  const Cell saturation = cell_of(hn::Mul(hsl.saturation, splat(start_saturations - 1.0f)), start_saturations - 1);
  const Cell lightness = cell_of(hn::Mul(hsl.lightness, splat(start_lightnesses - 1.0f)), start_lightnesses - 1);
  const VI next_hue = hn::Add(hue.index, hn::Set(di, 1));
  const VI wrapped = hn::IfThenZeroElse(hn::Eq(next_hue, hn::Set(di, static_cast<int32_t>(start_hues))), next_hue);
  constexpr auto saturation_step = static_cast<int32_t>(3 * start_lightnesses);
  constexpr auto hue_step = static_cast<int32_t>(start_saturations) * saturation_step;
  const VI within =
      hn::Add(hn::Mul(saturation.index, hn::Set(di, saturation_step)), hn::Mul(lightness.index, hn::Set(di, 3)));
  VF c[3];
  for (int k = 0; k < 3; ++k) {
    const auto along_lightness = [&](VI hue_index, int32_t offset) HWY_ATTR {
      const VI index = hn::Add(hn::Add(hn::Mul(hue_index, hn::Set(di, hue_step)), within), hn::Set(di, offset + k));
      return lerp(hn::GatherIndex(d, table, index), hn::GatherIndex(d, table + 3, index), lightness.fraction);
    };
    const VF below =
        lerp(along_lightness(hue.index, 0), along_lightness(hue.index, saturation_step), saturation.fraction);
    const VF above = lerp(along_lightness(wrapped, 0), along_lightness(wrapped, saturation_step), saturation.fraction);
    c[k] = hn::Mul(lerp(below, above, hue.fraction), inverse_scale);
  }
  return {c[0], c[1], c[2]};
}

// What a reflectance lacks to the colour, and d rgb / d c, column by column.
struct Residual {
  Vec3 missing;
  Vec3 by_c0, by_c1, by_c2;
};
HWY_INLINE Residual residual_of(const RgbStartTable& table, const Vec3& rgb, const Vec3& c) {
  const VF zero = splat(0.0f);
  const VF half = splat(0.5f);
  Residual r = {rgb, {zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}};
  for (size_t i = 0; i < table.nodes.size(); i += 4) {
    const VF t = splat(table.nodes[i]);
    const VF x = hn::MulAdd(hn::MulAdd(c.x, t, c.y), t, c.z);
    const VF inverse_root = hn::Div(splat(1.0f), hn::Sqrt(hn::MulAdd(x, x, splat(1.0f))));
    const VF value = hn::MulAdd(hn::Mul(half, x), inverse_root, half);
    const VF slope = hn::Mul(hn::Mul(half, inverse_root), hn::Mul(inverse_root, inverse_root));
    const VF slope_t = hn::Mul(slope, t);
    const VF slope_t2 = hn::Mul(slope_t, t);
    const Vec3 weight = {splat(table.nodes[i + 1]), splat(table.nodes[i + 2]), splat(table.nodes[i + 3])};
    r.missing = mul_add(weight, hn::Neg(value), r.missing);
    r.by_c0 = mul_add(weight, slope_t2, r.by_c0);
    r.by_c1 = mul_add(weight, slope_t, r.by_c1);
    r.by_c2 = mul_add(weight, slope, r.by_c2);
  }
  return r;
}

HWY_INLINE VF largest_magnitude(const Vec3& v) { return hn::Max(hn::Abs(v.x), hn::Max(hn::Abs(v.y), hn::Abs(v.z))); }

// Newton's step by Cramer's rule; not finite where the system is singular.
HWY_INLINE Vec3 newton_step(const Residual& r) {
  const Vec3 normal = cross(r.by_c1, r.by_c2);
  const VF inverse = hn::Div(splat(1.0f), dot(r.by_c0, normal));
  return {hn::Mul(dot(r.missing, normal), inverse), hn::Mul(dot(r.missing, cross(r.by_c2, r.by_c0)), inverse),
          hn::Mul(dot(r.missing, cross(r.by_c0, r.by_c1)), inverse)};
}

// Newton's method with steps shortened until they help. A lane stops by its own error alone.
HWY_INLINE Vec3 refined(const RgbStartTable& table, const Vec3& rgb, Vec3 c, VF tolerance) {
  const VF limit = splat(static_cast<float>(largest_sigmoid_coefficient));
  Residual r = residual_of(table, rgb, c);
  VF error = largest_magnitude(r.missing);
  Vec3 step = newton_step(r);
  VF length = splat(1.0f);
  for (int iteration = 0; iteration < largest_iterations; ++iteration) {
    const MF unfinished = hn::Gt(error, tolerance);
    if (hn::AllFalse(FloatTag(), unfinished)) break;
    const Vec3 trial = mul_add(step, length, c);
    r = residual_of(table, rgb, trial);
    const VF trial_error = largest_magnitude(r.missing);
    const MF better = hn::And(hn::And(unfinished, hn::Lt(trial_error, error)),
                              hn::Lt(largest_magnitude(trial), limit));  // false for NaN
    c = if_then_else(better, trial, c);
    error = hn::IfThenElse(better, trial_error, error);
    step = if_then_else(better, newton_step(r), step);
    length = hn::IfThenElse(better, splat(1.0f), hn::Mul(length, splat(0.4f)));
  }
  return c;
}

// Greys in closed form: S(c2) = grey.
HWY_INLINE VF grey_coefficient(VF grey) {
  const VF one = splat(1.0f);
  const VF spread = hn::Sqrt(hn::Mul(grey, hn::Sub(one, grey)));
  const VF saturated = splat(static_cast<float>(sigmoid_saturated));
  const VF inside = hn::Div(hn::Sub(grey, splat(0.5f)), hn::Max(spread, splat(1e-18f)));
  return hn::IfThenElse(hn::Le(grey, splat(0.0f)), hn::Neg(saturated),
                        hn::IfThenElse(hn::Ge(grey, one), saturated, inside));
}

void rgb_to_sigmoid_columns(const RgbStartTable& table, const RgbColumns& rgb, const SigmoidColumns& out,
                            size_t count) {
  const FloatTag d;
  const VF zero = splat(0.0f);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const Vec3 color = {clamped_to_unit(hn::LoadU(d, rgb.red + i)), clamped_to_unit(hn::LoadU(d, rgb.green + i)),
                        clamped_to_unit(hn::LoadU(d, rgb.blue + i))};
    const VF high = hn::Max(color.x, hn::Max(color.y, color.z));
    const VF low = hn::Min(color.x, hn::Min(color.y, color.z));
    const VF to_white = hn::Sub(splat(1.0f), low);
    const MF grey = hn::Eq(high, low);
    const VF scale = hn::Sqrt(hn::Max(hn::Mul(high, to_white), splat(1e-20f)));
    const VF tolerance = hn::IfThenElse(
        grey, splat(2.0f), hn::MulAdd(splat(relative_tolerance), hn::Min(high, to_white), splat(absolute_tolerance)));
    const Vec3 start =
        start_coefficients(table.scaled_c.data(), hsl_of_rgb(color, high, low), hn::Div(splat(1.0f), scale));
    const Vec3 c = refined(table, color, start, tolerance);
    hn::StoreU(hn::IfThenElse(grey, zero, c.x), d, out.c0 + i);
    hn::StoreU(hn::IfThenElse(grey, zero, c.y), d, out.c1 + i);
    hn::StoreU(hn::IfThenElse(grey, grey_coefficient(high), c.z), d, out.c2 + i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(rgb_to_sigmoid_columns);

void rgb_to_sigmoid(ColorSpace space, const RgbColumns& rgb, const SigmoidColumns& out, size_t count) {
  HWY_DYNAMIC_DISPATCH(rgb_to_sigmoid_columns)(rgb_start_table(space), rgb, out, count);
}
}  // namespace metamer
#endif
