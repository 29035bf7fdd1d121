// pbrt-v4's layered BSDF as the random walks that define it (Pharr, Jakob, Humphreys, Physically Based Rendering, 4th
// edition, section 14.3), one wavelength, in scalar double precision: what the closed form and the kernels are compared
// with. Shares nothing with them but the GGX functions of reference.h.
#pragma once
#include <random>

#include "systems/bsdf/reference.h"

namespace metamer::testing {

struct LayeredWalk {
  double eta = 1.5;              // of the layer
  reference::Roughness surface;  // of its surface
  bool conductor = false;        // the base, else diffuse
  double reflectance = 0.5;      // of a diffuse base
  double n = 1, kappa = 0;       // of a conductor, against the layer's surroundings
  reference::Roughness base;     // of a conductor
  double thickness = 0.01, albedo = 0, asymmetry = 0;
  int max_depth = 10;

  std::mt19937_64 random{1};

  // A direction that light leaves in which was followed from wo, and its weight: the integral of f_cos over any set of
  // directions is the mean weight of the samples in it. No sample has weight 0. wo.z > 0.
  struct Sample {
    reference::Direction wi;
    double weight = 0;
    bool mirrored = false;  // by the surface, at once
  };
  Sample sample(const reference::Direction& wo);

  // An estimate of f (not f_cos) without what the surface reflects at once; 0 for what is a delta lobe.
  double inner_f(const reference::Direction& wo, const reference::Direction& wi);

 private:
  struct Step {
    reference::Direction w;  // where to, away from the boundary
    double weight = 0;       // f_cos / pdf
    double pdf = 0;          // 0: a delta lobe
  };
  double uniform() { return std::uniform_real_distribution<double>()(random); }
  // Through the surface, from either side, as a share of power: what changes in radiance is left to the caller.
  Step transmit(const reference::Direction& w);
  Step reflect_inside(const reference::Direction& w);  // w.z < 0
  Step scatter_at_base(const reference::Direction& w);
  double transmission_f(const reference::Direction& from, const reference::Direction& to, double* pdf) const;
  double base_f(const reference::Direction& w, const reference::Direction& to, double* pdf) const;
  double phase(double cos_theta) const;
  reference::Direction sample_phase(const reference::Direction& w);
  double transmittance(double distance, const reference::Direction& w) const;
  reference::Direction visible_normal(const reference::Roughness& roughness, const reference::Direction& w);
  bool is_smooth_surface() const { return reference::is_smooth(surface); }
};

}  // namespace metamer::testing
