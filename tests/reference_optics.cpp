#include "tests/reference_optics.h"

#include <cmath>
#include <numbers>

#include "systems/bsdf/limits.h"
#include "tests/reference_lights.h"

namespace metamer {

ReferenceFrame reference_frame(const ReferenceHit& hit, const Vector& came) {
  ReferenceFrame frame;
  frame.came = came;
  frame.z = hit.shading;
  Vector along = hit.tangent - frame.z * glm::dot(frame.z, hit.tangent);
  if (!(glm::length(along) > 1e-12))
    along = glm::cross(std::abs(frame.z.x) > 0.5 ? Vector(0, 1, 0) : Vector(1, 0, 0), frame.z);
  frame.x = glm::normalize(along);
  frame.y = glm::cross(frame.z, frame.x);
  return frame;
}

reference::Spectrum4 reference_relative(const World& world, uint32_t index, uint32_t around,
                                        const reference::Spectrum4& lambda_nm) {
  Spectrum4 result = reference_spectrum(world, index, lambda_nm);
  for (size_t j = 0; j < 4; ++j) result[j] /= world.spectra.value(world.media.eta[around], lambda_nm[j]);
  return result;
}

reference::ThinOptics reference_thin(const World& world, uint32_t row, uint32_t around,
                                     const reference::Spectrum4& lambda_nm) {
  const DielectricColumns& table = world.dielectric;
  const uint32_t outside = table.is_absolute[row] != 0 ? around : 0;
  reference::ThinOptics optics;
  optics.eta = reference_relative(world, table.eta[row], outside, lambda_nm);
  optics.kappa = reference_relative(world, table.kappa[row], outside, lambda_nm);
  optics.schlick = table.schlick[row] != 0;
  for (size_t j = 0; j < 4; ++j) {
    const double kappa = world.spectra.value(table.kappa[row], lambda_nm[j]);
    optics.opaque[j] = kappa >= double{refracting_kappa};
    optics.optical_depth[j] = 4e9 * std::numbers::pi * kappa / lambda_nm[j] * double{table.thickness[row]};
  }
  return optics;
}

reference::CoatOptics reference_coat(const World& world, ShadeKind kind, uint32_t row,
                                     const reference::Spectrum4& lambda_nm) {
  const CoatedColumns& table = kind == ShadeKind::smooth_coated ? world.smooth_coated : world.rough_coated;
  return {reference_spectrum(world, table.reflectance[row], lambda_nm),
          reference_spectrum(world, table.eta[row], lambda_nm),
          double{table.alpha_x[row]},
          table.schlick[row] != 0,
          table.albedos.data(),
          {table.first_row[row], table.row_stride[row], table.last_pair[row], table.eta_least[row],
           table.rows_per_eta[row]},
          double{table.alpha_y[row]},
          double{table.thickness[row]},
          double{table.hits[row]}};
}

}  // namespace metamer
