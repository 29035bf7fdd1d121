// Tone mapping: developed colour through exposure and a tone curve to the 8-bit codes of a display. Never changes what
// the film recorded.
#pragma once
#include <cstddef>

#include "engine/film/picture.h"
#include "systems/tone_curve.h"

namespace metamer {

struct ToneSettings {
  float exposure_stops = 0;  // colour times 2^stops; [-100, 100], beyond is clamped, not-a-number is 0
  bool dither = true;        // of the codes
  ToneCurve curve = ToneCurve::linear;
  float reinhard_white = default_reinhard_white;  // L_white of reinhard_extended; above 0
  ColorSpace display = ColorSpace::srgb;          // whose linear colour the picture holds, see display_to_xyz
  bool encoded = false;                           // the picture holds codes over 255 already: no curve, no encoding
  uint32_t threads = 0;                           // 0: all; changes nothing in the result
};

// Exposure, tone curve and the display's encoding, which is the sRGB curve on every display. What is outside the
// display's gamut is clipped to [0, 1]; of lamps, negative amounts are first taken away as into_gamut does, before the
// tone curve. Not-a-number becomes 0. With dither a value between two codes takes the upper one at that
// fraction of the pixels, where depends on the pixel's position alone and is one for R, G and B, so that grey stays
// grey; codes met exactly, 0 and 255 among them, stay. Without dither the nearest code. Equal codes on every
// instruction set.
CodedPicture tone_map(const Picture& picture, const ToneSettings& settings);

// Exposure and tone curve alone, linear light still: what an EXR takes. Equal bits on every instruction set. Where
// there is nothing to do the picture stays as it is, not-a-number too.
void expose(Picture& picture, const ToneSettings& settings);

// For columns of `count` values (padded): the encoded value, [0, 1], see srgb_encode in tone_map-inl.h.
void srgb_encode(size_t count, const float* linear, float* encoded);

// The scalar definition: IEC 61966-2-1:1999, clipped to [0, 1].
double srgb_encode_scalar(double linear);

}  // namespace metamer
