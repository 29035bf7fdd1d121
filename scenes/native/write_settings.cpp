#include "scenes/native/write_parts.h"

namespace metamer {
namespace {

JsonText write_filter(const Filter& filter) {
  JsonText object = JsonText::object();
  object.add("type", JsonText::string(filter_name(filter.kind)));
  if (filter.radius_x == filter.radius_y)
    object.add("radius", JsonText::number(filter.radius_x));
  else
    object.add("radius", JsonText::numbers(std::array{filter.radius_x, filter.radius_y}));
  if (filter.kind == FilterKind::gaussian) object.add("sigma", JsonText::number(filter.sigma));
  if (filter.kind == FilterKind::mitchell)
    object.add("b", JsonText::number(filter.b)).add("c", JsonText::number(filter.c));
  if (filter.kind == FilterKind::sinc) object.add("tau", JsonText::number(filter.tau));
  return object;
}

}  // namespace

JsonText write_settings(const RenderSettings& settings) {
  const RenderSettings usual;
  JsonText object = JsonText::object().break_lines();
  object.add("size", JsonText::array().add(JsonText::integer(settings.width)).add(JsonText::integer(settings.height)));
  object.add("samples", JsonText::integer(settings.samples_per_pixel));
  object.add("max_depth", JsonText::integer(settings.max_depth));
  object.add("seed", JsonText::integer(settings.seed));
  object.add("integrator", JsonText::string(integrator_name(settings.integrator)));
  if (!settings.shadows) object.add("shadows", JsonText::boolean(false));
  object.add("filter", write_filter(settings.filter));
  const glm::dvec4& crop = settings.crop;
  if (crop != usual.crop) object.add("crop", JsonText::numbers(std::array{crop.x, crop.y, crop.z, crop.w}));
  if (!settings.pixel_jitter) object.add("pixel_jitter", JsonText::boolean(false));
  if (settings.shutter_open != usual.shutter_open || settings.shutter_close != usual.shutter_close)
    object.add("shutter", JsonText::numbers(std::array{settings.shutter_open, settings.shutter_close}));
  if (settings.occlusion_distance != usual.occlusion_distance)
    object.add("occlusion_distance", JsonText::number(settings.occlusion_distance));
  if (settings.clamp_indirect != usual.clamp_indirect)
    object.add("clamp_indirect", JsonText::number(settings.clamp_indirect));
  if (settings.exposure_stops != usual.exposure_stops)
    object.add("exposure", JsonText::number(settings.exposure_stops));
  if (settings.sensor_scale != usual.sensor_scale) object.add("sensor_scale", JsonText::number(settings.sensor_scale));
  if (settings.largest_component != usual.largest_component)
    object.add("largest_component", JsonText::number(settings.largest_component));
  if (settings.white_balance_kelvin != usual.white_balance_kelvin)
    object.add("white_balance", JsonText::number(settings.white_balance_kelvin));
  if (settings.primaries != usual.primaries)
    object.add("primaries", JsonText::string(color_space_name(settings.primaries)));
  if (settings.band_count != usual.band_count) object.add("spectral", JsonText::integer(settings.band_count));
  if (settings.color != usual.color) object.add("color", JsonText::string(color_mode_name(settings.color)));
  return object;
}

}  // namespace metamer
