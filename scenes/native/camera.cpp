#include "scenes/native/components.h"

namespace metamer {

std::optional<Camera> read_camera(const SceneContext& context, const Json::Value& value) {
  constexpr Range field_of_view{0, 180, true, true};
  const JsonObject object(context.reader, value, "camera");
  if (!object.is_valid()) return std::nullopt;
  Camera camera;
  if (object.type() == "perspective") {
    camera.kind = CameraKind::perspective;
    camera.fov_deg = object.number_f("fov", field_of_view, camera.fov_deg);
  } else if (object.type() == "spherical") {
    constexpr std::array<std::string_view, 2> mappings = {"latitude_longitude", "equal_area"};
    camera.kind = CameraKind::spherical;
    camera.mapping = static_cast<ImageMapping>(object.choice("mapping", mappings, 0));
    return camera;
  } else {
    camera.kind = CameraKind::orthographic;
    camera.screen_height = context.metres(object.number("screen_height", positive, 2));
  }
  camera.lens_radius = context.metres(object.number("lens_radius", not_negative, 0));
  camera.focal_distance = context.metres(object.number("focal_distance", positive, 1));
  if (const Json::Value* window = object.find("screen_window")) {
    std::array<double, 4> w{-1, 1, -1, 1};
    context.reader.numbers(*window, "screen_window", any_number, w);
    if (!(w[0] < w[1] && w[2] < w[3]))
      context.reader.error(*window, "'screen_window' is empty; expected [x_min, x_max, y_min, y_max] that ascend");
    for (size_t i = 0; i < 4; ++i) camera.screen_window[static_cast<int>(i)] = static_cast<float>(w[i]);
  }
  return camera;
}

Visibility read_visibility(const SceneContext& context, const Json::Value& value) {
  const JsonObject object(context.reader, value, *find_object_spec("visibility"), "visibility");
  Visibility visibility;
  if (!object.is_valid()) return visibility;
  visibility.mask = (object.boolean("camera", true) ? visible_to_camera : 0) |
                    (object.boolean("bounces", true) ? visible_to_bounces : 0) |
                    (object.boolean("shadows", true) ? visible_to_shadows : 0);
  return visibility;
}

}  // namespace metamer
