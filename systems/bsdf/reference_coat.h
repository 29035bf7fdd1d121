// The coated diffuse BSDF in scalar double precision; conventions of reference.h, formulas in coated-inl.h.
#pragma once
#include "systems/bsdf/coat_albedo.h"
#include "systems/bsdf/reference.h"

namespace metamer::reference {

// alpha 0: smooth. The table's rows are read in double precision; `rows` are those of alpha, schlick and the etas.
struct CoatOptics {
  Spectrum4 albedo{}, eta{};
  double alpha = 0;
  bool schlick = false;
  const float* table = nullptr;
  CoatRows rows;
  double alpha_y = alpha;
  double thickness = 0, hits = -1;  // of a layer (coat_layer.h); hits of its base, negative: without end
};

// The share of light at cos_theta that the coat's surface reflects at once, and its average over the hemisphere.
double coat_surface_albedo(const CoatOptics& optics, double eta, double cos_theta);
double coat_surface_average(const CoatOptics& optics, double eta);
// The share that reaches the body.
double coat_entry(const CoatOptics& optics, double eta, double cos_theta);

// The body's part alone where the surface is smooth; both parts where it is rough.
BsdfValue eval_coated(const Direction& wo, const CoatOptics& optics, const Direction& wi);
// `choice` takes the lobe. A smooth surface's mirror direction is a delta lobe.
BsdfSample sample_coated(const Direction& wo, const CoatOptics& optics, double choice, double u, double v);

}  // namespace metamer::reference
