// What the parts of the reader of light sources share.
#pragma once
#include <glm/mat4x4.hpp>

#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {

// A light's spectrum parameter, by default the white of the current colour space.
struct LightSpectrum {
  SpectrumId id = zero_spectrum;
  double scale = 1;     // `scale`, divided by the spectrum's luminance
  bool is_rgb = false;  // or the white: its own luminance, against the white's, is left in
};
LightSpectrum read_light_spectrum(Reader& reader, Parameters& parameters, std::string_view name);

// cd/m^2 of the white of a colour space, by which the scale of rgb values and images is divided.
double white_luminance(Reader& reader, ColorSpace space);

// What a target figure (power, illuminance) multiplies the scale by; 1 if it is not given. pbrt ignores targets <= 0.
double target_factor(Parameters& parameters, std::string_view name, double per_unit_scale);

// Makes the entity; `scale` is checked to be one in single precision.
void add_light(Reader& reader, Parameters& parameters, Light light, double scale, const glm::dmat4& transform);

// image_lights.cpp
void read_infinite(Reader& reader, Parameters& parameters);
void read_goniometric(Reader& reader, Parameters& parameters);
void read_projection(Reader& reader, Parameters& parameters);
// The image of shapes that emit one; the light stays off after an error.
void read_emission_image(Reader& reader, Parameters& parameters, const std::string& filename, AreaLight& light);

}  // namespace metamer::pbrt
