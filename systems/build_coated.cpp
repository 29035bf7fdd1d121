#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "systems/bsdf/coat_albedo.h"
#include "systems/bsdf/limits.h"
#include "systems/build_materials.h"

namespace metamer {
namespace {

// The table's rows are shared by coats that differ in what is under them only.
CoatRows rows_of(const Material& material, const CoatSurface& surface, const CoatedColumns& coats,
                 const SpectrumSet& spectra, Column<float>& table) {
  for (size_t row = 0; row < coats.eta.size(); ++row) {
    const bool same = coats.eta[row] == material.eta && coats.alpha_x[row] == material.alpha_x &&
                      coats.alpha_y[row] == material.alpha_y && (coats.schlick[row] != 0) == surface.schlick &&
                      (coats.hits[row] >= 0) == surface.layered && double{coats.thickness[row]} == surface.thickness;
    if (same)
      return {coats.first_row[row], coats.row_stride[row], coats.last_pair[row], coats.eta_least[row],
              coats.rows_per_eta[row]};
  }
  return add_coat_rows(surface, spectra.min_value(material.eta), spectra.max_value(material.eta), table);
}

}  // namespace

bool check_coated(const Scene& scene, Entity entity, const Material& material, Diagnostics& diagnostics) {
  const size_t errors_before = diagnostics.error_count();
  const auto error = [&](const std::string& what) {
    diagnostics.error(scene.location(entity), fmt::format("{}: {}", scene.describe(entity), what));
  };
  if (!(material.alpha_x >= 0 && std::isfinite(material.alpha_x))) error("'roughness' is not a number of at least 0");
  if (material.kind == MaterialKind::coated && material.alpha_x != material.alpha_y)
    error("a coat's roughness is the same in every direction");
  if (!(scene.spectra.min_value(material.eta) > 0)) error("'eta' is not above 0 at every wavelength");
  // Single precision may round a 1 up.
  if (scene.spectra.has_negative(material.reflectance) || scene.spectra.max_value(material.reflectance) > 1 + 1e-6)
    error("'reflectance' is not from 0 to 1 at every wavelength");
  return diagnostics.error_count() == errors_before;
}

MaterialRow add_coated(const Material& material, World& world) {
  const bool smooth = std::max(material.alpha_x, material.alpha_y) < smooth_alpha;
  const bool layered = material.kind == MaterialKind::layered;
  CoatedColumns& table = smooth ? world.smooth_coated : world.rough_coated;
  Material coat = material;
  if (smooth) coat.alpha_x = coat.alpha_y = 0;
  CoatSurface surface;
  surface.alpha = smooth ? 0 : coat_table_alpha(double{coat.alpha_x}, double{coat.alpha_y});
  surface.schlick = material.fresnel == FresnelModel::schlick;
  surface.layered = layered;
  surface.thickness = layered ? double{material.layer.thickness} : 0;
  const CoatRows rows = rows_of(coat, surface, table, world.spectra, table.albedos);
  table.reflectance.push_back(material.reflectance);
  table.texture.push_back(material.reflectance_texture);
  table.eta.push_back(material.eta);
  table.alpha_x.push_back(coat.alpha_x);
  table.alpha_y.push_back(coat.alpha_y);
  table.thickness.push_back(static_cast<float>(surface.thickness));
  // Half of the scatterings inside are at the base, the first of them is.
  table.hits.push_back(layered ? static_cast<float>((material.layer.max_depth + 1) / 2) : -1.0f);
  table.schlick.push_back(surface.schlick);
  table.first_row.push_back(rows.first);
  table.row_stride.push_back(rows.stride);
  table.last_pair.push_back(rows.last_pair);
  table.eta_least.push_back(rows.eta_least);
  table.rows_per_eta.push_back(rows.rows_per_eta);
  if (coat.alpha_x != coat.alpha_y) world.needs_tangents = true;
  return {smooth ? ShadeKind::smooth_coated : ShadeKind::rough_coated, static_cast<uint32_t>(table.eta.size() - 1)};
}

}  // namespace metamer
