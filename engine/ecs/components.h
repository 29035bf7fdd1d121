// What an entity can have. Plain data with units; handles (32-bit indices) instead of pointers.
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>

#include "engine/ecs/registry.h"
#include "engine/ecs/texture.h"

namespace metamer {

using SpectrumId = uint32_t;  // a row of Scene::spectra
using MeshId = uint32_t;      // an index into Scene::meshes
using CurvesId = uint32_t;    // an index into Scene::curves
using ImageId = uint32_t;     // an index into Scene::images
using NameId = uint32_t;      // an index into Scene::names
using GridId = uint32_t;      // an index into Scene::grids

// Local to parent: the first three rows of an affine matrix, points as columns. Mirrors and non-uniform scales
// are allowed; a singular one is the user's mistake.
struct Transform {
  glm::vec4 row0{1, 0, 0, 0}, row1{0, 1, 0, 0}, row2{0, 0, 1, 0};
  static constexpr auto fields = std::make_tuple(&Transform::row0, &Transform::row1, &Transform::row2);
};

// The entity moves: its Transform holds at `start_time`, this one at `end_time` (seconds, start before end). In between
// the translation, the rotation and what is left of the matrix go their ways one by one (systems/build_motion.h);
// before and after it stands still.
struct Motion {
  glm::vec4 row0{1, 0, 0, 0}, row1{0, 1, 0, 0}, row2{0, 0, 1, 0};
  float start_time = 0, end_time = 1;
  static constexpr auto fields =
      std::make_tuple(&Motion::row0, &Motion::row1, &Motion::row2, &Motion::start_time, &Motion::end_time);
};

struct Parent {
  Entity entity;
  static constexpr auto fields = std::make_tuple(&Parent::entity);
};

enum class ShapeKind : uint32_t { mesh, sphere, disk, rectangle, cylinder, flat_curves, ribbons, round_curves };
constexpr bool is_curves(ShapeKind kind) { return kind >= ShapeKind::flat_curves; }

// A shape in its local space, metres.
//   mesh       `mesh`; several entities may name one mesh: they share it as instances
//   sphere     around the origin, `radius`, what of it is between `z_min` and `z_max`
//   disk       in the plane z = `height`, normal +z, `inner_radius` to `radius`
//   cylinder   around the z axis, `radius`, from `z_min` to `z_max`, which differ; open, normal outwards
//   rectangle  in the plane z = 0, normal +z, `width` along x and `depth` along y, centred
//   sphere, disk and cylinder reach from the x axis counter-clockwise around z to `phi_max_deg`
//   flat_curves, ribbons, round_curves  `curves`; they emit no light
//     flat     turned to whoever looks along the width; the outside is the side seen
//     ribbons  turned as their normals say, which name the outside
//     round    flat, too, but with the normals of a tube
struct Geometry {
  ShapeKind kind = ShapeKind::mesh;
  MeshId mesh = no_index;
  float radius = 1, inner_radius = 0, height = 0, width = 1, depth = 1;
  uint32_t flip_normal = 0;            // 1: the side an area light emits to, and the normal, are the other one
  TextureId alpha_texture = no_index;  // a number: the chance that a ray meets the surface at all; none: 1
  float z_min = -std::numeric_limits<float>::infinity(), z_max = std::numeric_limits<float>::infinity();
  float phi_max_deg = 360;  // above 0
  CurvesId curves = no_index;
  static constexpr auto fields =
      std::make_tuple(&Geometry::kind, &Geometry::mesh, &Geometry::radius, &Geometry::inner_radius, &Geometry::height,
                      &Geometry::width, &Geometry::depth, &Geometry::flip_normal, &Geometry::alpha_texture,
                      &Geometry::z_min, &Geometry::z_max, &Geometry::phi_max_deg, &Geometry::curves);
};

enum class MaterialKind : uint32_t {
  diffuse,
  conductor,
  dielectric,
  rough,
  coated,
  smooth,
  layered,
  diffuse_transmission,
  mix,
  hair,
  interface
};
enum class FresnelModel : uint32_t { exact, schlick };

inline constexpr uint32_t largest_priority = 255;

// diffuse: `reflectance`. conductor: `eta`, `kappa`, GGX roughness. dielectric: `eta` inside against the outside,
// `kappa` below refracting_kappa, GGX roughness. `alpha_x`, `alpha_y` are GGX slopes' widths (not remapped); below 1e-3
// a mirror. smooth: `eta`, `kappa` of any size, on each wavelength a dielectric or a conductor as kappa decides.
// `alpha_x_texture`, `alpha_y_texture`: numbers in the place of `alpha_x` and `alpha_y`, of a conductor or dielectric
// that then is rough everywhere, or of a layered material. The `reflectance_texture` of a conductor, also of one under
// a layer, stands for eta 1 and the kappa of that reflectance along the normal. `displacement`: a number, metres along
// the normal, that bends the shading normal; so does `normal_map`, whose red, green and blue are (1 + n) / 2 of a
// normal along dp/du, across it and along the normal. `priority`: paths keep track of being inside (a dielectric with
// kappa and anything smooth has 1 at least); `eta` is then against vacuum, and where solids overlap the one of the
// higher priority fills the space. `thin`: a slab of `thickness` whose two faces are one surface; no inside. rough:
// diffuse `kd` plus Phong-Blinn `ks`, `shininess` (see systems/bsdf/rough-inl.h); as taught, both in sr^-1 and without
// a bound, or `normalized`, both albedos. coated: diffuse `reflectance` under a clear coat of index `eta` and one GGX
// width, alpha_x = alpha_y. interface: nothing to see; only the media on its two sides differ. layered: pbrt's coat
// (systems/bsdf/coat_layer.h): a surface of index `eta` and GGX roughness over a `layer` and a `base`.
// diffuse_transmission: `reflectance` and `transmittance`, both lambertian. mix: of two other entities' materials.
// hair: `eta` and what `hair` says; `reflectance_texture`: the colour of much of it, in place of `sigma_a`.
enum class LayerBase : uint32_t { diffuse, conductor };
struct Layer {
  LayerBase base = LayerBase::diffuse;       // diffuse: the material's `reflectance`; conductor:
  SpectrumId base_eta = 0, base_kappa = 0;   // against vacuum
  float base_alpha_x = 0, base_alpha_y = 0;  // GGX
  float thickness = 0.01f;  // optical: exp(-thickness) is left of light that crosses it along the normal
  SpectrumId albedo = 0;    // of what scatters in it, 0 to 1
  float asymmetry = 0;      // mean cosine of that scattering, -1 to 1
  uint32_t max_depth = 10;  // scatterings inside of the coat, one at a boundary included
  uint32_t walks = 1;       // averaged where the sum over ways through the layer is not closed
  // In place of the numbers, and of `albedo`.
  TextureId base_alpha_x_texture = no_index, base_alpha_y_texture = no_index;
  TextureId thickness_texture = no_index, albedo_texture = no_index, asymmetry_texture = no_index;
};
struct Mix {
  Entity first, second;
  float amount = 0.5f;                  // of the second, 0 to 1
  TextureId amount_texture = no_index;  // a number in its place
};
struct Hair {
  SpectrumId sigma_a = 0;  // absorption, per radius of the fibre
  float beta_m = 0.3f, beta_n = 0.3f, tilt_deg = 2;
};
struct Material {
  MaterialKind kind = MaterialKind::diffuse;
  SpectrumId reflectance = 0;
  TextureId reflectance_texture = no_index;  // in place of `reflectance`
  TextureId alpha_x_texture = no_index, alpha_y_texture = no_index;
  TextureId displacement = no_index;
  ImageId normal_map = no_index;
  SpectrumId eta = 0, kappa = 0;
  float alpha_x = 0, alpha_y = 0;
  FresnelModel fresnel = FresnelModel::exact;
  SpectrumId kd = 0, ks = 0;
  float shininess = 0;
  uint32_t normalized = 0;  // 1: the reciprocal form that conserves energy
  uint32_t priority = 0;    // up to largest_priority; 0: not followed; the index is against whatever is around
  uint32_t thin = 0;
  float thickness = 0;  // metres; of a thin one with kappa
  Layer layer{};
  SpectrumId transmittance = 0;
  TextureId transmittance_texture = no_index;  // in place of `transmittance`
  Mix mix{};
  Hair hair{};
  static constexpr auto fields = std::make_tuple(
      &Material::kind, &Material::reflectance, &Material::reflectance_texture, &Material::alpha_x_texture,
      &Material::alpha_y_texture, &Material::displacement, &Material::normal_map, &Material::eta, &Material::kappa,
      &Material::alpha_x, &Material::alpha_y, &Material::fresnel, &Material::kd, &Material::ks, &Material::shininess,
      &Material::normalized, &Material::priority, &Material::thin, &Material::thickness, &Material::layer,
      &Material::transmittance, &Material::transmittance_texture, &Material::mix, &Material::hair);
};

// The entity whose Material covers this entity's surface. Without a slot (and without a Material of its own) a
// surface is diffuse with reflectance 0.5.
struct MaterialSlot {
  Entity material;
  static constexpr auto fields = std::make_tuple(&MaterialSlot::material);
};

enum class LightKind : uint32_t { area, point, spot, directional, environment, goniometric, projection };

// area         emitted radiance along the normal, W m^-2 sr^-1 nm^-1, of the entity's Geometry, on the side of the
//              normal or both; at the angle theta to it cos^cosine_power theta times that. With `is_power` the power of
//              the whole shape instead, W nm^-1
// point        intensity, W sr^-1 nm^-1, at the entity's origin
// spot         intensity along the entity's -z axis, all of it up to `falloff_deg` from the axis, none beyond
// `cone_deg` goniometric  intensity times `image`, which covers the sphere around the entity's origin, +z up projection
// intensity times `image`, thrown as a camera would take it: along the entity's +z axis, +y up, +x to the
//              right of the image, `fov_deg` over its shorter side; none outside
// directional  irradiance on a plane facing it, W m^-2 nm^-1; light travels along the entity's -z axis, from one
//              direction or evenly from a disc of `angular_diameter_deg`
// environment  radiance from infinity, times `image` if there is one, +z up; there may be several. With `has_portal` it
//              is seen through a rectangle in world space only, along the cross product of `portal_x` and `portal_y`
// Images are linear RGB of Scene::images.
struct Light {
  LightKind kind = LightKind::area;
  SpectrumId spectrum = 0;
  float scale = 1;
  uint32_t two_sided = 0;
  ImageId image = no_index;
  float cosine_power = 0;                // 0: the same radiance in all directions
  uint32_t is_power = 0;                 // 1: `spectrum` is the power of the shape
  float cone_deg = 30, falloff_deg = 0;  // half angles, 0 <= falloff_deg <= cone_deg <= 180
  float angular_diameter_deg = 0;        // below 180; 0: parallel light
  float fov_deg = 90;                    // above 0 and below 180
  uint32_t has_portal = 0;
  glm::vec3 portal_corner{0}, portal_x{1, 0, 0}, portal_y{0, 1, 0};  // metres; the edges are perpendicular
  static constexpr auto fields = std::make_tuple(
      &Light::kind, &Light::spectrum, &Light::scale, &Light::two_sided, &Light::image, &Light::cosine_power,
      &Light::is_power, &Light::cone_deg, &Light::falloff_deg, &Light::angular_diameter_deg, &Light::fov_deg,
      &Light::has_portal, &Light::portal_corner, &Light::portal_x, &Light::portal_y);
};

enum class CameraKind : uint32_t { perspective, orthographic, spherical };
// How the sphere of directions becomes a rectangle or a square.
enum class ImageMapping : uint32_t { latitude_longitude, equal_area };

// Looks along its local +z, +y up, +x to the RIGHT of the picture (left-handed camera space, as pbrt's; the
// transform to the right-handed world mirrors). Spherical cameras see all directions (a, b, c) in their axes x, y, z,
// by latitude and longitude: (sin t cos p, cos t, sin t sin p) at p = 2 pi u, t = pi v of the picture's u, v from its
// upper left corner; or by equal areas, the same with y and z exchanged (see systems/environment-inl.h).
struct Camera {
  CameraKind kind = CameraKind::perspective;
  float fov_deg = 45;                   // over the shorter side of the picture; perspective only
  float screen_height = 2;              // metres over the shorter side; orthographic only
  float lens_radius = 0;                // metres; 0 is a pinhole
  float focal_distance = 1;             // metres along +z
  glm::vec4 screen_window{0, 0, 0, 0};  // x_min x_max y_min y_max on the plane of unit half-height; all 0: default
  ImageMapping mapping = ImageMapping::latitude_longitude;  // spherical only
  static constexpr auto fields =
      std::make_tuple(&Camera::kind, &Camera::fov_deg, &Camera::screen_height, &Camera::lens_radius,
                      &Camera::focal_distance, &Camera::screen_window, &Camera::mapping);
};

struct Name {
  NameId name = no_index;
  static constexpr auto fields = std::make_tuple(&Name::name);
};

// Which rays see the entity.
inline constexpr uint32_t visible_to_camera = 1, visible_to_bounces = 2, visible_to_shadows = 4, visible_to_all = 7;
struct Visibility {
  uint32_t mask = visible_to_all;
  static constexpr auto fields = std::make_tuple(&Visibility::mask);
};

// What fills space between surfaces, absorbs, scatters and glows. Per metre of the world: `sigma_a`, `sigma_s`, times
// `scale`. `g` is Henyey and Greenstein's mean cosine, -1 < g < 1, positive: forward; of a share `g2_share`, 0 to 1, of
// what is scattered it is `g2`. `emission` times `emission_scale`
// is radiance, W m^-2 sr^-1 nm^-1: a metre of it adds sigma_a times as much.
struct Medium {
  SpectrumId sigma_a = 0, sigma_s = 0;
  float scale = 1;
  float g = 0, g2 = 0, g2_share = 0;
  SpectrumId emission = 0;
  float emission_scale = 1;
  static constexpr auto fields =
      std::make_tuple(&Medium::sigma_a, &Medium::sigma_s, &Medium::scale, &Medium::g, &Medium::g2, &Medium::g2_share,
                      &Medium::emission, &Medium::emission_scale);
};

// Between the centres of voxels: trilinear, or one of the eight around, by chance, with the trilinear weights.
enum class GridLookup : uint32_t { trilinear, stochastic };
// What a temperature grid glows with: Planck's law as it is, W m^-2 sr^-1 nm^-1, or divided by its peak.
enum class BlackbodyUnit : uint32_t { radiance, peak };

// How the Medium of the same entity varies in space: factors on it, from grids in the entity's local space; nothing
// outside the box from `lower` to `upper`. Handles are no_index where there is no grid; media may share theirs.
// `density` multiplies both sigmas, `sigma_a` and `sigma_s` (one number per voxel, or unbounded RGB) each its own;
// `emission` (one or three) multiplies what glows. Without `temperature` that is the medium's emission; with it a
// blackbody of (T - temperature_offset) temperature_scale kelvin, in `blackbody`'s unit, nothing at or below 100 K. The
// medium's `scale` and `emission_scale` hold in any case.
struct MediumGrid {
  GridId density = no_index, sigma_a = no_index, sigma_s = no_index;
  GridId emission = no_index, temperature = no_index;
  glm::vec3 lower{0, 0, 0}, upper{1, 1, 1};
  float temperature_offset = 0, temperature_scale = 1;
  BlackbodyUnit blackbody = BlackbodyUnit::radiance;
  GridLookup lookup = GridLookup::trilinear;
  static constexpr auto fields =
      std::make_tuple(&MediumGrid::density, &MediumGrid::sigma_a, &MediumGrid::sigma_s, &MediumGrid::emission,
                      &MediumGrid::temperature, &MediumGrid::lower, &MediumGrid::upper, &MediumGrid::temperature_offset,
                      &MediumGrid::temperature_scale, &MediumGrid::blackbody, &MediumGrid::lookup);
};

// Entities with a Medium on both sides of a surface: a ray that crosses it is in that of the side it goes to, whatever
// it was in before. A null entity is vacuum. Where both are the same, or without a slot, rays keep what they are in. Of
// a camera, `outside` is what its rays start in.
struct MediumSlot {
  Entity inside, outside;
  static constexpr auto fields = std::make_tuple(&MediumSlot::inside, &MediumSlot::outside);
};

// Where the user said it, for messages.
struct Source {
  NameId file = no_index;
  uint32_t line = 0;
  static constexpr auto fields = std::make_tuple(&Source::file, &Source::line);
};

using Registry = BasicRegistry<Transform, Motion, Parent, Geometry, Material, MaterialSlot, Light, Camera, Name,
                               Visibility, Medium, MediumGrid, MediumSlot, Source>;

}  // namespace metamer
