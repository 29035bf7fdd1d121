// What is not in the world: camera, film, filter, sampler, integrator.
#include <fmt/format.h>

#include <glm/matrix.hpp>

#include "engine/film/bands.h"
#include "scenes/pbrt/matrix.h"
#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {
namespace {

// pbrt's screen: x_min x_max y_min y_max where 1 is half the shorter side; all 0 if it follows the film's shape.
glm::vec4 screen_window(Parameters& parameters) {
  glm::vec4 window(0);
  if (parameters.has("frameaspectratio")) {
    const auto aspect = static_cast<float>(parameters.positive("frameaspectratio", 1));
    const float x = aspect > 1 ? aspect : 1, y = aspect > 1 ? 1 : 1 / aspect;
    window = {-x, x, -y, y};
  }
  const std::span<const double> numbers = parameters.array("screenwindow", ParameterType::real, 1);
  if (numbers.empty()) return window;
  if (numbers.size() != 4 || !(numbers[0] < numbers[1]) || !(numbers[2] < numbers[3])) {
    parameters.error("screenwindow", "'screenwindow' expects x_min x_max y_min y_max, each minimum below its maximum");
    return window;
  }
  for (int i = 0; i < 4; ++i) window[i] = static_cast<float>(numbers[static_cast<size_t>(i)]);
  return window;
}

void add_camera(Reader& reader, const Camera& camera, Source source) {
  if (!reader.camera.is_null()) reader.scene.registry.destroy(reader.camera);
  reader.camera = reader.scene.registry.create();
  const glm::dmat4 camera_to_world = glm::inverse(reader.state.transform);
  reader.coordinate_systems["camera"] = camera_to_world;
  reader.scene.registry.set(reader.camera, to_component(camera_to_world));
  reader.scene.registry.set(reader.camera, camera);
  if (!reader.state.media.outside.is_null())
    reader.scene.registry.set(reader.camera, MediumSlot{{}, reader.state.media.outside});
  reader.scene.registry.set(reader.camera, Name{reader.scene.names.add("camera")});
  reader.scene.registry.set(reader.camera, source);
}

}  // namespace

void read_camera(Reader& reader, std::string_view kind, Parameters& parameters) {
  Camera camera{.fov_deg = 90, .focal_distance = 1e6f};
  if (!reader.camera.is_null()) reader.messages.error(parameters.source(), "there is more than one Camera");
  if (kind == "orthographic") {
    camera.kind = CameraKind::orthographic;
  } else if (kind != "perspective") {
    parameters.ignore_the_rest();
    reader.messages.warning(
        parameters.source(),
        fmt::format("{} is not supported yet; a perspective camera of 90 degrees is used", parameters.what()));
    return add_camera(reader, camera, parameters.source());
  }
  if (camera.kind == CameraKind::perspective) {
    const double fov_deg = parameters.positive("fov", 90);
    if (fov_deg < 180) {
      camera.fov_deg = static_cast<float>(fov_deg);
    } else {
      parameters.error("fov", fmt::format("'fov' is {}, but must be below 180 degrees", fov_deg));
    }
  }
  camera.screen_window = screen_window(parameters);
  camera.lens_radius = static_cast<float>(parameters.number_from("lensradius", 0, 0));
  camera.focal_distance = static_cast<float>(parameters.positive("focaldistance", 1e6));
  const double open = parameters.number("shutteropen", 0), close = parameters.number("shutterclose", 1);
  if (close > open) {
    reader.exposure_seconds = close - open;
  } else {
    parameters.error("shutterclose", fmt::format("the shutter closes at {} s but opens at {} s", close, open));
  }
  add_camera(reader, camera, parameters.source());
}

void default_camera(Reader& reader, Source source) {
  if (!reader.camera.is_null()) return;
  reader.messages.warning(source, "there is no Camera; a perspective one of 90 degrees is used");
  add_camera(reader, Camera{.fov_deg = 90, .focal_distance = 1e6f}, source);
}

void read_film(Reader& reader, std::string_view kind, Parameters& parameters) {
  reader.scene.settings.band_count = 0;  // the last Film counts
  if (kind == "spectral") {
    const int buckets = parameters.integer("nbuckets", 16, 1);
    const double from_nm = parameters.number("lambdamin", 360), to_nm = parameters.number("lambdamax", 830);
    reader.scene.settings.band_count = std::min(static_cast<uint32_t>(buckets), max_band_count);
    reader.messages.note_once(
        "spectral film", parameters.source(),
        fmt::format("{}: {} bands from {} to {} nm are recorded, not {} from {} to {} nm", parameters.what(),
                    reader.scene.settings.band_count, band_min_nm, band_max_nm, buckets, from_nm, to_nm));
  } else if (kind != "rgb") {
    parameters.ignore_the_rest();
    reader.messages.warning(
        parameters.source(),
        fmt::format("{} is not supported yet; its size and exposure are used, it records R G B", parameters.what()));
  }
  reader.scene.settings.width = static_cast<uint32_t>(parameters.integer("xresolution", 1280, 1));
  reader.scene.settings.height = static_cast<uint32_t>(parameters.integer("yresolution", 720, 1));
  reader.iso = parameters.positive("iso", 100);
  if (parameters.string("sensor", "cie1931") != "cie1931") {
    parameters.unsupported("sensor", "cie1931 is used");
  }
  if (parameters.number("whitebalance", 0) != 0) parameters.unsupported("whitebalance", "the picture is not balanced");
  if (!parameters.string("filename", "").empty()) {
    reader.messages.note_once("filename", parameters.source(),
                              "Film's 'filename' is not used: outputs are named after the scene, or by -o");
  }
  parameters.unsupported("cropwindow", "the whole picture is rendered");
  parameters.unsupported("pixelbounds", "the whole picture is rendered");
  parameters.unsupported("maxcomponentvalue", "samples are not clamped");
  parameters.number("diagonal", 35);  // only the realistic camera's business
  parameters.boolean("savefp16", true);
  if (reader.state.color_space != ColorSpace::srgb) {
    reader.messages.warning_once(
        "film space", parameters.source(),
        fmt::format("pictures in the colour space '{}' are not supported yet; sRGB's primaries are used",
                    color_space_name(reader.state.color_space)));
  }
}

void read_filter(Reader& reader, std::string_view kind, Parameters& parameters) {
  Filter filter{FilterKind::gaussian, 1.5f, 1.5f, 0.5f};
  double radius = 1.5;
  if (kind == "box") {
    filter.kind = FilterKind::box;
    radius = 0.5;
  } else if (kind == "triangle") {
    filter.kind = FilterKind::triangle;
    radius = 2;
  } else if (kind != "gaussian") {
    parameters.ignore_the_rest();
    reader.messages.warning(
        parameters.source(),
        fmt::format("{} is not supported yet; gaussian of radius 1.5 and sigma 0.5 pixels is used", parameters.what()));
    reader.scene.settings.filter = filter;
    return;
  }
  filter.radius_x = static_cast<float>(parameters.positive("xradius", radius));
  filter.radius_y = static_cast<float>(parameters.positive("yradius", radius));
  if (filter.kind == FilterKind::gaussian) filter.sigma = static_cast<float>(parameters.positive("sigma", 0.5));
  reader.scene.settings.filter = filter;
}

void read_sampler(Reader& reader, std::string_view kind, Parameters& parameters) {
  constexpr std::string_view known[] = {"zsobol",      "sobol",      "paddedsobol", "halton",
                                        "independent", "stratified", "pmj02bn"};
  RenderSettings& settings = reader.scene.settings;
  if (std::find(std::begin(known), std::end(known), kind) == std::end(known)) {
    reader.messages.error(parameters.source(),
                          fmt::format("there is no Sampler \"{}\"{}", kind, did_you_mean(kind, known)));
    return parameters.ignore_the_rest();
  }
  if (kind == "stratified") {
    const int64_t samples = int64_t{parameters.integer("xsamples", 4, 1)} * parameters.integer("ysamples", 4, 1);
    constexpr int64_t greatest = int64_t{1} << 30;
    if (samples > greatest) parameters.error("xsamples", fmt::format("{} samples are too many", samples));
    settings.samples_per_pixel = static_cast<uint32_t>(std::min(samples, greatest));
    parameters.boolean("jitter", true);
  } else {
    settings.samples_per_pixel = static_cast<uint32_t>(parameters.integer("pixelsamples", 16, 1));
    if (kind != "independent" && kind != "pmj02bn") parameters.string("randomization", "fastowen");
  }
  settings.seed = static_cast<uint32_t>(parameters.integer("seed", static_cast<int>(settings.seed), 0));
  reader.messages.note_once(
      "sampler", parameters.source(),
      fmt::format("{}: its sample count is used; the points are always Owen-scrambled Sobol points",
                  parameters.what()));
}

void read_integrator(Reader& reader, std::string_view kind, Parameters& parameters) {
  constexpr std::string_view like_path[] = {"path", "volpath", "simplepath", "simplevolpath"};
  constexpr std::string_view other[] = {"bdpt", "mlt",     "sppm", "lightpath", "randomwalk", "ambientocclusion",
                                        "ao",   "function"};
  reader.scene.settings.max_depth = static_cast<uint32_t>(parameters.integer("maxdepth", 5, 0));
  if (std::find(std::begin(like_path), std::end(like_path), kind) != std::end(like_path)) {
    parameters.string("lightsampler", "bvh");  // how lights are chosen changes noise only
    parameters.boolean("samplelights", true);
    parameters.boolean("samplebsdf", true);
    if (parameters.boolean("regularize", false)) parameters.unsupported("regularize", "paths are not regularized");
    return;
  }
  parameters.ignore_the_rest();
  if (std::find(std::begin(other), std::end(other), kind) != std::end(other)) {
    reader.messages.warning(parameters.source(),
                            fmt::format("{} is not supported yet; path tracing is used", parameters.what()));
  } else {
    std::vector<std::string_view> all(std::begin(like_path), std::end(like_path));
    all.insert(all.end(), std::begin(other), std::end(other));
    reader.messages.error(parameters.source(),
                          fmt::format("there is no Integrator \"{}\"{}", kind, did_you_mean(kind, all)));
  }
}

}  // namespace metamer::pbrt
