// The coated BSDF's kernels on lists of cases, as bsdf_kernels.h: `albedo`, `eta`, `choice`, `schlick` of a case count.
// All cases of a list share one table and roughness.
#pragma once
#include <cmath>

#include "systems/bsdf/reference_coat.h"
#include "tests/systems/support/bsdf_kernels.h"

namespace metamer::testing {

// The rows for etas in [eta_least, eta_most].
struct Coat {
  Coat(double alpha_, double eta_least, double eta_most, bool schlick_ = false)
      : alpha(alpha_),
        alpha_y(alpha_),
        schlick(schlick_),
        rows(add_coat_rows({alpha, schlick, false, 0}, eta_least, eta_most, table)) {}
  // pbrt's, with a layer.
  struct Layered {
    double thickness;
    int hits;
  };
  Coat(double alpha_x, double alpha_y_, double eta_least, double eta_most, const Layered& layer)
      : alpha(alpha_x),
        alpha_y(alpha_y_),
        schlick(false),
        thickness(layer.thickness),
        hits(layer.hits),
        rows(add_coat_rows({alpha_x > 0 ? coat_table_alpha(alpha_x, alpha_y_) : 0, false, true, thickness}, eta_least,
                           eta_most, table)) {}
  double alpha, alpha_y;
  bool schlick;
  double thickness = 0, hits = -1;
  Column<float> table;
  CoatRows rows;

  reference::CoatOptics optics(const BsdfCase& c) const {
    return {{c.albedo[0], c.albedo[1], c.albedo[2], c.albedo[3]},
            {c.eta[0], c.eta[1], c.eta[2], c.eta[3]},
            alpha,
            schlick,
            table.data(),
            rows,
            alpha_y,
            thickness,
            hits};
  }
};

// delta is set in draws from a smooth coat's mirror image; their pdf is a probability.
std::vector<BsdfResult> run_eval_coated(const Coat& coat, const std::vector<BsdfCase>& cases);
std::vector<BsdfResult> run_sample_coated(const Coat& coat, const std::vector<BsdfCase>& cases);

}  // namespace metamer::testing
