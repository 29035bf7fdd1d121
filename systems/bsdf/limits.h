// Thresholds that the kernels, their scalar twins and the systems around them share.
#pragma once

namespace metamer {

// Below this extinction coefficient a medium still refracts and absorbs inside (DESIGN.md, section 1).
inline constexpr float refracting_kappa = 1e-2f;

// A microfacet distribution whose larger alpha is below this is treated as perfectly smooth, a delta lobe; pbrt-v4's
// threshold (TrowbridgeReitzDistribution::EffectivelySmooth), so that its scenes look the same here.
inline constexpr float smooth_alpha = 1e-3f;

// A rough distribution's smaller alpha is raised to this, as pbrt-v4 does: (0, 0.1) stays finite.
inline constexpr float least_alpha = 1e-4f;

// A rough boundary whose relative index is nearer to 1 than this is not there.
inline constexpr float matched_index = 1e-4f;

// Beyond this shininess the half vector's rounding would show in a rough material's lobe; it is 0.1 degrees wide.
inline constexpr float largest_shininess = 1e6f;

}  // namespace metamer
