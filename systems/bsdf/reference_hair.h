// Hair in scalar double precision; conventions of reference.h, formulas and frame of hair-inl.h.
#pragma once
#include "systems/bsdf/hair.h"
#include "systems/bsdf/reference.h"

namespace metamer::reference {

struct HairOptics {
  double h = 0, eta = 1.55;
  Spectrum4 sigma_a{};
  HairShape shape;
};
BsdfValue eval_hair(const Direction& wo, const HairOptics& optics, const Direction& wi);
BsdfSample sample_hair(const Direction& wo, const HairOptics& optics, double choice, double u, double v);

}  // namespace metamer::reference
