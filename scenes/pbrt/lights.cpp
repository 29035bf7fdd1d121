// Light sources. The scale of every light is pbrt-v4's: see read_pbrt.h.
#include "scenes/pbrt/lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "scenes/pbrt/matrix.h"
#include "systems/light_rows.h"

namespace metamer::pbrt {
namespace {

constexpr std::string_view light_kinds[] = {"point", "distant", "infinite", "spot", "goniometric", "projection"};

constexpr double least_luminance = 1e-30;  // what single precision can still divide by

Light light_of(LightKind kind, SpectrumId spectrum) {
  Light light;
  light.kind = kind;
  light.spectrum = spectrum;
  return light;
}

void read_point(Reader& reader, Parameters& parameters) {
  const LightSpectrum spectrum = read_light_spectrum(reader, parameters, "I");
  const double scale = spectrum.scale * target_factor(parameters, "power", 4 * std::numbers::pi);
  const glm::dvec3 from = parameters.point3("from", glm::dvec3(0));
  add_light(reader, parameters, light_of(LightKind::point, spectrum.id), scale,
            reader.state.transform * translation(from));
}

// The falloff is pbrt's: a smoothstep between the cosines of the angles where it starts and where the light ends.
void read_spot(Reader& reader, Parameters& parameters) {
  const LightSpectrum spectrum = read_light_spectrum(reader, parameters, "I");
  const double cone = parameters.positive("coneangle", 30), delta = parameters.number_from("conedeltaangle", 5, 0);
  if (cone > 180) parameters.error("coneangle", fmt::format("'coneangle' is {:g}; expected at most 180 degrees", cone));
  const double falloff = std::abs(cone - delta);  // as there: the default of 5 goes with a cone of 3, too
  if (falloff > cone) {
    parameters.error(
        "conedeltaangle",
        fmt::format("'conedeltaangle' is {:g}; expected at most twice the 'coneangle', {:g}", delta, cone));
  }
  Light light = light_of(LightKind::spot, spectrum.id);
  light.cone_deg = static_cast<float>(std::min(cone, 180.0));
  light.falloff_deg = static_cast<float>(std::min(falloff, cone));
  const double flux = flux_per_unit(abstract_light(glm::dmat4(1), light));
  const double scale = spectrum.scale * target_factor(parameters, "power", flux);
  const glm::dvec3 from = parameters.point3("from", glm::dvec3(0));
  const glm::dvec3 backward = from - parameters.point3("to", glm::dvec3(0, 0, 1));
  if (!(glm::length(backward) > 0)) return parameters.error("to", "'from' and 'to' coincide");
  add_light(reader, parameters, light, scale,
            reader.state.transform * translation(from) * frame_of_z(glm::normalize(backward)));
}

void read_distant(Reader& reader, Parameters& parameters) {
  const LightSpectrum spectrum = read_light_spectrum(reader, parameters, "L");
  const double scale = spectrum.scale * target_factor(parameters, "illuminance", 1);
  const glm::dvec3 backward = parameters.point3("from", glm::dvec3(0)) - parameters.point3("to", glm::dvec3(0, 0, 1));
  if (!(glm::length(backward) > 0)) return parameters.error("to", "'from' and 'to' coincide");
  add_light(reader, parameters, light_of(LightKind::directional, spectrum.id), scale,
            reader.state.transform * frame_of_z(glm::normalize(backward)));
}

}  // namespace

double white_luminance(Reader& reader, ColorSpace space) {
  SpectrumSet& spectra = reader.scene.spectra;
  return spectra.luminance(spectra.add_white(space));
}

LightSpectrum read_light_spectrum(Reader& reader, Parameters& parameters, std::string_view name) {
  SpectrumSet& spectra = reader.scene.spectra;
  const auto value = read_spectrum(reader, parameters, name, RgbKind::illuminant, SpectrumAlso::nothing);
  const ColorSpace space = value && value->rgb ? *value->rgb : reader.state.color_space;
  LightSpectrum light{value ? value->id : spectra.add_white(space), parameters.number_from("scale", 1, 0),
                      !value || value->rgb};
  // rgb values count against the white alone: their own luminance is part of what they say.
  const double luminance = light.is_rgb ? white_luminance(reader, space) : spectra.luminance(value->id);
  if (luminance > least_luminance) {
    light.scale /= luminance;
  } else {
    parameters.error(name, fmt::format("'{}' has no luminance, by which pbrt divides it", name));
  }
  return light;
}

double target_factor(Parameters& parameters, std::string_view name, double per_unit_scale) {
  const double target = parameters.number(name, -1);
  return target > 0 ? target / per_unit_scale : 1;
}

void add_light(Reader& reader, Parameters& parameters, Light light, double scale, const glm::dmat4& transform) {
  if (const std::string_view mistake = transform_mistake(transform); !mistake.empty())
    return parameters.error("from", fmt::format("the light's transformation is {}", mistake));
  report_moving_light(reader, parameters.source());
  light.scale = to_light_scale(parameters, scale);
  Registry& registry = reader.scene.registry;
  const Entity entity = registry.create();
  registry.set(entity, to_component(transform));
  registry.set(entity, light);
  registry.set(entity, parameters.source());
}

float to_light_scale(Parameters& parameters, double scale) {
  if (scale <= static_cast<double>(std::numeric_limits<float>::max())) return static_cast<float>(scale);
  parameters.error("scale", fmt::format("the light is scaled by {:g}, which is too large", scale));
  return 0;
}

void read_light(Reader& reader, std::string_view kind, Parameters& parameters) {
  if (kind == "point") return read_point(reader, parameters);
  if (kind == "spot") return read_spot(reader, parameters);
  if (kind == "distant") return read_distant(reader, parameters);
  if (kind == "infinite") return read_infinite(reader, parameters);
  if (kind == "goniometric") return read_goniometric(reader, parameters);
  if (kind == "projection") return read_projection(reader, parameters);
  parameters.ignore_the_rest();
  reader.messages.error(parameters.source(),
                        fmt::format("there is no light source \"{}\"{}", kind, did_you_mean(kind, light_kinds)));
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
  const std::string filename = parameters.string("filename", "");
  light.power = parameters.number("power", -1);
  light.two_sided = parameters.boolean("twosided", false);
  if (!filename.empty()) {
    read_emission_image(reader, parameters, filename, light);
    return light;
  }
  const LightSpectrum spectrum = read_light_spectrum(reader, parameters, "L");
  light.on = true;
  light.spectrum = spectrum.id;
  light.scale = spectrum.scale;
  return light;
}

}  // namespace metamer::pbrt
