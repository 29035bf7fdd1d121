// The light "sky": an environment and the sun's disc, generated on reading as two children of the entity.
#include "scenes/sky/sky.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "scenes/native/components.h"
#include "scenes/native/spectra.h"

namespace metamer {
namespace {

// Columns x, y, z: where these axes of the child's space point to.
Transform turned_to(const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& z) {
  Transform t;
  t.row0 = {x.x, y.x, z.x, 0};
  t.row1 = {x.y, y.y, z.y, 0};
  t.row2 = {x.z, y.z, z.z, 0};
  return t;
}

void add_child(SceneContext& context, Entity parent, const Json::Value& value, const Transform& transform,
               const Light& light) {
  Registry& registry = context.scene.registry;
  const Entity child = registry.create();
  registry.set(child, Parent{parent});
  registry.set(child, transform);
  registry.set(child, light);
  registry.set(child, context.source_of(value));
}

// The sun's radiance as the irradiance that a light of that diameter is stated by.
SpectrumId sun_irradiance(SceneContext& context, const SkySettings& settings) {
  Samples samples = sun_radiance(settings.turbidity, settings.sun_elevation_deg);
  for (double& value : samples) value *= sun_projected_solid_angle();
  return context.scene.spectra.add_samples(samples).id;
}

}  // namespace

void read_sky(SceneContext& context, Entity entity, const JsonObject& object) {
  constexpr std::string_view ups[] = {"y", "z"};
  SkySettings settings;
  settings.turbidity = object.number("turbidity", {turbidity_min, turbidity_max}, settings.turbidity);
  settings.sun_elevation_deg = object.number("sun_elevation", {0, 90, true, false}, settings.sun_elevation_deg);
  settings.sun_azimuth_deg = object.number("sun_azimuth", {-360, 360}, settings.sun_azimuth_deg);
  settings.has_sun = object.boolean("sun", true);
  settings.ground_albedo = object.number("ground_albedo", unit_interval, settings.ground_albedo);
  settings.resolution = object.integer("resolution", resolution_min, resolution_max, settings.resolution);
  if (settings.resolution % 2 != 0)
    context.reader.error(*object.find("resolution"),
                         fmt::format("'resolution' is {}; expected an even number, so that the horizon falls between "
                                     "two rows",
                                     settings.resolution));
  const bool is_y_up = object.choice("up", ups, 0) == 0;
  const float scale = object.number_f("scale", not_negative, 1);
  const glm::dvec3 east(1, 0, 0), up = is_y_up ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 north = glm::cross(up, east);
  SkyImage sky = make_sky(settings);
  SpectrumSet& spectra = context.scene.spectra;
  const SpectrumId white = spectra.add_white(sky.image.color_space);
  Light environment;
  environment.kind = LightKind::environment;
  environment.spectrum = spectra.scaled(white, 1 / spectra.luminance(white)).id;
  environment.scale = scale;
  environment.image = static_cast<ImageId>(context.scene.images.size());
  context.scene.images.push_back(std::move(sky.image));
  add_child(context, entity, object.value(), turned_to(east, north, up), environment);
  if (!settings.has_sun) return;
  const glm::dvec3 local = sun_direction(settings);
  const glm::dvec3 towards = east * local.x + north * local.y + up * local.z;
  const glm::dvec3 across = glm::normalize(glm::cross(std::abs(towards.x) > 0.5 ? up : east, towards));
  Light sun;
  sun.kind = LightKind::directional;
  sun.spectrum = sun_irradiance(context, settings);
  sun.scale = scale;
  sun.angular_diameter_deg = static_cast<float>(sun_diameter_deg);
  add_child(context, entity, object.value(), turned_to(across, glm::cross(towards, across), towards), sun);
}

}  // namespace metamer
