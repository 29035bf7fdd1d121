#include "scenes/native/write_parts.h"

namespace metamer {
namespace {

class LightWriter {
 public:
  LightWriter(WriteContext& context, const Light& light) : context_(context), light_(light) {}

  JsonText write() {
    switch (light_.kind) {
      case LightKind::area: area(); break;
      case LightKind::point: brightness("point", "intensity"); break;
      case LightKind::spot: spot(); break;
      case LightKind::directional: directional(); break;
      case LightKind::environment: environment(); break;
      case LightKind::goniometric:
        brightness("goniometric", "intensity");
        image(true);
        break;
      case LightKind::projection:
        brightness("projection", "intensity");
        object_.add("fov", JsonText::number(light_.fov_deg));
        image(false);
        break;
    }
    return object_;
  }

 private:
  void brightness(std::string_view type, std::string_view key) {
    object_.add("type", JsonText::string(type));
    object_.add(key, context_.spectra.write(light_.spectrum));
    if (light_.scale != 1) object_.add("scale", JsonText::number(light_.scale));
  }

  void area() {
    brightness("area", light_.is_power != 0 ? "power" : "radiance");
    if (light_.two_sided != 0) object_.add("two_sided", JsonText::boolean(true));
    if (light_.cosine_power != 0) object_.add("cosine_power", JsonText::number(light_.cosine_power));
    image(false);
  }

  void spot() {
    brightness("spot", "intensity");
    object_.add("cone_angle", JsonText::number(light_.cone_deg));
    object_.add("falloff_start", JsonText::number(light_.falloff_deg));
  }

  void directional() {
    brightness("directional", "irradiance");
    if (light_.angular_diameter_deg != 0)
      object_.add("angular_diameter", JsonText::number(light_.angular_diameter_deg));
  }

  void environment() {
    brightness("environment", "radiance");
    image(true);
    if (light_.has_portal == 0) return;
    // Corners that give the same edges as differences, in the order of the reader (systems/portal.h).
    const glm::dvec3 corner(light_.portal_corner), x(light_.portal_x), y(light_.portal_y);
    JsonText corners = JsonText::array();
    for (const glm::dvec3& p : {corner, corner + y, corner + y + x, corner + x})
      corners.add(JsonText::numbers(std::array{p.x, p.y, p.z}));
    object_.add("portal", std::move(corners));
  }

  void image(bool is_sphere) {
    if (light_.image == no_index) return;
    const Image& image = context_.scene.images[light_.image];
    object_.add("image", JsonText::string(context_.folder + "/" + context_.light_image_file(light_.image).name));
    if (is_sphere) object_.add("mapping", JsonText::string(mapping_name(image.mapping)));
    object_.add("space", JsonText::string(color_space_name(image.color_space)));
  }

  WriteContext& context_;
  const Light& light_;
  JsonText object_ = JsonText::object();
};

}  // namespace

std::string_view mapping_name(ImageMapping mapping) {
  switch (mapping) {
    case ImageMapping::latitude_longitude: return "latitude_longitude";
    case ImageMapping::equal_area: return "equal_area";
  }
  return {};
}

JsonText write_light(WriteContext& context, const Light& light) { return LightWriter(context, light).write(); }

}  // namespace metamer
