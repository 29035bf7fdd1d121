#include <fmt/format.h>

#include <cmath>

#include "systems/bsdf/coat_albedo.h"
#include "systems/bsdf/limits.h"
#include "systems/build_materials.h"

namespace metamer {
namespace {

// The table's rows are shared by coats that differ in what is under them only.
CoatRows rows_of(const Material& material, float alpha, bool schlick, CoatedColumns& table,
                 const SpectrumSet& spectra) {
  for (size_t row = 0; row < table.eta.size(); ++row) {
    const bool same =
        table.eta[row] == material.eta && table.alpha[row] == alpha && (table.schlick[row] != 0) == schlick;
    if (same)
      return {table.first_row[row], table.row_stride[row], table.last_pair[row], table.eta_least[row],
              table.rows_per_eta[row]};
  }
  return add_coat_rows(double{alpha}, schlick, spectra.min_value(material.eta), spectra.max_value(material.eta),
                       table.albedos);
}

}  // namespace

bool check_coated(const Scene& scene, Entity entity, const Material& material, Diagnostics& diagnostics) {
  const size_t errors_before = diagnostics.error_count();
  const auto error = [&](const std::string& what) {
    diagnostics.error(scene.location(entity), fmt::format("{}: {}", scene.describe(entity), what));
  };
  if (!(material.alpha_x >= 0 && std::isfinite(material.alpha_x))) error("'roughness' is not a number of at least 0");
  if (material.alpha_x != material.alpha_y) error("a coat's roughness is the same in every direction");
  if (!(scene.spectra.min_value(material.eta) > 0)) error("'eta' is not above 0 at every wavelength");
  // Single precision may round a 1 up.
  if (scene.spectra.has_negative(material.reflectance) || scene.spectra.max_value(material.reflectance) > 1 + 1e-6)
    error("'reflectance' is not from 0 to 1 at every wavelength");
  return diagnostics.error_count() == errors_before;
}

MaterialRow add_coated(const Material& material, World& world) {
  const bool smooth = material.alpha_x < smooth_alpha;
  CoatedColumns& table = smooth ? world.smooth_coated : world.rough_coated;
  const float alpha = smooth ? 0 : material.alpha_x;
  const bool schlick = material.fresnel == FresnelModel::schlick;
  const CoatRows rows = rows_of(material, alpha, schlick, table, world.spectra);
  table.reflectance.push_back(material.reflectance);
  table.texture.push_back(material.reflectance_texture);
  table.eta.push_back(material.eta);
  table.alpha.push_back(alpha);
  table.schlick.push_back(schlick);
  table.first_row.push_back(rows.first);
  table.row_stride.push_back(rows.stride);
  table.last_pair.push_back(rows.last_pair);
  table.eta_least.push_back(rows.eta_least);
  table.rows_per_eta.push_back(rows.rows_per_eta);
  return {smooth ? ShadeKind::smooth_coated : ShadeKind::rough_coated, static_cast<uint32_t>(table.eta.size() - 1)};
}

}  // namespace metamer
