// Tone curves: from linear light on the scale of the scene to what a display can show, [0, 1], still linear.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "engine/spectrum/color.h"

namespace metamer {

// x is the exposed colour, 1 the display's white. All but `linear` and the two of Reinhard work on each component,
// negative ones counting as 0.
enum class ToneCurve : uint8_t {
  // x.
  linear,
  // x / (1 + L), L the luminance: E. Reinhard et al., "Photographic Tone Reproduction for Digital Images", SIGGRAPH
  // 2002, equation 3. Colours keep their chromaticity.
  reinhard,
  // x (1 + L / L_white^2) / (1 + L): the same, equation 4. L_white becomes white; 4, two stops above it, if not given.
  reinhard_extended,
  // f(2 x) / f(11.2), f(x) = (x (A x + C B) + D E) / (x (A x + B) + D F) - E / F with A = 0.15, B = 0.5, C = 0.1,
  // D = 0.2, E = 0.02, F = 0.3: J. Hable, "Filmic Tonemapping Operators", filmicworlds.com, 2010 (Uncharted 2).
  hable,
  // h^2.2, h = y (6.2 y + 0.5) / (y (6.2 y + 1.7) + 0.06), y = max(0, x - 0.004): J. Hejl and R. Burgess-Dawson, in
  // H.-P. Duiker, "Filmic Tonemapping for Real-time Rendering", SIGGRAPH 2010 course. h is a code of a display of
  // gamma 2.2, which the power makes linear.
  filmic,
  // T. Sobotka's AgX (2022) in the form of B. Wrensch, "Minimal AgX Implementation", iolite-engine.com, 2023: a matrix
  // on linear sRGB, log2 from -12.47393 to 4.026069 as [0, 1], a polynomial of degree 6, another matrix, the power 2.2.
  agx,
};
inline constexpr size_t tone_curve_count = 6;

// "linear", "reinhard", "reinhard-extended", "hable", "filmic", "agx".
std::span<const std::string_view> tone_curve_names();
std::string_view tone_curve_name(ToneCurve curve);

inline constexpr float default_reinhard_white = 4.0f;

// The exposed colour is clipped to this magnitude, so that no curve overflows.
inline constexpr float brightest_exposed = 0x1p60f;

// The scalar definition. rgb: finite, linear in the display's primaries. AgX, which is defined on sRGB, goes there and
// back through the display's matrices.
Color3 tone_curve_scalar(ToneCurve curve, ColorSpace display, const Color3& rgb,
                         double reinhard_white = double{default_reinhard_white});

// What the SIMD form needs, for one display. Matrices row-major. The fraction of Hable's curve is
// y (square a y + linear) / (y (a y + b) + df) with y = bias x.
struct ToneConstants {
  float luminance[3];
  float reinhard_inverse_white_squared;
  float hable_bias, hable_a, hable_b, hable_df, hable_square, hable_linear;
  float agx_least, agx_most, agx_scale;
  float agx_polynomial[7];
  float to_srgb[9], agx_inset[9], agx_outset[9], from_srgb[9];
};
ToneConstants tone_constants(ColorSpace display, float reinhard_white);

}  // namespace metamer
