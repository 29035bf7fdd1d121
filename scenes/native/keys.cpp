#include "scenes/native/keys.h"

namespace metamer {
namespace {

constexpr bool required = true;

constexpr KeySpec scene[] = {{"$schema"}, {"metamer", required}, {"units"},  {"settings"},
                             {"spectra"}, {"materials"},         {"meshes"}, {"entities", required}};
constexpr KeySpec settings[] = {{"size"},    {"samples"}, {"max_depth"},    {"seed"},         {"integrator"},
                                {"shadows"}, {"filter"},  {"exposure"},     {"sensor_scale"}, {"spectral"},
                                {"color"},   {"crop"},    {"pixel_jitter"}, {"shutter"}};
constexpr KeySpec filter_box[] = {{"type", required}, {"radius"}};
constexpr KeySpec filter_triangle[] = {{"type", required}, {"radius"}};
constexpr KeySpec filter_gaussian[] = {{"type", required}, {"radius"}, {"sigma"}};
constexpr KeySpec spectrum[] = {{"constant"}, {"table"}, {"named"}, {"blackbody"},
                                {"daylight"}, {"rgb"},   {"space"}, {"scale"}};
constexpr KeySpec material_diffuse[] = {{"type", required}, {"reflectance", required}};
constexpr KeySpec material_rough[] = {{"type", required}, {"kd"}, {"ks"}, {"shininess"}, {"normalized"}};
constexpr KeySpec material_coated[] = {{"type", required}, {"reflectance", required}, {"glass"}, {"eta"}, {"roughness"},
                                       {"fresnel"}};
constexpr KeySpec material_layered[] = {
    {"type", required}, {"reflectance"}, {"base_metal"}, {"base_eta"},  {"base_kappa"},
    {"base_roughness"}, {"glass"},       {"eta"},        {"roughness"}, {"optical_thickness"},
    {"albedo"},         {"asymmetry"},   {"max_depth"},  {"walks"}};
constexpr KeySpec material_diffuse_transmission[] = {
    {"type", required}, {"reflectance", required}, {"transmittance", required}};
constexpr KeySpec material_hair[] = {
    {"type", required}, {"sigma_a", required}, {"beta_m"}, {"beta_n"}, {"tilt"}, {"eta"}};
constexpr KeySpec material_mix[] = {{"type", required}, {"first", required}, {"second", required}, {"amount"}};
constexpr KeySpec material_conductor[] = {{"type", required}, {"metal"},     {"eta"},
                                          {"kappa"},          {"roughness"}, {"fresnel"}};
constexpr KeySpec material_dielectric[] = {{"type", required}, {"glass"},    {"eta"},  {"kappa"},    {"roughness"},
                                           {"fresnel"},        {"priority"}, {"thin"}, {"thickness"}};
constexpr KeySpec material_smooth[] = {{"type", required}, {"metal"},    {"glass"}, {"n"},        {"kappa"},
                                       {"fresnel"},        {"priority"}, {"thin"},  {"thickness"}};
constexpr KeySpec material_mirror[] = {{"type", required}};
constexpr KeySpec mesh[] = {{"file"}, {"positions"}, {"indices"}, {"normals"}, {"uvs"}};
constexpr KeySpec entity[] = {{"name"},     {"parent"}, {"transform"}, {"motion"},    {"geometry"},
                              {"material"}, {"light"},  {"camera"},    {"visibility"}};
constexpr KeySpec transform[] = {{"matrix"}, {"translate"}, {"rotate"}, {"scale"}, {"look_at"}};
constexpr KeySpec rotate[] = {{"axis", required}, {"degrees", required}};
constexpr KeySpec look_at[] = {{"from", required}, {"to", required}, {"up"}};
constexpr KeySpec geometry_mesh[] = {{"type", required}, {"mesh", required}, {"flip_normal"}};
constexpr KeySpec geometry_sphere[] = {{"type", required}, {"radius"}, {"flip_normal"}};
constexpr KeySpec geometry_disk[] = {{"type", required}, {"radius"}, {"inner_radius"}, {"height"}, {"flip_normal"}};
constexpr KeySpec geometry_rectangle[] = {{"type", required}, {"width"}, {"depth"}, {"flip_normal"}};
constexpr KeySpec light_area[] = {{"type", required}, {"radiance"},     {"luminance"}, {"nits"},     {"lumens"},
                                  {"spectrum"},       {"cosine_power"}, {"scale"},     {"two_sided"}};
constexpr KeySpec light_point[] = {{"type", required}, {"intensity"}, {"candela"}, {"lumens"}, {"spectrum"}, {"scale"}};
constexpr KeySpec light_spot[] = {{"type", required}, {"intensity"},  {"candela"},       {"lumens"},
                                  {"spectrum"},       {"cone_angle"}, {"falloff_start"}, {"scale"}};
constexpr KeySpec light_directional[] = {{"type", required}, {"irradiance"},       {"lux"},
                                         {"spectrum"},       {"angular_diameter"}, {"scale"}};
constexpr KeySpec light_environment[] = {{"type", required}, {"radiance"}, {"luminance"}, {"nits"}, {"spectrum"},
                                         {"scale"},          {"image"},    {"mapping"},   {"space"}};
constexpr KeySpec light_sky[] = {{"type", required}, {"turbidity"}, {"sun_elevation"},
                                 {"sun_azimuth"},    {"sun"},       {"ground_albedo"},
                                 {"resolution"},     {"up"},        {"scale"}};
constexpr KeySpec camera_perspective[] = {
    {"type", required}, {"fov"}, {"lens_radius"}, {"focal_distance"}, {"screen_window"}};
constexpr KeySpec camera_orthographic[] = {
    {"type", required}, {"screen_height"}, {"lens_radius"}, {"focal_distance"}, {"screen_window"}};
constexpr KeySpec camera_spherical[] = {{"type", required}, {"mapping"}};
constexpr KeySpec motion[] = {{"end", required}, {"times"}};
constexpr KeySpec visibility[] = {{"camera"}, {"bounces"}, {"shadows"}};

constexpr ObjectSpec specs[] = {{"scene", scene},
                                {"settings", settings},
                                {"filter.box", filter_box},
                                {"filter.triangle", filter_triangle},
                                {"filter.gaussian", filter_gaussian},
                                {"spectrum", spectrum},
                                {"material.diffuse", material_diffuse},
                                {"material.rough", material_rough},
                                {"material.coated", material_coated},
                                {"material.layered", material_layered},
                                {"material.diffuse_transmission", material_diffuse_transmission},
                                {"material.hair", material_hair},
                                {"material.mix", material_mix},
                                {"material.conductor", material_conductor},
                                {"material.dielectric", material_dielectric},
                                {"material.smooth", material_smooth},
                                {"material.mirror", material_mirror},
                                {"mesh", mesh},
                                {"entity", entity},
                                {"transform", transform},
                                {"rotate", rotate},
                                {"look_at", look_at},
                                {"geometry.mesh", geometry_mesh},
                                {"geometry.sphere", geometry_sphere},
                                {"geometry.disk", geometry_disk},
                                {"geometry.rectangle", geometry_rectangle},
                                {"light.area", light_area},
                                {"light.point", light_point},
                                {"light.spot", light_spot},
                                {"light.directional", light_directional},
                                {"light.environment", light_environment},
                                {"light.sky", light_sky},
                                {"camera.perspective", camera_perspective},
                                {"camera.orthographic", camera_orthographic},
                                {"camera.spherical", camera_spherical},
                                {"motion", motion},
                                {"visibility", visibility}};

}  // namespace

std::span<const ObjectSpec> all_object_specs() { return specs; }

const ObjectSpec* find_object_spec(std::string_view name) {
  for (const ObjectSpec& spec : specs)
    if (spec.name == name) return &spec;
  return nullptr;
}

}  // namespace metamer
