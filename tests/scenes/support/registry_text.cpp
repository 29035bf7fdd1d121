#include "tests/scenes/support/registry_text.h"

#include <fmt/format.h>

#include <cmath>

#include "tests/scenes/support/texture_text.h"

namespace metamer {
namespace {

// What is left of a zero after a calculation is one.
float tidy(float x) { return std::abs(x) < 1e-9f ? 0 : x; }

std::string numbers(const glm::vec4& v) {
  return fmt::format("{:.5g} {:.5g} {:.5g} {:.5g}", tidy(v.x), tidy(v.y), tidy(v.z), tidy(v.w));
}

// Where it stands, unless that is the world's own frame, and where it moves.
std::string place(const Scene& scene, Entity entity) {
  const Transform m = scene.registry.get<Transform>(entity), identity;
  const Motion end = scene.registry.get<Motion>(entity);
  std::string text;
  if (m.row0 != identity.row0 || m.row1 != identity.row1 || m.row2 != identity.row2)
    text += fmt::format(" at [{} | {} | {}]", numbers(m.row0), numbers(m.row1), numbers(m.row2));
  if (scene.registry.has<Motion>(entity))
    text += fmt::format(" to [{} | {} | {}] from {:.4g} to {:.4g} s", numbers(end.row0), numbers(end.row1),
                        numbers(end.row2), end.start_time, end.end_time);
  return text;
}

// At 450, 550 and 650 nm; one number where they agree.
std::string spectrum(const Scene& scene, SpectrumId id, double scale = 1) {
  std::string text[3];
  for (int i = 0; i < 3; ++i) text[i] = fmt::format("{:.4g}", scale * scene.spectra.value(id, 450 + 100 * i));
  return text[0] == text[1] && text[1] == text[2] ? text[0] : fmt::format("({} {} {})", text[0], text[1], text[2]);
}

// The textures that stand in place of parameters.
std::string textures_text(const Scene& scene, const Material& m) {
  const std::pair<const char*, TextureId> places[] = {{"reflectance", m.reflectance_texture},
                                                      {"transmittance", m.transmittance_texture},
                                                      {"alpha x", m.alpha_x_texture},
                                                      {"alpha y", m.alpha_y_texture},
                                                      {"base alpha x", m.layer.base_alpha_x_texture},
                                                      {"base alpha y", m.layer.base_alpha_y_texture},
                                                      {"thickness", m.layer.thickness_texture},
                                                      {"asymmetry", m.layer.asymmetry_texture},
                                                      {"albedo", m.layer.albedo_texture},
                                                      {"amount", m.mix.amount_texture},
                                                      {"displacement", m.displacement}};
  std::string text;
  for (const auto& [name, id] : places)
    if (id != no_index) text += fmt::format(", {}: {}", name, texture_text(scene, id));
  if (m.normal_map != no_index)
    text += fmt::format(", normals of {} x {}", scene.images[m.normal_map].width, scene.images[m.normal_map].height);
  return text;
}

std::string medium_text(const Scene& scene, Entity entity) {
  if (entity.is_null()) return "nothing";
  const Medium m = scene.registry.get<Medium>(entity);
  std::string text = fmt::format("medium sigma_a {} sigma_s {}", spectrum(scene, m.sigma_a, double{m.scale}),
                                 spectrum(scene, m.sigma_s, double{m.scale}));
  if (m.g != 0) text += fmt::format(" g {:.4g}", m.g);
  if (scene.spectra.max_value(m.emission) > 0 && m.emission_scale > 0)
    text += fmt::format(" glow {:.4g}", scene.spectra.luminance(m.emission) * double{m.emission_scale});
  if (!scene.registry.has<MediumGrid>(entity)) return text;
  const MediumGrid g = scene.registry.get<MediumGrid>(entity);
  const std::pair<GridId, const char*> grids[] = {{g.density, "density"},
                                                  {g.sigma_a, "sigma_a"},
                                                  {g.sigma_s, "sigma_s"},
                                                  {g.emission, "emission"},
                                                  {g.temperature, "temperature"}};
  for (const auto& [id, name] : grids)
    if (id != no_index) text += fmt::format(" grid of {} mean {:.4g}", name, grid_mean(scene.grids[id]).x);
  return text + fmt::format(" from {:.4g} {:.4g} {:.4g} to {:.4g} {:.4g} {:.4g}", g.lower.x, g.lower.y, g.lower.z,
                            g.upper.x, g.upper.y, g.upper.z);
}

std::string sides_text(const Scene& scene, Entity entity) {
  if (!scene.registry.has<MediumSlot>(entity)) return {};
  const MediumSlot slot = scene.registry.get<MediumSlot>(entity);
  return fmt::format(" between {} and {}", medium_text(scene, slot.inside), medium_text(scene, slot.outside));
}

std::string material_text(const Scene& scene, const Material& m) {
  std::string text;
  switch (m.kind) {
    case MaterialKind::diffuse: text = "diffuse reflectance " + spectrum(scene, m.reflectance); break;
    case MaterialKind::conductor:
      text = fmt::format("conductor eta {} kappa {}", spectrum(scene, m.eta), spectrum(scene, m.kappa));
      break;
    case MaterialKind::dielectric: text = "dielectric eta " + spectrum(scene, m.eta); break;
    case MaterialKind::coated:
      text = fmt::format("coated reflectance {} eta {}", spectrum(scene, m.reflectance), spectrum(scene, m.eta));
      break;
    case MaterialKind::layered:
      text = m.layer.base == LayerBase::diffuse
                 ? "coat over reflectance " + spectrum(scene, m.reflectance)
                 : fmt::format("coat over eta {} kappa {} alpha {:.4g} {:.4g}", spectrum(scene, m.layer.base_eta),
                               spectrum(scene, m.layer.base_kappa), m.layer.base_alpha_x, m.layer.base_alpha_y);
      text += fmt::format(", layer eta {} thickness {:.4g} albedo {} asymmetry {:.4g} depth {} walks {}",
                          spectrum(scene, m.eta), m.layer.thickness, spectrum(scene, m.layer.albedo), m.layer.asymmetry,
                          m.layer.max_depth, m.layer.walks);
      break;
    case MaterialKind::diffuse_transmission:
      text = fmt::format("reflectance {} transmittance {}", spectrum(scene, m.reflectance),
                         spectrum(scene, m.transmittance));
      break;
    case MaterialKind::mix:
      text = fmt::format("{:.4g} of ({}) in ({})", m.mix.amount,
                         material_text(scene, scene.registry.get<Material>(m.mix.second)),
                         material_text(scene, scene.registry.get<Material>(m.mix.first)));
      break;
    case MaterialKind::hair:
      text = fmt::format("hair eta {} sigma_a {} beta {:.4g} {:.4g} tilt {:.4g}", spectrum(scene, m.eta),
                         spectrum(scene, m.hair.sigma_a), m.hair.beta_m, m.hair.beta_n, m.hair.tilt_deg);
      break;
    default: text = fmt::format("material of kind {}", static_cast<uint32_t>(m.kind));
  }
  if (m.alpha_x != 0 || m.alpha_y != 0) text += fmt::format(" alpha {:.4g} {:.4g}", m.alpha_x, m.alpha_y);
  if (m.thin != 0) text += " thin";
  return text + textures_text(scene, m);
}

std::string light_text(const Scene& scene, const Light& light) {
  constexpr std::string_view names[] = {"area",        "point",       "spot",      "directional",
                                        "environment", "goniometric", "projection"};
  std::string text = fmt::format("{} light of {:.4g}", names[static_cast<size_t>(light.kind)],
                                 scene.spectra.luminance(light.spectrum) * static_cast<double>(light.scale));
  if (light.two_sided != 0) text += " two-sided";
  if (light.kind == LightKind::spot)
    text += fmt::format(" cone {:.4g} falloff {:.4g}", light.cone_deg, light.falloff_deg);
  if (light.kind == LightKind::projection) text += fmt::format(" fov {:.4g}", light.fov_deg);
  if (light.is_power != 0) text += " in all";
  if (light.has_portal != 0)
    text += fmt::format(" through {:.4g} {:.4g} {:.4g} and along {:.4g} {:.4g} {:.4g} and {:.4g} {:.4g} {:.4g}",
                        light.portal_corner.x, light.portal_corner.y, light.portal_corner.z, light.portal_x.x,
                        light.portal_x.y, light.portal_x.z, light.portal_y.x, light.portal_y.y, light.portal_y.z);
  if (light.image != no_index)
    text += fmt::format(" image {} x {}", scene.images[light.image].width, scene.images[light.image].height);
  return text;
}

std::string shape_text(const Scene& scene, Entity entity) {
  const Geometry g = scene.registry.get<Geometry>(entity);
  std::string text;
  if (g.kind == ShapeKind::sphere) {
    text = fmt::format("sphere radius {:.5g}", g.radius);
  } else if (g.kind == ShapeKind::disk) {
    text = fmt::format("disk radius {:.5g} {:.5g} height {:.5g}", g.inner_radius, g.radius, g.height);
  } else if (g.kind == ShapeKind::mesh) {
    const Mesh& mesh = scene.meshes[g.mesh];
    text = fmt::format("mesh {} vertices {} triangles{}{}", mesh.positions.size(), mesh.indices.size() / 3,
                       mesh.normals.empty() ? "" : " normals", mesh.uvs.empty() ? "" : " uvs");
  } else if (g.kind == ShapeKind::cylinder) {
    text = fmt::format("cylinder radius {:.5g}", g.radius);
  } else {
    constexpr std::string_view names[] = {"flat", "ribbon", "round"};
    const Curves& curves = scene.curves[g.curves];
    text = fmt::format("{} curves of {} segments from {} to {}",
                       names[static_cast<size_t>(g.kind) - static_cast<size_t>(ShapeKind::flat_curves)],
                       curves.segments.size(), numbers(curves.points[0]),
                       numbers(curves.points[curves.points.size() - 1]));
  }
  if (std::isfinite(g.z_min) || std::isfinite(g.z_max)) text += fmt::format(" z {:.4g} to {:.4g}", g.z_min, g.z_max);
  if (g.phi_max_deg != 360) text += fmt::format(" phi {:.4g}", g.phi_max_deg);
  if (g.flip_normal != 0) text += " flipped";
  if (g.alpha_texture != no_index) text += ", alpha: " + texture_text(scene, g.alpha_texture);
  text += place(scene, entity);
  const Entity material = scene.registry.get<MaterialSlot>(entity).material;
  if (scene.registry.has<MaterialSlot>(entity))
    text += " of " + material_text(scene, scene.registry.get<Material>(material));
  text += sides_text(scene, entity);
  if (scene.registry.has<Light>(entity)) text += ", " + light_text(scene, scene.registry.get<Light>(entity));
  return text;
}

std::string camera_text(const Scene& scene, Entity entity) {
  const Camera c = scene.registry.get<Camera>(entity);
  std::string text = c.kind == CameraKind::perspective       ? fmt::format("perspective camera fov {:.5g}", c.fov_deg)
                     : c.kind == CameraKind::orthographic    ? std::string("orthographic camera")
                     : c.mapping == ImageMapping::equal_area ? std::string("spherical camera, equal areas")
                                                             : std::string("spherical camera");
  if (c.lens_radius != 0) text += fmt::format(" lens {:.5g}", c.lens_radius);
  if (c.focal_distance != 1e6f && c.kind != CameraKind::spherical)
    text += fmt::format(" focus {:.5g}", c.focal_distance);
  if (c.screen_window != glm::vec4(0)) text += " window " + numbers(c.screen_window);
  return text + sides_text(scene, entity) + place(scene, entity);
}

}  // namespace

std::vector<std::string> registry_text(const Scene& scene) {
  std::vector<std::string> lines;
  const auto add = [&](Entity entity, const std::string& text) {
    lines.push_back(fmt::format("{}: {}", scene.location(entity).line, text));
  };
  const Registry& registry = scene.registry;
  registry.each<Camera>([&](Entity e, uint32_t) { add(e, camera_text(scene, e)); });
  registry.each<Geometry>([&](Entity e, uint32_t) { add(e, shape_text(scene, e)); });
  registry.each<Light>([&](Entity e, uint32_t) {
    if (!registry.has<Geometry>(e)) add(e, light_text(scene, registry.get<Light>(e)) + place(scene, e));
  });
  return lines;
}

std::string settings_text(const RenderSettings& s) {
  std::string text;
  if (s.width != 1280 || s.height != 720) text += fmt::format(" {} x {} pixels", s.width, s.height);
  if (s.samples_per_pixel != 16) text += fmt::format(" {} samples", s.samples_per_pixel);
  if (s.max_depth != 5) text += fmt::format(" depth {}", s.max_depth);
  if (s.seed != 0) text += fmt::format(" seed {}", s.seed);
  if (s.band_count != 0) text += fmt::format(" {} bands", s.band_count);
  const Filter f = s.filter;
  if (f.kind != FilterKind::gaussian || f.radius_x != 1.5f || f.radius_y != 1.5f || f.sigma != 0.5f)
    text += fmt::format(" filter {} {:.4g} {:.4g} {:.4g}", filter_name(f.kind), f.radius_x, f.radius_y, f.sigma);
  if (f.kind == FilterKind::mitchell) text += fmt::format(" b {:.4g} c {:.4g}", f.b, f.c);
  if (f.kind == FilterKind::sinc) text += fmt::format(" tau {:.4g}", f.tau);
  if (s.crop != glm::dvec4(0, 1, 0, 1))
    text += fmt::format(" crop {:.4g} {:.4g} {:.4g} {:.4g}", s.crop.x, s.crop.y, s.crop.z, s.crop.w);
  if (!s.pixel_jitter) text += " without jitter";
  if (s.shutter_open != 0 || s.shutter_close != 1)
    text += fmt::format(" shutter {:.4g} to {:.4g}", s.shutter_open, s.shutter_close);
  if (s.largest_component < std::numeric_limits<float>::infinity())
    text += fmt::format(" clamp {:.4g}", s.largest_component);
  if (s.white_balance_kelvin != 0) text += fmt::format(" balance {:.4g}", s.white_balance_kelvin);
  if (s.primaries != ColorSpace::srgb) text += fmt::format(" primaries {}", color_space_name(s.primaries));
  if (s.sensor_scale != 1) text += fmt::format(" exposure {:.4g}", s.sensor_scale);
  return text.empty() ? "" : "settings" + text;
}

}  // namespace metamer
