// Light sources that may have an image: infinite, goniometric, projection.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "scenes/images/read_image.h"
#include "scenes/pbrt/lights.h"
#include "scenes/pbrt/matrix.h"
#include "systems/light_rows.h"
#include "systems/portal.h"

namespace metamer::pbrt {
namespace {

constexpr double equal_energy_luminance = 683 * 106.856895;  // of the constant spectrum 1, as pbrt has it

std::optional<Image> read_light_image(Reader& reader, Parameters& parameters, const std::string& filename) {
  Image image;
  if (!read_image(reader.resolve(filename), reader.messages.at(parameters.source()), image,
                  reader.messages.diagnostics))
    return std::nullopt;
  return image;
}

// An image of all directions: square ones are pbrt's equal-area octahedral maps, those twice as wide as high are taken
// as latitude-longitude maps, which pbrt refuses.
std::optional<Image> read_sphere_image(Reader& reader, Parameters& parameters, const std::string& filename) {
  std::optional<Image> image = read_light_image(reader, parameters, filename);
  if (!image) return image;
  if (image->width == image->height) {
    image->mapping = ImageMapping::equal_area;
  } else if (image->width == 2 * image->height) {
    image->mapping = ImageMapping::latitude_longitude;
    reader.messages.note_once(
        "latitude-longitude", parameters.source(),
        fmt::format("'{}' is twice as wide as high: it is read as a latitude-longitude map with +z "
                    "up, as imgtool makeequiarea does; pbrt only takes square equal-area maps",
                    filename));
  } else {
    parameters.error("filename",
                     fmt::format("'{}' has {} x {} pixels; expected a square (an equal-area map) or twice as "
                                 "wide as high (a latitude-longitude map)",
                                 filename, image->width, image->height));
    return std::nullopt;
  }
  return image;
}

ImageId add_image(Reader& reader, Image image) {
  reader.scene.images.push_back(std::move(image));
  return static_cast<ImageId>(reader.scene.images.size() - 1);
}

double luminance_of(const Image& image, uint32_t x, uint32_t y) {
  const Color3 luminance = rgb_to_xyz(image.color_space)[1];
  const float* rgb = &image.rgb[3 * (size_t{y} * image.width + x)];
  return luminance[0] * double{rgb[0]} + luminance[1] * double{rgb[1]} + luminance[2] * double{rgb[2]};
}

// What pbrt-v4 takes as the illuminance of an image of luminance 1 per unit: 2 pi times the mean over the sphere of
// Y cos theta above the horizon (half of the true figure, but so it is there).
double image_illuminance(const Image& image) {
  double sum = 0;
  for (uint32_t y = 0; y < image.height; ++y) {
    const double theta = std::numbers::pi * (y + 0.5) / image.height;
    const double ring = std::numbers::pi / 2 * std::sin(theta);  // relative to the mean
    for (uint32_t x = 0; x < image.width; ++x) {
      double weight = ring * std::cos(theta);
      if (image.mapping == ImageMapping::equal_area) {
        // Clarberg 2008: z of the direction through the pixel's centre, from its distance to the inner square's edge.
        const double u = std::abs(2 * (x + 0.5) / image.width - 1), v = std::abs(2 * (y + 0.5) / image.height - 1);
        weight = u + v < 1 ? 1 - (u + v) * (u + v) : 0;
      }
      if (weight > 0) sum += weight * luminance_of(image, x, y);
    }
  }
  return sum * 2 * std::numbers::pi / (static_cast<double>(image.width) * image.height);
}

// Four points in world space, whatever the current transformation: that one turns the image only.
void read_portal(Parameters& parameters, Light& light) {
  if (!parameters.has("portal")) return;
  const std::span<const double> numbers = parameters.array("portal", ParameterType::point3, 3);
  if (numbers.empty()) return;
  if (numbers.size() != 12)
    return parameters.error("portal", fmt::format("'portal' has {} points; expected 4", numbers.size() / 3));
  glm::dvec3 corners[4];
  for (size_t i = 0; i < 4; ++i) corners[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  const std::string_view mistake = set_portal(corners, light);
  if (!mistake.empty()) parameters.error("portal", fmt::format("'portal': {}", mistake));
}

void read_environment_image(Reader& reader, Parameters& parameters, Light light, const std::string& filename) {
  const double scale = parameters.number_from("scale", 1, 0);
  const double illuminance = parameters.number("illuminance", -1);
  if (parameters.has("L")) parameters.error("L", "'L' and 'filename' exclude each other");
  const std::optional<Image> image = read_sphere_image(reader, parameters, filename);
  if (!image) return;
  const double measured = illuminance > 0 ? image_illuminance(*image) : 1;
  if (!(measured > 0)) return parameters.error("illuminance", "the image is black above the horizon");
  const double target = illuminance > 0 ? illuminance / measured : 1;
  light.spectrum = reader.scene.spectra.add_white(image->color_space);
  light.image = add_image(reader, *image);
  add_light(reader, parameters, light, scale * target / white_luminance(reader, image->color_space),
            reader.state.transform);
}

}  // namespace

void read_infinite(Reader& reader, Parameters& parameters) {
  Light light;
  light.kind = LightKind::environment;
  read_portal(parameters, light);
  const std::string filename = parameters.string("filename", "");
  if (!filename.empty()) return read_environment_image(reader, parameters, light, filename);
  const LightSpectrum spectrum = read_light_spectrum(reader, parameters, "L");
  light.spectrum = spectrum.id;
  double scale = spectrum.scale;
  if (light.has_portal == 0) {
    scale *= target_factor(parameters, "illuminance", std::numbers::pi);
  } else {
    // pbrt makes an image of one pixel of it, whose value is the spectrum's own luminance against that of a constant 1,
    // and measures that as an image.
    const double luminance = reader.scene.spectra.luminance(spectrum.id), given = parameters.number("scale", 1);
    const double level = given > 0 ? luminance * spectrum.scale / given : 1;
    if (parameters.number("illuminance", -1) > 0)
      scale *= target_factor(parameters, "illuminance", 2 * std::numbers::pi * level);
    else if (!spectrum.is_rgb)
      scale *= luminance / equal_energy_luminance;
  }
  add_light(reader, parameters, light, scale, reader.state.transform);
}

// pbrt's image has its +z axis along the light's +y, and its intensity is the mean of the channels.
void read_goniometric(Reader& reader, Parameters& parameters) {
  Light light;
  light.kind = LightKind::goniometric;
  const LightSpectrum spectrum = read_light_spectrum(reader, parameters, "I");
  light.spectrum = spectrum.id;
  const std::string filename = parameters.string("filename", "");
  double flux = 4 * std::numbers::pi;
  if (filename.empty()) {
    reader.messages.warning(parameters.source(),
                            "LightSource \"goniometric\": there is no 'filename'; it shines alike in all directions");
    light.kind = LightKind::point;
  } else {
    std::optional<Image> image = read_sphere_image(reader, parameters, filename);
    if (!image) return parameters.ignore_the_rest();
    for (size_t i = 0; i < image->rgb.size(); i += 3) {
      const float mean = (image->rgb[i] + image->rgb[i + 1] + image->rgb[i + 2]) / 3;
      std::fill_n(image->rgb.begin() + static_cast<ptrdiff_t>(i), 3, mean);
    }
    flux = image_weight(light, *image);
    light.image = add_image(reader, std::move(*image));
  }
  if (parameters.number("power", -1) > 0 && !(flux > 0)) return parameters.error("power", "the image is black");
  const glm::dmat4 upright(1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
  add_light(reader, parameters, light, spectrum.scale * target_factor(parameters, "power", flux),
            reader.state.transform * upright);
}

void read_projection(Reader& reader, Parameters& parameters) {
  Light light;
  light.kind = LightKind::projection;
  const double fov = parameters.positive("fov", 90), scale = parameters.number_from("scale", 1, 0);
  if (!(fov < 180)) parameters.error("fov", fmt::format("'fov' is {:g}; expected less than 180 degrees", fov));
  light.fov_deg = static_cast<float>(std::min(fov, 179.999));
  const double power = parameters.number("power", -1);
  const std::string filename = parameters.string("filename", "");
  if (filename.empty()) return parameters.error("filename", "a projection needs a 'filename'");
  const std::optional<Image> image = read_light_image(reader, parameters, filename);
  if (!image) return;
  const double flux = image_weight(light, *image);
  if (power > 0 && !(flux > 0)) return parameters.error("power", "the image is black");
  light.spectrum = reader.scene.spectra.add_white(image->color_space);
  const double per_white = 1 / white_luminance(reader, image->color_space);
  light.image = add_image(reader, *image);
  add_light(reader, parameters, light, scale * per_white * target_factor(parameters, "power", flux),
            reader.state.transform);
}

void read_emission_image(Reader& reader, Parameters& parameters, const std::string& filename, AreaLight& light) {
  const double scale = parameters.number_from("scale", 1, 0);
  if (parameters.has("L")) return parameters.error("L", "'L' and 'filename' exclude each other");
  const std::optional<Image> image = read_light_image(reader, parameters, filename);
  if (!image) return;
  const double mean = image_weight(Light{}, *image);  // of an area light
  if (light.power > 0 && !(mean > 0)) return parameters.error("power", "the image is black");
  if (light.power > 0) light.power /= mean;
  light.on = true;
  light.spectrum = reader.scene.spectra.add_white(image->color_space);
  light.scale = scale / white_luminance(reader, reader.state.color_space);
  light.image = add_image(reader, *image);
}

}  // namespace metamer::pbrt
