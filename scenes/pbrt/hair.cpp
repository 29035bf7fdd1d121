// pbrt's hair: what it absorbs comes as a spectrum, as the colour it is to have, or as the pigments that are in it.
#include "systems/bsdf/hair.h"

#include <algorithm>

#include "scenes/pbrt/materials.h"

namespace metamer::pbrt {
namespace {

// Absorption per radius of a unit of each pigment (d'Eon et al., "An Energy-Conserving Hair Reflectance Model", EGSR
// 2011, as pbrt has it), linear sRGB.
constexpr Color3 eumelanin_sigma_a{0.419, 0.697, 1.37}, pheomelanin_sigma_a{0.187, 0.4, 1.05};

SpectrumId of_pigments(SpectrumSet& spectra, double eumelanin, double pheomelanin) {
  Color3 rgb;
  for (size_t c = 0; c < 3; ++c) rgb[c] = eumelanin * eumelanin_sigma_a[c] + pheomelanin * pheomelanin_sigma_a[c];
  return spectra.add_rgb(rgb, RgbKind::unbounded).id;
}

SpectrumId of_reflectance(SpectrumSet& spectra, SpectrumId reflectance, double beta_n) {
  Samples samples = spectra.samples(reflectance);
  for (double& sample : samples) sample = hair_absorption_of_reflectance(sample, beta_n);
  return spectra.add_samples(samples).id;
}

SpectrumId read_absorption(Reader& reader, Parameters& parameters, double beta_n, TextureId& color_texture) {
  SpectrumSet& spectra = reader.scene.spectra;
  const auto texture = [&](std::string_view name) {
    if (!parameters.is_texture(name)) return false;
    const TextureId read = read_texture_parameter(reader, parameters, name, false).value_or(no_index);
    if (color_texture == no_index) color_texture = read;
    return true;
  };
  const bool has_textures[] = {texture("reflectance"), texture("color")};
  const auto sigma_a = read_spectrum(reader, parameters, "sigma_a", RgbKind::unbounded, SpectrumAlso::texture);
  const auto color_of = [&](std::string_view name, bool is_texture) {
    return is_texture ? std::nullopt : read_spectrum(reader, parameters, name, RgbKind::albedo, SpectrumAlso::texture);
  };
  const auto reflectance = color_of("reflectance", has_textures[0]), color = color_of("color", has_textures[1]);
  const bool has_pigments = parameters.has("eumelanin") || parameters.has("pheomelanin");
  const double eumelanin = std::max(0.0, read_real_or_texture(reader, parameters, "eumelanin", has_pigments ? 0 : 1.3));
  const double pheomelanin = std::max(0.0, read_real_or_texture(reader, parameters, "pheomelanin", 0));
  const int ways =
      (sigma_a ? 1 : 0) + (reflectance || color || color_texture != no_index ? 1 : 0) + (has_pigments ? 1 : 0);
  if (ways > 1)
    reader.messages.warning(parameters.source(),
                            "material \"hair\": of 'sigma_a', 'reflectance' or 'color', and pigments the first counts");
  if (sigma_a || reflectance) color_texture = no_index;
  if (sigma_a) return sigma_a->id;
  if (color_texture != no_index) return zero_spectrum;
  if (reflectance) return of_reflectance(spectra, reflectance->id, beta_n);
  if (color) return of_reflectance(spectra, color->id, beta_n);
  return of_pigments(spectra, eumelanin, pheomelanin);
}

}  // namespace

void read_hair(Reader& reader, Parameters& parameters, Material& material) {
  material.kind = MaterialKind::hair;
  const auto unit = [&](std::string_view name, double fallback) {
    const double value = read_real_or_texture(reader, parameters, name, fallback);
    if (!(value >= 0 && value <= 1)) parameters.error(name, std::string(name) + " must be from 0 to 1");
    return static_cast<float>(std::clamp(value, 0.0, 1.0));
  };
  Hair& hair = material.hair;
  hair.beta_m = unit("beta_m", 0.3);
  hair.beta_n = unit("beta_n", 0.3);
  hair.tilt_deg = static_cast<float>(read_real_or_texture(reader, parameters, "alpha", 2));
  hair.sigma_a = read_absorption(reader, parameters, double{hair.beta_n}, material.reflectance_texture);
  material.eta = reader.scene.spectra.add_constant(read_real_or_texture(reader, parameters, "eta", 1.55)).id;
}

}  // namespace metamer::pbrt
