// What the kernels of tone_map.cpp share, declared once for all instruction sets.
#pragma once
#include "systems/tone_curve.h"

namespace metamer {

struct ToneJob {
  float scale[3];  // 2^stops, in units of the display's white
  float unit[3];   // back from them
  bool dither;
  bool encoded;
  bool desaturate;  // what is outside the gamut, for codes
  ToneCurve curve;
  ToneConstants constants;
};

}  // namespace metamer
