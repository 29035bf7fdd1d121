// The BSDF kernels on lists of cases, for tests: packs cases into full vectors, runs the instruction set chosen last by
// hwy::SetSupportedTargetsForTest, and unpacks. Lanes behind the last case hold NaN.
#pragma once
#include <cstddef>
#include <vector>

#include "systems/bsdf/reference.h"

namespace metamer::testing {

// The arguments of any one BSDF kernel. Only floats, so that a case is a row of columns.
struct BsdfCase {
  float wo[3] = {0, 0, 1}, wi[3] = {0, 0, 1};
  float u = 0, v = 0;
  float alpha_x = 0, alpha_y = 0;
  float albedo[4] = {1, 1, 1, 1};
  float eta[4] = {1, 1, 1, 1}, kappa[4] = {0, 0, 0, 0};
  float schlick = 0, dispersive = 0, opaque = 0;  // 1 where set; opaque: as far as kappa says so
  float ks[4] = {0, 0, 0, 0}, shininess = 0, normalized = 0, choice = 0;  // with albedo as kd
};
struct BsdfResult {
  float wi[3] = {0, 0, 0};
  float value[4] = {0, 0, 0, 0};  // f_cos of an evaluation, weight of a sample
  float pdf = 0;
  float pdfs[4] = {0, 0, 0, 0};  // where each wavelength has its own
  float delta = 0, transmitted = 0, terminate_secondary = 0;
};
using BsdfKernel = std::vector<BsdfResult> (*)(const std::vector<BsdfCase>&);

std::vector<BsdfResult> run_eval_diffuse(const std::vector<BsdfCase>& cases);
std::vector<BsdfResult> run_sample_diffuse(const std::vector<BsdfCase>& cases);
// transmittance is `ks`
std::vector<BsdfResult> run_eval_sheet(const std::vector<BsdfCase>& cases);
std::vector<BsdfResult> run_sample_sheet(const std::vector<BsdfCase>& cases);
std::vector<BsdfResult> run_eval_rough(const std::vector<BsdfCase>& cases);
std::vector<BsdfResult> run_sample_rough(const std::vector<BsdfCase>& cases);
std::vector<BsdfResult> run_eval_conductor(const std::vector<BsdfCase>& cases);
std::vector<BsdfResult> run_sample_conductor(const std::vector<BsdfCase>& cases);
std::vector<BsdfResult> run_sample_dielectric(const std::vector<BsdfCase>& cases);
std::vector<BsdfResult> run_eval_rough_dielectric(const std::vector<BsdfCase>& cases);
std::vector<BsdfResult> run_sample_rough_dielectric(const std::vector<BsdfCase>& cases);
std::vector<BsdfResult> run_sample_thin(const std::vector<BsdfCase>& cases);  // kappa as optical depth, but of opaque
std::vector<BsdfResult> run_eval_phase(
    const std::vector<BsdfCase>& cases);  // alpha_x and alpha_y as g and g2, shininess as g2_share, wi[2] as cosine
std::vector<BsdfResult> run_sample_phase(const std::vector<BsdfCase>& cases);

}  // namespace metamer::testing
