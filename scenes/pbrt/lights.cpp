// Light sources. The scale of every light is pbrt-v4's: see read_pbrt.h.
#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "scenes/pbrt/matrix.h"
#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {
namespace {

constexpr std::string_view light_kinds[] = {"point", "distant", "infinite", "spot", "goniometric", "projection"};

struct LightSpectrum {
  SpectrumId id = zero_spectrum;
  double scale = 1;  // `scale`, divided by the spectrum's luminance
};

double white_luminance(Reader& reader, ColorSpace space) {
  SpectrumSet& spectra = reader.scene.spectra;
  return spectra.luminance(spectra.add_white(space));
}

// A light's spectrum parameter, by default the white of the current colour space.
LightSpectrum read_light_spectrum(Reader& reader, Parameters& parameters, std::string_view name) {
  SpectrumSet& spectra = reader.scene.spectra;
  const auto value = read_spectrum(reader, parameters, name, RgbKind::illuminant, SpectrumAlso::nothing);
  const ColorSpace space = value && value->rgb ? *value->rgb : reader.state.color_space;
  LightSpectrum light{value ? value->id : spectra.add_white(space), parameters.number_from("scale", 1, 0)};
  // rgb values count against the white alone: their own luminance is part of what they say.
  const double luminance = value && !value->rgb ? spectra.luminance(value->id) : white_luminance(reader, space);
  if (luminance > 0) {
    light.scale /= luminance;
  } else {
    parameters.error(name, fmt::format("'{}' has no luminance, by which pbrt divides it", name));
  }
  return light;
}

// What a target figure (power, illuminance) multiplies the scale by; 1 if it is not given. pbrt ignores targets <= 0.
double target_factor(Parameters& parameters, std::string_view name, double per_unit_scale) {
  const double target = parameters.number(name, -1);
  return target > 0 ? target / per_unit_scale : 1;
}

void add_light(Reader& reader, Parameters& parameters, const Light& light, const glm::dmat4& transform) {
  Registry& registry = reader.scene.registry;
  const Entity entity = registry.create();
  registry.set(entity, to_component(transform));
  registry.set(entity, light);
  registry.set(entity, parameters.source());
}

void read_point(Reader& reader, Parameters& parameters) {
  const LightSpectrum spectrum = read_light_spectrum(reader, parameters, "I");
  const double scale = spectrum.scale * target_factor(parameters, "power", 4 * std::numbers::pi);
  const glm::dvec3 from = parameters.point3("from", glm::dvec3(0));
  add_light(reader, parameters, {LightKind::point, spectrum.id, static_cast<float>(scale), 0, no_index},
            reader.state.transform * translation(from));
}

void read_distant(Reader& reader, Parameters& parameters) {
  const LightSpectrum spectrum = read_light_spectrum(reader, parameters, "L");
  const double scale = spectrum.scale * target_factor(parameters, "illuminance", 1);
  const glm::dvec3 backward = parameters.point3("from", glm::dvec3(0)) - parameters.point3("to", glm::dvec3(0, 0, 1));
  if (!(glm::length(backward) > 0)) return parameters.error("to", "'from' and 'to' coincide");
  add_light(reader, parameters, {LightKind::directional, spectrum.id, static_cast<float>(scale), 0, no_index},
            reader.state.transform * frame_of_z(glm::normalize(backward)));
}

void read_infinite(Reader& reader, Parameters& parameters) {
  parameters.unsupported("portal", "the light is not restricted to it");
  parameters.unsupported("filename", "the light is even");
  const LightSpectrum spectrum = read_light_spectrum(reader, parameters, "L");
  const double scale = spectrum.scale * target_factor(parameters, "illuminance", std::numbers::pi);
  add_light(reader, parameters, {LightKind::environment, spectrum.id, static_cast<float>(scale), 0, no_index},
            reader.state.transform);
}

}  // namespace

void read_light(Reader& reader, std::string_view kind, Parameters& parameters) {
  if (kind == "point") return read_point(reader, parameters);
  if (kind == "distant") return read_distant(reader, parameters);
  if (kind == "infinite") return read_infinite(reader, parameters);
  parameters.ignore_the_rest();
  if (std::find(std::begin(light_kinds), std::end(light_kinds), kind) == std::end(light_kinds)) {
    reader.messages.error(parameters.source(),
                          fmt::format("there is no light source \"{}\"{}", kind, did_you_mean(kind, light_kinds)));
  } else {
    reader.messages.warning_once("light " + std::string(kind), parameters.source(),
                                 fmt::format("light source \"{}\" is not supported yet; it is left out", kind));
  }
}

AreaLight read_area_light(Reader& reader, std::string_view kind, Parameters& parameters) {
  AreaLight light;
  if (kind != "diffuse") {
    constexpr std::string_view known[] = {"diffuse"};
    parameters.ignore_the_rest();
    reader.messages.error(parameters.source(),
                          fmt::format("there is no area light source \"{}\"{}", kind, did_you_mean(kind, known)));
    return light;
  }
  const LightSpectrum spectrum = read_light_spectrum(reader, parameters, "L");
  light.on = true;
  light.spectrum = spectrum.id;
  light.scale = spectrum.scale;
  light.power = parameters.number("power", -1);
  light.two_sided = parameters.boolean("twosided", false);
  parameters.unsupported("filename", "the light emits evenly");
  return light;
}

}  // namespace metamer::pbrt
