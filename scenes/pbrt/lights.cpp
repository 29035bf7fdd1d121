// Light sources. The scale of every light is pbrt-v4's: see read_pbrt.h.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "scenes/images/read_image.h"
#include "scenes/pbrt/matrix.h"
#include "scenes/pbrt/reader.h"
#include "systems/light_rows.h"

namespace metamer::pbrt {
namespace {

constexpr std::string_view light_kinds[] = {"point", "distant", "infinite", "spot", "goniometric", "projection"};

constexpr double least_luminance = 1e-30;  // what single precision can still divide by

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
  if (luminance > least_luminance) {
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
  report_moving_light(reader, parameters.source());
  Registry& registry = reader.scene.registry;
  const Entity entity = registry.create();
  registry.set(entity, to_component(transform));
  registry.set(entity, light);
  registry.set(entity, parameters.source());
}

void add_light(Reader& reader, Parameters& parameters, LightKind kind, SpectrumId spectrum, double scale,
               const glm::dmat4& transform, ImageId image = no_index) {
  Light light;
  light.kind = kind;
  light.spectrum = spectrum;
  light.scale = to_light_scale(parameters, scale);
  light.image = image;
  add_light(reader, parameters, light, transform);
}

void read_point(Reader& reader, Parameters& parameters) {
  const LightSpectrum spectrum = read_light_spectrum(reader, parameters, "I");
  const double scale = spectrum.scale * target_factor(parameters, "power", 4 * std::numbers::pi);
  const glm::dvec3 from = parameters.point3("from", glm::dvec3(0));
  add_light(reader, parameters, LightKind::point, spectrum.id, scale, reader.state.transform * translation(from));
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
  Light light;
  light.kind = LightKind::spot;
  light.spectrum = spectrum.id;
  light.cone_deg = static_cast<float>(std::min(cone, 180.0));
  light.falloff_deg = static_cast<float>(std::min(falloff, cone));
  const double flux = flux_per_unit(abstract_light(glm::dmat4(1), light));
  light.scale = to_light_scale(parameters, spectrum.scale * target_factor(parameters, "power", flux));
  const glm::dvec3 from = parameters.point3("from", glm::dvec3(0));
  const glm::dvec3 backward = from - parameters.point3("to", glm::dvec3(0, 0, 1));
  if (!(glm::length(backward) > 0)) return parameters.error("to", "'from' and 'to' coincide");
  add_light(reader, parameters, light,
            reader.state.transform * translation(from) * frame_of_z(glm::normalize(backward)));
}

void read_distant(Reader& reader, Parameters& parameters) {
  const LightSpectrum spectrum = read_light_spectrum(reader, parameters, "L");
  const double scale = spectrum.scale * target_factor(parameters, "illuminance", 1);
  const glm::dvec3 backward = parameters.point3("from", glm::dvec3(0)) - parameters.point3("to", glm::dvec3(0, 0, 1));
  if (!(glm::length(backward) > 0)) return parameters.error("to", "'from' and 'to' coincide");
  add_light(reader, parameters, LightKind::directional, spectrum.id, scale,
            reader.state.transform * frame_of_z(glm::normalize(backward)));
}

// What pbrt-v4 takes as the illuminance of an equal-area image of luminance 1 per unit: the sum over the upper
// hemisphere of Y cos theta times 2 pi over the number of pixels (half of the true figure, but so it is there).
double image_illuminance(const Image& image) {
  const Matrix3& to_xyz = rgb_to_xyz(image.color_space);
  double sum = 0;
  for (uint32_t y = 0; y < image.height; ++y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      // Clarberg 2008: z of the direction through the pixel's centre, from its distance to the inner square's edge.
      const double u = std::abs(2 * (x + 0.5) / image.width - 1), v = std::abs(2 * (y + 0.5) / image.height - 1);
      const double z = 1 - (u + v) * (u + v);
      if (u + v >= 1) continue;
      const float* rgb = &image.rgb[3 * (size_t{y} * image.width + x)];
      for (size_t c = 0; c < 3; ++c) sum += to_xyz[1][c] * static_cast<double>(rgb[c]) * z;
    }
  }
  return sum * 2 * std::numbers::pi / (static_cast<double>(image.width) * image.height);
}

void read_environment_image(Reader& reader, Parameters& parameters, const std::string& filename) {
  const double scale = parameters.number_from("scale", 1, 0);
  const double illuminance = parameters.number("illuminance", -1);
  if (parameters.has("L")) parameters.error("L", "'L' and 'filename' exclude each other");
  Image image;
  if (!read_image(reader.resolve(filename), reader.messages.at(parameters.source()), image,
                  reader.messages.diagnostics))
    return;
  image.mapping = ImageMapping::equal_area;
  if (image.width != image.height) {
    return parameters.error("filename", fmt::format("'{}' has {} x {} pixels; pbrt's equal-area images are square",
                                                    filename, image.width, image.height));
  }
  const double measured = illuminance > 0 ? image_illuminance(image) : 1;
  if (!(measured > 0)) return parameters.error("illuminance", "the image is black above the horizon");
  const double target = illuminance > 0 ? illuminance / measured : 1;
  const auto id = static_cast<ImageId>(reader.scene.images.size());
  add_light(reader, parameters, LightKind::environment, reader.scene.spectra.add_white(image.color_space),
            scale * target / white_luminance(reader, image.color_space), reader.state.transform, id);
  reader.scene.images.push_back(std::move(image));
}

void read_infinite(Reader& reader, Parameters& parameters) {
  parameters.unsupported("portal", "the light is not restricted to it");
  const std::string filename = parameters.string("filename", "");
  if (!filename.empty()) return read_environment_image(reader, parameters, filename);
  const LightSpectrum spectrum = read_light_spectrum(reader, parameters, "L");
  const double scale = spectrum.scale * target_factor(parameters, "illuminance", std::numbers::pi);
  add_light(reader, parameters, LightKind::environment, spectrum.id, scale, reader.state.transform);
}

}  // namespace

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
