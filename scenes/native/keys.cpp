#include "scenes/native/keys.h"

namespace metamer {
namespace {

constexpr bool required = true;

constexpr KeySpec scene[] = {{"$schema"},           {"metamer", required}, {"units"}, {"settings"}, {"spectra"},
                             {"textures"},          {"materials"},         {"media"}, {"meshes"},   {"curves"},
                             {"entities", required}};
constexpr KeySpec settings[] = {
    {"size"},          {"samples"},  {"max_depth"},    {"seed"},         {"integrator"},        {"shadows"},
    {"filter"},        {"exposure"}, {"sensor_scale"}, {"spectral"},     {"largest_component"}, {"white_balance"},
    {"primaries"},     {"color"},    {"crop"},         {"pixel_jitter"}, {"shutter"},           {"occlusion_distance"},
    {"clamp_indirect"}};
constexpr KeySpec filter_box[] = {{"type", required}, {"radius"}};
constexpr KeySpec filter_triangle[] = {{"type", required}, {"radius"}};
constexpr KeySpec filter_gaussian[] = {{"type", required}, {"radius"}, {"sigma"}};
constexpr KeySpec filter_mitchell[] = {{"type", required}, {"radius"}, {"b"}, {"c"}};
constexpr KeySpec filter_sinc[] = {{"type", required}, {"radius"}, {"tau"}};
constexpr KeySpec spectrum[] = {{"constant"}, {"table"}, {"named"},   {"blackbody"}, {"daylight"}, {"rgb"},
                                {"space"},    {"scale"}, {"samples"}, {"sigmoid"},   {"times"}};
constexpr KeySpec texture_reference[] = {{"texture", required}};
constexpr KeySpec texture_constant[] = {{"type", required}, {"value", required}, {"number"}};
constexpr KeySpec texture_image[] = {{"type", required}, {"image", required}, {"encoding"}, {"space"},
                                     {"wrap"},           {"filter"},          {"scale"},    {"invert"},
                                     {"mapping"},        {"number"},          {"channel"},  {"anisotropy"}};
constexpr KeySpec texture_checkerboard[] = {{"type", required}, {"a"}, {"b"}, {"mapping"}, {"number"}};
constexpr KeySpec texture_scale[] = {{"type", required}, {"a", required}, {"b"}, {"number"}};
constexpr KeySpec texture_mix[] = {{"type", required}, {"a", required}, {"b", required}, {"amount"}, {"number"}};
constexpr KeySpec texture_square_root[] = {{"type", required}, {"a", required}};
constexpr KeySpec texture_coordinate[] = {{"type", required}, {"axis"}, {"mapping"}};
constexpr KeySpec texture_facing[] = {{"type", required}, {"direction"}};
constexpr KeySpec texture_dots[] = {{"type", required}, {"mapping"}};
constexpr KeySpec texture_noise[] = {{"type", required}, {"octaves"}, {"roughness"}, {"mapping"}};
constexpr KeySpec texture_windy[] = {{"type", required}, {"mapping"}};
constexpr KeySpec texture_marble[] = {{"type", required}, {"scale"},     {"variation"},
                                      {"octaves"},        {"roughness"}, {"mapping"}};
constexpr KeySpec mapping_uv[] = {{"type", required}, {"scale"}, {"offset"}};
constexpr KeySpec mapping_in_space[] = {{"type", required}, {"to_texture"}};
constexpr KeySpec mapping_planar[] = {{"type", required}, {"to_texture"}, {"u_axis"}, {"v_axis"}, {"offset"}};
constexpr KeySpec material_diffuse[] = {
    {"type", required}, {"reflectance", required}, {"displacement"}, {"normal_map"}};
constexpr KeySpec material_rough[] = {{"type", required}, {"kd"},           {"ks"},        {"shininess"},
                                      {"normalized"},     {"displacement"}, {"normal_map"}};
constexpr KeySpec material_coated[] = {
    {"type", required}, {"reflectance", required}, {"glass"},     {"eta"}, {"roughness"},
    {"fresnel"},        {"displacement"},          {"normal_map"}};
constexpr KeySpec material_layered[] = {
    {"type", required}, {"reflectance"},     {"base_metal"}, {"base_eta"},  {"base_kappa"},
    {"base_roughness"}, {"glass"},           {"eta"},        {"roughness"}, {"optical_thickness"},
    {"albedo"},         {"asymmetry"},       {"max_depth"},  {"walks"},     {"displacement"},
    {"normal_map"},     {"base_reflectance"}};
constexpr KeySpec material_diffuse_transmission[] = {
    {"type", required}, {"reflectance", required}, {"transmittance", required}, {"displacement"}, {"normal_map"}};
constexpr KeySpec material_hair[] = {{"type", required}, {"sigma_a"}, {"reflectance"},  {"beta_m"},    {"beta_n"},
                                     {"tilt"},           {"eta"},     {"displacement"}, {"normal_map"}};
constexpr KeySpec material_mix[] = {{"type", required}, {"first", required}, {"second", required}, {"amount"}};
constexpr KeySpec material_conductor[] = {{"type", required}, {"metal"},      {"eta"},
                                          {"kappa"},          {"roughness"},  {"fresnel"},
                                          {"displacement"},   {"normal_map"}, {"reflectance"}};
constexpr KeySpec material_dielectric[] = {{"type", required}, {"glass"},        {"eta"},       {"kappa"},
                                           {"roughness"},      {"fresnel"},      {"priority"},  {"thin"},
                                           {"thickness"},      {"displacement"}, {"normal_map"}};
constexpr KeySpec material_smooth[] = {{"type", required}, {"metal"},        {"glass"},     {"n"},
                                       {"kappa"},          {"fresnel"},      {"priority"},  {"thin"},
                                       {"thickness"},      {"displacement"}, {"normal_map"}};
constexpr KeySpec material_mirror[] = {{"type", required}};
constexpr KeySpec material_interface[] = {{"type", required}};
constexpr KeySpec medium_homogeneous[] = {{"type", required}, {"sigma_a"}, {"sigma_s"}, {"albedo"},   {"sigma_t"},
                                          {"scale"},          {"g"},       {"g2"},      {"g2_share"}, {"emission"},
                                          {"emission_scale"}};
constexpr KeySpec medium_of_grids[] = {
    {"type", required}, {"sigma_a"}, {"sigma_s"},      {"albedo"},       {"sigma_t"},
    {"scale"},          {"g"},       {"g2"},           {"g2_share"},     {"emission"},
    {"emission_scale"}, {"density"}, {"sigma_a_grid"}, {"sigma_s_grid"}, {"emission_grid"},
    {"temperature"},    {"lookup"},  {"box"},          {"transform"}};
constexpr KeySpec medium_grid[] = {{"file"}, {"grid"}, {"space"}, {"noise"}};
constexpr KeySpec temperature_grid[] = {{"file"}, {"grid"}, {"noise"}, {"offset"}, {"scale"}, {"normalized"}};
constexpr KeySpec noise[] = {{"seed"}, {"octaves"}, {"roughness"},  {"frequency"},
                             {"bias"}, {"falloff"}, {"resolution"}, {"box"}};
constexpr KeySpec entity_media[] = {{"inside"}, {"outside"}};
constexpr KeySpec mesh[] = {{"file"}, {"positions"}, {"indices"}, {"normals"}, {"uvs"}};
constexpr KeySpec entity[] = {{"name"},     {"parent"}, {"transform"}, {"motion"},     {"geometry"},
                              {"material"}, {"light"},  {"camera"},    {"visibility"}, {"media"}};
constexpr KeySpec transform[] = {{"matrix"}, {"translate"}, {"rotate"}, {"scale"}, {"look_at"}};
constexpr KeySpec rotate[] = {{"axis", required}, {"degrees", required}};
constexpr KeySpec look_at[] = {{"from", required}, {"to", required}, {"up"}};
constexpr KeySpec geometry_mesh[] = {{"type", required}, {"mesh", required}, {"flip_normal"}, {"alpha"}};
constexpr KeySpec curves[] = {{"points", required}, {"widths", required}, {"segments"}, {"normals"}};
constexpr KeySpec geometry_sphere[] = {{"type", required}, {"radius"},      {"z_min"}, {"z_max"},
                                       {"phi_max"},        {"flip_normal"}, {"alpha"}};
constexpr KeySpec geometry_disk[] = {{"type", required}, {"radius"},      {"inner_radius"}, {"height"},
                                     {"phi_max"},        {"flip_normal"}, {"alpha"}};
constexpr KeySpec geometry_cylinder[] = {{"type", required}, {"radius"},      {"z_min"}, {"z_max"},
                                         {"phi_max"},        {"flip_normal"}, {"alpha"}};
constexpr KeySpec geometry_curves[] = {{"type", required}, {"curves", required}, {"kind"}, {"flip_normal"}, {"alpha"}};
constexpr KeySpec geometry_rectangle[] = {{"type", required}, {"width"}, {"depth"}, {"flip_normal"}, {"alpha"}};
constexpr KeySpec light_area[] = {{"type", required}, {"radiance"}, {"luminance"}, {"nits"},  {"lumens"}, {"spectrum"},
                                  {"cosine_power"},   {"scale"},    {"two_sided"}, {"power"}, {"image"},  {"space"}};
constexpr KeySpec light_point[] = {{"type", required}, {"intensity"}, {"candela"}, {"lumens"}, {"spectrum"}, {"scale"}};
constexpr KeySpec light_spot[] = {{"type", required}, {"intensity"},  {"candela"},       {"lumens"},
                                  {"spectrum"},       {"cone_angle"}, {"falloff_start"}, {"scale"}};
constexpr KeySpec light_directional[] = {{"type", required}, {"irradiance"},       {"lux"},
                                         {"spectrum"},       {"angular_diameter"}, {"scale"}};
constexpr KeySpec light_environment[] = {{"type", required}, {"radiance"}, {"luminance"}, {"nits"},  {"spectrum"},
                                         {"scale"},          {"image"},    {"mapping"},   {"space"}, {"portal"}};
constexpr KeySpec light_goniometric[] = {{"type", required}, {"intensity"},       {"candela"}, {"lumens"}, {"spectrum"},
                                         {"scale"},          {"image", required}, {"mapping"}, {"space"}};
constexpr KeySpec light_projection[] = {{"type", required}, {"intensity"},       {"candela"}, {"lumens"}, {"spectrum"},
                                        {"scale"},          {"image", required}, {"fov"},     {"space"}};
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
                                {"filter.mitchell", filter_mitchell},
                                {"filter.sinc", filter_sinc},
                                {"spectrum", spectrum},
                                {"texture_reference", texture_reference},
                                {"texture.constant", texture_constant},
                                {"texture.image", texture_image},
                                {"texture.checkerboard", texture_checkerboard},
                                {"texture.scale", texture_scale},
                                {"texture.mix", texture_mix},
                                {"texture.coordinate", texture_coordinate},
                                {"texture.facing", texture_facing},
                                {"texture.dots", texture_dots},
                                {"texture.fbm", texture_noise},
                                {"texture.wrinkled", texture_noise},
                                {"texture.windy", texture_windy},
                                {"texture.marble", texture_marble},
                                {"mapping.uv", mapping_uv},
                                {"mapping.spherical", mapping_in_space},
                                {"mapping.cylindrical", mapping_in_space},
                                {"mapping.planar", mapping_planar},
                                {"mapping.point", mapping_in_space},
                                {"texture.square_root", texture_square_root},
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
                                {"material.interface", material_interface},
                                {"medium.homogeneous", medium_homogeneous},
                                {"medium.grid", medium_of_grids},
                                {"medium_grid", medium_grid},
                                {"temperature_grid", temperature_grid},
                                {"noise", noise},
                                {"entity_media", entity_media},
                                {"mesh", mesh},
                                {"curves", curves},
                                {"entity", entity},
                                {"transform", transform},
                                {"rotate", rotate},
                                {"look_at", look_at},
                                {"geometry.mesh", geometry_mesh},
                                {"geometry.sphere", geometry_sphere},
                                {"geometry.disk", geometry_disk},
                                {"geometry.cylinder", geometry_cylinder},
                                {"geometry.curves", geometry_curves},
                                {"geometry.rectangle", geometry_rectangle},
                                {"light.area", light_area},
                                {"light.point", light_point},
                                {"light.spot", light_spot},
                                {"light.directional", light_directional},
                                {"light.environment", light_environment},
                                {"light.goniometric", light_goniometric},
                                {"light.projection", light_projection},
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
