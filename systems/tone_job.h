// What the kernels of tone_map.cpp share, declared once for all instruction sets.
#pragma once
#include "systems/tone_curve.h"

namespace metamer {

struct ToneJob {
  float scale;  // 2^stops
  bool dither;
  ToneCurve curve;
  ToneConstants constants;
};

}  // namespace metamer
