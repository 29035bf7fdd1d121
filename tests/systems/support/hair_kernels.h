// The hair BSDF's kernels on lists of cases, as bsdf_kernels.h: `choice`, `u`, `v`, and `kappa` as absorption count.
#pragma once
#include "systems/bsdf/reference_hair.h"
#include "tests/systems/support/bsdf_kernels.h"

namespace metamer::testing {

struct HairCase {
  BsdfCase c;
  double h = 0;
};
// All cases of a list are of hair of the same shape and index.
std::vector<BsdfResult> run_eval_hair(const reference::HairOptics& hair, const std::vector<HairCase>& cases);
std::vector<BsdfResult> run_sample_hair(const reference::HairOptics& hair, const std::vector<HairCase>& cases);

}  // namespace metamer::testing
