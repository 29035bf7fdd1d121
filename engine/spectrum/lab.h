// CIELAB: colours by how they look, relative to a white.
#pragma once
#include "engine/spectrum/color.h"

namespace metamer {

// L*, a*, b* of X Y Z under the white X Y Z, all of them in one unit (CIE 15:2018, 8.2.1). white > 0.
Color3 lab_of_xyz(const Color3& xyz, const Color3& white);

// Distance in L*, a*, b* (CIE 1976): about 2.3 is just noticeable.
double delta_e_1976(const Color3& lab, const Color3& other);

}  // namespace metamer
