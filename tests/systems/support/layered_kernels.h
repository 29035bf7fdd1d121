// The layered BSDF's kernels, many estimates of one setting, for tests; instruction sets as bsdf_kernels.h.
#pragma once
#include <vector>

#include "tests/systems/support/bsdf_kernels.h"
#include "tests/systems/support/layered_walk.h"

namespace metamer::testing {

// Estimates of f_cos in value[0] with one walk each, of other seeds each; pdf; delta is not set.
std::vector<BsdfResult> run_eval_layered(const LayeredWalk& setting, const reference::Direction& wo,
                                         const reference::Direction& wi, size_t count);
// Draws: delta is set where the pdf is 0 and the weight is not.
std::vector<BsdfResult> run_sample_layered(const LayeredWalk& setting, const reference::Direction& wo, size_t count);

}  // namespace metamer::testing
