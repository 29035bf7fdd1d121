// Film and PixelFilter.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/film/bands.h"
#include "engine/spectrum/sources.h"
#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {
namespace {

constexpr std::string_view film_kinds[] = {"rgb", "spectral", "gbuffer"};
constexpr std::string_view filter_kinds[] = {"box", "gaussian", "mitchell", "sinc", "triangle"};
// pbrt-v4's, whose sensitivities are measured curves that are not here.
constexpr std::string_view sensors[] = {
    "cie1931",       "canon_eos_100d",     "canon_eos_1dx_mkii", "canon_eos_200d",    "canon_eos_200d_mkii",
    "canon_eos_5d",  "canon_eos_5d_mkii",  "canon_eos_5d_mkiii", "canon_eos_5d_mkiv", "canon_eos_5ds",
    "canon_eos_m",   "hasselblad_l1d_20c", "nikon_d810",         "nikon_d850",        "sony_ilce_6400",
    "sony_ilce_7m3", "sony_ilce_7rm3",     "sony_ilce_9"};

void spectral_film(Reader& reader, Parameters& parameters) {
  const int buckets = parameters.integer("nbuckets", 16, 1);
  const double from_nm = parameters.number("lambdamin", 360), to_nm = parameters.number("lambdamax", 830);
  reader.scene.settings.band_count = std::min(static_cast<uint32_t>(buckets), max_band_count);
  reader.messages.note_once(
      "spectral film", parameters.source(),
      fmt::format("{}: {} bands from {} to {} nm are recorded, not {} from {} to {} nm", parameters.what(),
                  reader.scene.settings.band_count, band_min_nm, band_max_nm, buckets, from_nm, to_nm));
}

// Four numbers x_min x_max y_min y_max within the bounds, each minimum below its maximum.
std::optional<glm::dvec4> window(Parameters& parameters, std::string_view name, ParameterType type,
                                 glm::dvec2 largest) {
  const std::span<const double> numbers = parameters.array(name, type, 1);
  if (numbers.empty()) return std::nullopt;
  if (numbers.size() == 4 && 0 <= numbers[0] && numbers[0] < numbers[1] && numbers[1] <= largest.x && 0 <= numbers[2] &&
      numbers[2] < numbers[3] && numbers[3] <= largest.y)
    return glm::dvec4(numbers[0], numbers[1], numbers[2], numbers[3]);
  parameters.error(name, fmt::format("'{}' expects x_min x_max y_min y_max, each minimum below its maximum, from 0 up "
                                     "to {} and {}",
                                     name, largest.x, largest.y));
  return std::nullopt;
}

// pbrt takes the pixels where both are given.
void read_crop(Reader& reader, Parameters& parameters) {
  RenderSettings& settings = reader.scene.settings;
  settings.crop = window(parameters, "cropwindow", ParameterType::real, {1, 1}).value_or(glm::dvec4(0, 1, 0, 1));
  const glm::dvec2 size(settings.width, settings.height);
  const auto pixels = window(parameters, "pixelbounds", ParameterType::integer, size);
  if (!pixels) return;
  if (parameters.has("cropwindow"))
    reader.messages.warning(parameters.source(), "both 'pixelbounds' and 'cropwindow' are given; the former counts");
  settings.crop = {pixels->x / size.x, pixels->y / size.x, pixels->z / size.y, pixels->w / size.y};
}

// The temperature whose light pbrt takes for `whitebalance`: below 4000 K, where there is no daylight, illuminant A.
float white_balance(Parameters& parameters) {
  constexpr double illuminant_a_kelvin = 2856, most_kelvin = daylight_max_kelvin / daylight_shift;
  const double given = parameters.number_from("whitebalance", 0, 0), kelvin = given * daylight_shift;
  if (given == 0) return 0;
  if (given > most_kelvin) {
    parameters.error("whitebalance", fmt::format("'whitebalance' expects at most {:.0f} kelvin, not {}",
                                                 std::floor(most_kelvin), given));
    return 0;
  }
  return static_cast<float>(kelvin < daylight_min_kelvin ? illuminant_a_kelvin : kelvin);
}

void read_sensor(Reader& reader, Parameters& parameters) {
  reader.iso = parameters.positive("iso", 100);
  const std::string sensor = parameters.string("sensor", "cie1931");
  if (std::find(std::begin(sensors), std::end(sensors), sensor) == std::end(sensors)) {
    parameters.error("sensor", fmt::format("there is no sensor \"{}\"{}", sensor, did_you_mean(sensor, sensors)));
  } else if (sensor != "cie1931") {
    parameters.unsupported("sensor", "cie1931 is used");
  }
  reader.scene.settings.white_balance_kelvin = white_balance(parameters);
}

}  // namespace

void read_film(Reader& reader, std::string_view kind, Parameters& parameters) {
  reader.scene.settings.band_count = 0;  // the last Film counts
  if (std::find(std::begin(film_kinds), std::end(film_kinds), kind) == std::end(film_kinds)) {
    reader.messages.error(parameters.source(),
                          fmt::format("there is no Film \"{}\"{}", kind, did_you_mean(kind, film_kinds)));
    return parameters.ignore_the_rest();
  }
  if (kind == "spectral") {
    spectral_film(reader, parameters);
  } else if (kind == "gbuffer") {
    parameters.string("coordinatesystem", "camera");
    reader.messages.warning(
        parameters.source(),
        fmt::format("{} is not supported; its size and exposure are used, it records R G B", parameters.what()));
  }
  reader.scene.settings.width = static_cast<uint32_t>(parameters.integer("xresolution", 1280, 1));
  reader.scene.settings.height = static_cast<uint32_t>(parameters.integer("yresolution", 720, 1));
  read_crop(reader, parameters);
  read_sensor(reader, parameters);
  if (!parameters.string("filename", "").empty()) {
    reader.messages.note_once("filename", parameters.source(),
                              "Film's 'filename' is not used: outputs are named after the scene, or by -o",
                              Strict::allows);
  }
  constexpr double no_limit = std::numeric_limits<double>::infinity();
  reader.scene.settings.largest_component = static_cast<float>(parameters.positive("maxcomponentvalue", no_limit));
  parameters.number("diagonal", 35);  // only the realistic camera's business
  parameters.boolean("savefp16", true);
  reader.scene.settings.primaries = reader.state.color_space;
}

void read_filter(Reader& reader, std::string_view kind, Parameters& parameters) {
  Filter filter{FilterKind::gaussian, 1.5f, 1.5f, 0.5f};
  double radius = 1.5;
  if (std::find(std::begin(filter_kinds), std::end(filter_kinds), kind) == std::end(filter_kinds)) {
    reader.messages.error(parameters.source(),
                          fmt::format("there is no PixelFilter \"{}\"{}", kind, did_you_mean(kind, filter_kinds)));
    return parameters.ignore_the_rest();
  }
  if (kind == "box") {
    filter.kind = FilterKind::box;
    radius = 0.5;
  } else if (kind == "triangle") {
    filter.kind = FilterKind::triangle;
    radius = 2;
  } else if (kind == "mitchell") {
    filter.kind = FilterKind::mitchell;
    filter.b = static_cast<float>(parameters.number("B", 1.0 / 3));
    filter.c = static_cast<float>(parameters.number("C", 1.0 / 3));
    radius = 2;
  } else if (kind == "sinc") {
    filter.kind = FilterKind::sinc;
    filter.tau = static_cast<float>(parameters.positive("tau", 3));
    radius = 4;
  }
  filter.radius_x = static_cast<float>(parameters.positive("xradius", radius));
  filter.radius_y = static_cast<float>(parameters.positive("yradius", radius));
  if (filter.kind == FilterKind::gaussian) filter.sigma = static_cast<float>(parameters.positive("sigma", 0.5));
  reader.scene.settings.filter = filter;
}

}  // namespace metamer::pbrt
