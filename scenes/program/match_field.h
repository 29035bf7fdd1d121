// The field of the colour-matching experiment as a picture.
#pragma once
#include "engine/film/picture.h"
#include "engine/spectrum/color.h"

namespace metamer {

// 480 x 400 pixels of linear sRGB. A disc of two halves, the light with the lamps added to it on the left, the other
// lamps on the right: they look the same, as their amounts match. Below, bars as high as the amounts: on the left the
// light itself and the lamps added to it, on the right the others. Every colour is as bright as sRGB can show it; what
// it does not have is clipped.
Picture match_field(const Color3& amounts);

}  // namespace metamer
