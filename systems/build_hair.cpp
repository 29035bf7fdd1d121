#include <fmt/format.h>

#include "systems/bsdf/hair.h"
#include "systems/build_materials.h"

namespace metamer {

bool check_hair(const Scene& scene, Entity entity, const Material& material, Diagnostics& diagnostics) {
  const size_t errors_before = diagnostics.error_count();
  const auto error = [&](const std::string& what) {
    diagnostics.error(scene.location(entity), fmt::format("{}: {}", scene.describe(entity), what));
  };
  const Hair& hair = material.hair;
  if (!(scene.spectra.min_value(material.eta) >= 1)) error("'eta' of hair is not at least 1 at every wavelength");
  if (scene.spectra.has_negative(hair.sigma_a)) error("'sigma_a' is negative at some wavelength");
  if (!(hair.beta_m >= 0 && hair.beta_m <= 1)) error("'beta_m' is not a number from 0 to 1");
  if (!(hair.beta_n >= 0 && hair.beta_n <= 1)) error("'beta_n' is not a number from 0 to 1");
  if (!(hair.tilt_deg >= -20 && hair.tilt_deg <= 20)) error("'tilt' is not a number from -20 to 20 degrees");
  return diagnostics.error_count() == errors_before;
}

MaterialRow add_hair(const Material& material, World& world) {
  HairColumns& table = world.hair;
  const Hair& hair = material.hair;
  const HairShape shape = hair_shape(double{hair.beta_m}, double{hair.beta_n}, double{hair.tilt_deg});
  table.eta.push_back(static_cast<float>(world.spectra.value(material.eta, 550)));
  table.sigma_a.push_back(hair.sigma_a);
  table.texture.push_back(material.reflectance_texture);
  table.absorption_of_log.push_back(static_cast<float>(hair_absorption_of_log(double{hair.beta_n})));
  table.variance.push_back(static_cast<float>(shape.variance));
  table.width.push_back(static_cast<float>(shape.width));
  for (size_t k = 0; k < 3; ++k) {
    table.sin_tilt[k].push_back(static_cast<float>(shape.sin_tilt[k]));
    table.cos_tilt[k].push_back(static_cast<float>(shape.cos_tilt[k]));
  }
  world.needs_tangents = world.has_hair = true;
  return {ShadeKind::hair, static_cast<uint32_t>(table.eta.size() - 1)};
}

}  // namespace metamer
