// How different two colours look: CIEDE2000, in double precision. CIELAB itself: lab.h.
#pragma once
#include "engine/spectrum/color.h"

namespace metamer {

// X Y Z of L*, a*, b* under `white`: the inverse of lab_of_xyz.
Color3 xyz_of_lab(const Color3& lab, const Color3& white);

// CIEDE2000 with k_L = k_C = k_H = 1; 1 is about what can just be seen side by side. G. Sharma, W. Wu, E. N. Dalal,
// "The CIEDE2000 Color-Difference Formula: Implementation Notes, Supplementary Test Data, and Mathematical
// Observations", Color Research and Application 30(1), 2005, equations 2 to 22. Symmetric; 0 for equal colours.
double delta_e_2000(const Color3& lab, const Color3& other);

}  // namespace metamer
