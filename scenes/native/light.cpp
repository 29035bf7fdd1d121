#include <fmt/format.h>

#include <numbers>

#include "scenes/file_bytes.h"
#include "scenes/images/read_image.h"
#include "scenes/native/components.h"
#include "scenes/native/spectra.h"
#include "systems/light_rows.h"
#include "systems/portal.h"

namespace metamer {
namespace {

// How a type of light may say how bright it is: by a spectrum in radiometric units, or by a photometric number and the
// spectrum's shape. `per_unit` turns the number into the quantity whose spectrum the component holds.
struct Photometry {
  std::string_view key;
  double per_unit;
};
struct Brightness {
  std::string_view type, radiometric;
  std::string_view radiometric_total;     // of the whole shape; may be none
  std::array<Photometry, 3> photometric;  // those without a key are none
};
constexpr Brightness brightnesses[] = {
    {"area", "radiance", "power", {{{"luminance", 1}, {"nits", 1}, {"lumens", 1}}}},  // see Light::is_power
    {"environment", "radiance", "", {{{"luminance", 1}, {"nits", 1}, {}}}},
    {"point", "intensity", "", {{{"candela", 1}, {"lumens", 1 / (4 * std::numbers::pi)}, {}}}},
    {"spot", "intensity", "", {{{"candela", 1}, {"lumens", 1}, {}}}},  // lumens: divided by the cone's flux
    // Of a direction where the image is white; lumens: divided by what the image lets out.
    {"goniometric", "intensity", "", {{{"candela", 1}, {"lumens", 1}, {}}}},
    {"projection", "intensity", "", {{{"candela", 1}, {"lumens", 1}, {}}}},
    {"directional", "irradiance", "", {{{"lux", 1}, {}, {}}}},
};

const Brightness& brightness_of(std::string_view type) {
  for (const Brightness& brightness : brightnesses)
    if (brightness.type == type) return brightness;
  return brightnesses[0];
}

SpectrumId white_of(SceneContext& context, ColorSpace space) {
  SpectrumSet& set = context.scene.spectra;
  const SpectrumId white = set.add_white(space);
  return set.scaled(white, 1 / set.luminance(white)).id;
}

// The spectrum whose shape is `shape` and whose luminance is `target`.
SpectrumId normalized(SceneContext& context, const Json::Value& at, SpectrumId shape, double target) {
  SpectrumSet& set = context.scene.spectra;
  const double luminance = set.luminance(shape);
  const SpectrumResult result = luminance > 0 ? set.scaled(shape, target / luminance) : SpectrumResult{};
  if (!(luminance > 0)) context.reader.error(at, "'spectrum' is invisible: its luminance is 0 and cannot be scaled");
  if (!result.ok()) context.reader.error(at, fmt::format("'spectrum': {}", result.error));
  return result.id;
}

SpectrumId read_brightness(SceneContext& context, const JsonObject& object, ColorSpace space) {
  const Brightness& ways = brightness_of(object.type());
  std::vector<std::string_view> keys = {ways.radiometric};
  for (const Photometry& photometry : ways.photometric)
    if (!photometry.key.empty()) keys.push_back(photometry.key);
  const std::string_view first_photometric = keys[1];
  if (!ways.radiometric_total.empty()) keys.push_back(ways.radiometric_total);
  const bool is_image = object.has("image");
  bool has_any = false;
  for (const std::string_view key : keys) has_any = has_any || object.has(key);
  const Json::Value* shape = object.find("spectrum");
  const std::string_view way = is_image && !has_any ? std::string_view() : object.one_of(keys);
  if (way.empty() || way == ways.radiometric || way == ways.radiometric_total) {
    if (shape != nullptr)
      context.reader.error(*shape,
                           fmt::format("'spectrum' is the shape for '{}'; a spectrum in absolute units goes to '{}'",
                                       first_photometric, way.empty() ? ways.radiometric : way));
    return way.empty() ? white_of(context, space) : read_spectrum(context, *object.find(way), way, Quantity::light);
  }
  double per_unit = 1;
  for (const Photometry& photometry : ways.photometric)
    if (photometry.key == way) per_unit = photometry.per_unit;
  const double target = object.number(way, not_negative, 1) * per_unit;
  if (shape == nullptr) return normalized(context, object.value(), white_of(context, space), target);
  const size_t errors_before = context.reader.diagnostics().error_count();
  const SpectrumId id = read_spectrum(context, *shape, "spectrum", Quantity::light);
  return context.reader.diagnostics().error_count() == errors_before ? normalized(context, *shape, id, target) : id;
}

void read_light_image(SceneContext& context, const JsonObject& object, ColorSpace space, Light& light) {
  constexpr std::string_view mappings[] = {"latitude_longitude", "equal_area"};  // in the order of ImageMapping
  const JsonReader& reader = context.reader;
  const bool is_sphere = light.kind == LightKind::environment || light.kind == LightKind::goniometric;
  const auto mapping = static_cast<ImageMapping>(is_sphere ? object.choice("mapping", mappings, 0) : 0);
  if (!object.has("image")) {
    if (is_sphere && object.has("mapping")) reader.error(*object.find("mapping"), "'mapping' goes with 'image' only");
    if (object.has("space")) reader.error(*object.find("space"), "'space' goes with 'image' only");
    return;
  }
  const Json::Value& value = *object.find("image");
  const std::string file = reader.text(value, "image");
  if (file.empty()) return;
  Image image;
  const std::string path = resolve_path(file, reader.document().path());
  if (!read_image(path, reader.document().at(value), image, reader.diagnostics())) return;
  image.mapping = mapping;
  image.color_space = space;
  if (mapping == ImageMapping::equal_area && image.width != image.height) {
    reader.error(value, fmt::format("'image' has {} x {} pixels; expected a square for the mapping 'equal_area'",
                                    image.width, image.height));
  }
  light.image = static_cast<ImageId>(context.scene.images.size());
  context.scene.images.push_back(std::move(image));
}

void read_portal(SceneContext& context, const JsonObject& object, Light& light) {
  const Json::Value* value = object.find("portal");
  if (value == nullptr) return;
  const JsonReader& reader = context.reader;
  if (!reader.array(*value, "portal", "four points [x, y, z]")) return;
  if (value->size() != 4) return reader.error(*value, fmt::format("'portal' has {} points; expected 4", value->size()));
  glm::dvec3 corners[4];
  const size_t errors_before = reader.diagnostics().error_count();
  for (Json::ArrayIndex i = 0; i < 4; ++i)
    corners[i] = reader.vector((*value)[i], "portal", {0, 0, 0}) * context.metres_per_unit;
  if (reader.diagnostics().error_count() != errors_before) return;
  const std::string_view mistake = set_portal(corners, light);
  if (!mistake.empty()) reader.error(*value, fmt::format("'portal': {}", mistake));
}

// What the lumens of a light are divided by: its flux per unit of intensity.
double flux_of(const SceneContext& context, const Light& light) {
  if (light.image == no_index) return flux_per_unit(abstract_light(glm::dmat4(1), light));
  return image_weight(light, context.scene.images[light.image]);
}

// Half angles in degrees. Where the falloff starts is Mitsuba's default, three quarters of the cone.
void read_cone(const JsonReader& reader, const JsonObject& object, Light& light) {
  light.cone_deg = object.number_f("cone_angle", {0, 180, true, false}, 30);
  light.falloff_deg = object.number_f("falloff_start", {0, 180}, 0.75f * light.cone_deg);
  if (light.falloff_deg <= light.cone_deg) return;
  reader.error(*object.find("falloff_start"),
               fmt::format("'falloff_start' is {:g}; expected at most the 'cone_angle', {:g}", light.falloff_deg,
                           light.cone_deg));
  light.falloff_deg = light.cone_deg;
}

}  // namespace

void read_light(SceneContext& context, Entity entity, const Json::Value& value) {
  const JsonObject object(context.reader, value, "light");
  if (!object.is_valid()) return;
  if (object.type() == "sky") return read_sky(context, entity, object);
  Light light;
  ColorSpace space = ColorSpace::srgb;
  double flux_per_lumen_unit = 1;
  light.scale = object.number_f("scale", not_negative, 1);
  if (object.type() == "area") {
    light.kind = LightKind::area;
    light.two_sided = object.boolean("two_sided", false) ? 1 : 0;
    light.cosine_power = object.number_f("cosine_power", {0, 1e6}, 0);
    light.is_power = object.has("lumens") || object.has("power") ? 1 : 0;
    space = static_cast<ColorSpace>(object.choice("space", color_space_names(), 0));
    read_light_image(context, object, space, light);
  } else if (object.type() == "point") {
    light.kind = LightKind::point;
  } else if (object.type() == "spot") {
    light.kind = LightKind::spot;
    read_cone(context.reader, object, light);
    if (object.has("lumens")) flux_per_lumen_unit = flux_of(context, light);
  } else if (object.type() == "directional") {
    light.kind = LightKind::directional;
    light.angular_diameter_deg = object.number_f("angular_diameter", {0, 180, false, true}, 0);
  } else {
    light.kind = object.type() == "goniometric"  ? LightKind::goniometric
                 : object.type() == "projection" ? LightKind::projection
                                                 : LightKind::environment;
    space = static_cast<ColorSpace>(object.choice("space", color_space_names(), 0));
    if (light.kind == LightKind::projection) light.fov_deg = object.number_f("fov", {0, 180, true, true}, 90);
    read_light_image(context, object, space, light);
    if (light.kind == LightKind::environment) read_portal(context, object, light);
    if (light.kind != LightKind::environment && light.image == no_index) return;  // reported
    if (object.has("lumens")) flux_per_lumen_unit = flux_of(context, light);
    if (!(flux_per_lumen_unit > 0)) {
      context.reader.error(*object.find("image"), "'image' is black: it lets no 'lumens' out");
      flux_per_lumen_unit = 1;
    }
  }
  light.spectrum = read_brightness(context, object, space);
  light.scale = static_cast<float>(light.scale / flux_per_lumen_unit);
  context.scene.registry.set(entity, light);
}

}  // namespace metamer
