#include "scenes/native/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "engine/film/bands.h"
#include "scenes/native/transforms.h"
#include "systems/display_colour.h"

namespace metamer {
namespace {

Filter read_filter(const SceneContext& context, const Json::Value& value) {
  const JsonObject object(context.reader, value, "filter");
  if (!object.is_valid()) return {};
  Filter filter;
  constexpr double usual_radii[] = {0.5, 1, 1.5, 2, 4};
  const auto named = std::find(filter_names.begin(), filter_names.end(), object.type());
  filter.kind = static_cast<FilterKind>(named - filter_names.begin());
  const double usual = usual_radii[static_cast<size_t>(filter.kind)];
  std::array<double, 2> radius{usual, usual};
  if (const Json::Value* given = object.find("radius")) {
    if (given->isArray())
      context.reader.numbers(*given, "radius", positive, radius);
    else
      radius.fill(context.reader.number(*given, "radius", positive, usual));
  }
  filter.radius_x = static_cast<float>(radius[0]);
  filter.radius_y = static_cast<float>(radius[1]);
  if (filter.kind == FilterKind::gaussian) filter.sigma = object.number_f("sigma", positive, filter.sigma);
  if (filter.kind == FilterKind::mitchell) {
    filter.b = object.number_f("b", any_number, filter.b);
    filter.c = object.number_f("c", any_number, filter.c);
  }
  if (filter.kind == FilterKind::sinc) filter.tau = object.number_f("tau", positive, filter.tau);
  return filter;
}

// How many bands: true for the default, false for none, or their number.
uint32_t read_band_count(const SceneContext& context, const Json::Value& value) {
  if (value.isBool()) return value.asBool() ? default_band_count : 0;
  if (value.isUInt() && value.asUInt() <= max_band_count) return value.asUInt();
  context.reader.expected(value, "spectral", fmt::format("true, false or a number of bands up to {}", max_band_count));
  return 0;
}

glm::dvec4 read_crop(const SceneContext& context, const Json::Value& value) {
  constexpr Range fraction{0, 1};
  std::array<double, 4> crop{0, 1, 0, 1};
  context.reader.numbers(value, "crop", fraction, crop);
  if (crop[0] < crop[1] && crop[2] < crop[3]) return {crop[0], crop[1], crop[2], crop[3]};
  context.reader.expected(value, "crop", "[x_min, x_max, y_min, y_max], each minimum below its maximum");
  return {0, 1, 0, 1};
}

}  // namespace

RenderSettings read_settings(const SceneContext& context, const Json::Value& value) {
  const JsonReader& reader = context.reader;
  const JsonObject object(reader, value, *find_object_spec("settings"), "settings");
  RenderSettings settings;
  if (!object.is_valid()) return settings;
  if (const Json::Value* size = object.find("size")) {
    constexpr uint32_t most = 1u << 20;  // pixels along a side
    if (size->isArray() && size->size() == 2) {
      settings.width = reader.integer((*size)[0], "size[0]", 1, most, settings.width);
      settings.height = reader.integer((*size)[1], "size[1]", 1, most, settings.height);
    } else {
      reader.expected(*size, "size", "[width, height] in pixels");
    }
  }
  constexpr Range stops{-64, 64};
  settings.samples_per_pixel = object.integer("samples", 1, 1u << 30, settings.samples_per_pixel);
  settings.max_depth = object.integer("max_depth", 0, 0xffffffffu, settings.max_depth);
  settings.integrator =
      static_cast<Integrator>(object.choice("integrator", integrator_names, static_cast<size_t>(settings.integrator)));
  settings.occlusion_distance =
      context.metres(object.number("occlusion_distance", positive, std::numeric_limits<double>::infinity()));
  settings.clamp_indirect = object.number_f("clamp_indirect", positive, settings.clamp_indirect);
  settings.shadows = object.boolean("shadows", settings.shadows);
  settings.seed = object.integer("seed", 0, 0xffffffffu, settings.seed);
  settings.exposure_stops = object.number_f("exposure", stops, settings.exposure_stops);
  settings.sensor_scale = object.number_f("sensor_scale", positive, settings.sensor_scale);
  if (object.has("largest_component"))
    settings.largest_component = object.number_f("largest_component", positive, settings.largest_component);
  if (object.has("white_balance")) {
    constexpr Range kelvin{least_white_kelvin, most_white_kelvin};
    settings.white_balance_kelvin = object.number_f("white_balance", kelvin, settings.white_balance_kelvin);
  }
  settings.primaries = static_cast<ColorSpace>(object.choice("primaries", color_space_names(), 0));
  if (const Json::Value* spectral = object.find("spectral")) settings.band_count = read_band_count(context, *spectral);
  settings.color = static_cast<ColorMode>(object.choice("color", color_mode_names(), 0));
  if (const Json::Value* crop = object.find("crop")) settings.crop = read_crop(context, *crop);
  if (const Json::Value* shutter = object.find("shutter")) {
    const glm::dvec2 times = read_times(reader, *shutter, "shutter");
    settings.shutter_open = times.x;
    settings.shutter_close = times.y;
  }
  settings.pixel_jitter = object.boolean("pixel_jitter", settings.pixel_jitter);
  if (const Json::Value* filter = object.find("filter")) settings.filter = read_filter(context, *filter);
  return settings;
}

}  // namespace metamer
