// What is not in the world: camera, sampler, integrator.
#include <fmt/format.h>

#include <glm/matrix.hpp>

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

// The time in between is the exposure; what moves is seen all along.
void read_shutter(Reader& reader, Parameters& parameters) {
  const double open = parameters.number("shutteropen", 0), close = parameters.number("shutterclose", 1);
  if (!(close > open)) {
    return parameters.error("shutterclose", fmt::format("the shutter closes at {} s but opens at {} s", close, open));
  }
  reader.exposure_seconds = close - open;
  reader.scene.settings.shutter_open = open;
  reader.scene.settings.shutter_close = close;
}

Camera spherical_camera(Parameters& parameters) {
  constexpr std::string_view mappings[] = {"equalarea", "equirectangular"};
  Camera camera{.kind = CameraKind::spherical, .mapping = ImageMapping::equal_area};
  const std::string mapping = parameters.string("mapping", "equalarea");
  if (mapping == "equirectangular") {
    camera.mapping = ImageMapping::latitude_longitude;
  } else if (mapping != "equalarea") {
    parameters.error("mapping", fmt::format("there is no mapping \"{}\"{}", mapping, did_you_mean(mapping, mappings)));
  }
  // It has no lens and no screen; pbrt takes these, too.
  for (const std::string_view name : {"lensradius", "focaldistance", "frameaspectratio"}) parameters.number(name, 0);
  parameters.array("screenwindow", ParameterType::real, 1);
  return camera;
}

void add_camera(Reader& reader, const Camera& camera, Source source) {
  if (!reader.camera.is_null()) reader.scene.registry.destroy(reader.camera);
  reader.camera = reader.scene.registry.create();
  TransformPair camera_to_world{affine_inverse(reader.state.transform), affine_inverse(reader.state.end_transform)};
  if (!reader.state.transforms().moves()) camera_to_world.end = camera_to_world.start;
  for (glm::dmat4* m : {&camera_to_world.start, &camera_to_world.end}) {
    const std::string_view mistake = transform_mistake(*m);
    if (mistake.empty()) continue;
    reader.messages.error(source, fmt::format("the inverse of the camera's transformation is {}", mistake));
    camera_to_world = {glm::dmat4(1), glm::dmat4(1)};
  }
  reader.coordinate_systems["camera"] = camera_to_world;
  set_place(reader, reader.camera, camera_to_world);
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
  read_shutter(reader, parameters);
  if (kind == "orthographic") {
    camera.kind = CameraKind::orthographic;
  } else if (kind == "spherical") {
    return add_camera(reader, spherical_camera(parameters), parameters.source());
  } else if (kind == "realistic") {
    parameters.ignore_the_rest();
    reader.messages.warning(parameters.source(), fmt::format("{} is not supported; a perspective camera of 90 degrees "
                                                             "is used: give it the lens's 'fov' instead",
                                                             parameters.what()));
    return add_camera(reader, camera, parameters.source());
  } else if (kind != "perspective") {
    constexpr std::string_view known[] = {"perspective", "orthographic", "spherical", "realistic"};
    parameters.ignore_the_rest();
    reader.messages.error(parameters.source(),
                          fmt::format("there is no Camera \"{}\"{}", kind, did_you_mean(kind, known)));
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
  add_camera(reader, camera, parameters.source());
}

void default_camera(Reader& reader, Source source) {
  if (!reader.camera.is_null()) return;
  reader.messages.warning(source, "there is no Camera; a perspective one of 90 degrees is used");
  add_camera(reader, Camera{.fov_deg = 90, .focal_distance = 1e6f}, source);
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
      fmt::format("{}: its sample count is used; the points are always Owen-scrambled Sobol points", parameters.what()),
      Strict::allows);
}

namespace {

// What a file may say, and what is done: nothing else, the same light found in another way, or another picture.
enum class Instead : uint8_t { nothing, same_light, path };
struct KnownIntegrator {
  std::string_view name;
  Instead instead;
};
constexpr KnownIntegrator known_integrators[] = {{"path", Instead::nothing},
                                                 {"volpath", Instead::nothing},
                                                 {"simplepath", Instead::nothing},
                                                 {"simplevolpath", Instead::nothing},
                                                 {"bdpt", Instead::same_light},
                                                 {"mlt", Instead::same_light},
                                                 {"sppm", Instead::same_light},
                                                 {"lightpath", Instead::same_light},
                                                 {"randomwalk", Instead::same_light},
                                                 {"ambientocclusion", Instead::nothing},
                                                 {"ao", Instead::nothing},
                                                 {"function", Instead::path}};

void read_ambient_occlusion(Parameters& parameters, RenderSettings& settings) {
  settings.integrator = Integrator::ambient_occlusion;
  parameters.boolean("cossample", true);  // noise only
  if (parameters.has("maxdistance"))
    settings.occlusion_distance = static_cast<float>(parameters.positive("maxdistance", 1));
}

}  // namespace

void read_integrator(Reader& reader, std::string_view kind, Parameters& parameters) {
  const auto* known = std::find_if(std::begin(known_integrators), std::end(known_integrators),
                                   [&](const KnownIntegrator& i) { return i.name == kind; });
  if (known == std::end(known_integrators)) {
    std::vector<std::string_view> all;
    for (const KnownIntegrator& integrator : known_integrators) all.push_back(integrator.name);
    reader.messages.error(parameters.source(),
                          fmt::format("there is no Integrator \"{}\"{}", kind, did_you_mean(kind, all)));
    return parameters.ignore_the_rest();
  }
  RenderSettings& settings = reader.scene.settings;
  settings.integrator = Integrator::path;
  if (kind == "ambientocclusion" || kind == "ao") return read_ambient_occlusion(parameters, settings);
  settings.max_depth = static_cast<uint32_t>(parameters.integer("maxdepth", 5, 0));
  if (known->instead == Instead::nothing) {
    parameters.string("lightsampler", "bvh");  // how lights are chosen changes noise only
    parameters.boolean("samplelights", true);
    parameters.boolean("samplebsdf", true);
    if (parameters.boolean("regularize", false)) parameters.unsupported("regularize", "paths are not regularized");
    return;
  }
  parameters.ignore_the_rest();
  if (known->instead == Instead::same_light) {
    reader.messages.note_once(
        "integrator", parameters.source(),
        fmt::format("{} is not supported; path tracing looks for the same light", parameters.what()));
  } else {
    reader.messages.warning(parameters.source(),
                            fmt::format("{} is not supported; path tracing is used", parameters.what()));
  }
}

}  // namespace metamer::pbrt
