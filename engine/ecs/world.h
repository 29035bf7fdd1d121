// The frozen scene: flat, read-only columns for the systems. Made by systems/freeze from a Scene.
#pragma once
#include <array>
#include <memory>

#include "engine/ecs/scene.h"
#include "engine/ecs/volume_grids.h"
#include "engine/sampling/distribution.h"
#include "engine/sampling/window_distribution.h"
#include "engine/simd/column.h"
#include "engine/streams.h"

namespace metamer {

// Surfaces by object: a triangle mesh, one quadric, or curves.
struct ObjectColumns {
  Column<uint32_t> kind;            // ShapeKind (rectangles are meshes here)
  Column<uint32_t> first_triangle;  // into World::triangle_vertices, or curve_segments; unused by quadrics
  Column<uint32_t> triangle_count;  // or of segments
  Column<uint32_t> shade_kind;      // ShadeKind, or mixed_kind
  Column<uint32_t> material;        // row in the table of that kind, of mixed_kind in World::mixes
  Column<uint32_t> first_light;     // light row of the first triangle, or no_index
  Column<uint32_t> placement;       // row in World::placements; 0 is the identity: vertices are in world space
  Column<uint32_t> visibility;      // mask of rays that see it
  Column<uint32_t> volume_inside, volume_outside;  // rows of World::volumes; keeps_volume in both: as before
  Column<uint32_t> first_key;                      // into World::motion_keys; unused by what stands still
  Column<uint32_t> key_count;  // 0: it stands still; else 2 or more, evenly spaced over the time of the shutter
  Column<uint32_t> alpha;      // program of TextureSet: the chance that a ray meets it; no_index: 1
  size_t size() const { return kind.size(); }
};

// Placed quadrics, curves and instances: rows of an affine matrix and its inverse, and a quadric's own numbers.
struct Placement {
  float to_world[12];   // row-major 3x4
  float to_object[12];  // its inverse
  float radius = 0, inner_radius = 0;
  float z_min = 0, z_max = 0;  // a disk's are both its height; a sphere's are infinite where it is not cut
  float normal_sign = 1;       // -1: the outside is the other side
  // Counter-clockwise from the x axis, radians; the largest float not above 2 pi: all around.
  float phi_max = 0, cos_phi_max = 1, sin_phi_max = 0;
};
static_assert(sizeof(Placement) == 32 * sizeof(float));

// Where a moving object is at one time: rows of an affine matrix. Between two keys matrices are interpolated linearly.
struct MotionKey {
  float to_world[12];  // row-major 3x4
  float padding[4] = {};
};
static_assert(sizeof(MotionKey) == 16 * sizeof(float));

struct DiffuseColumns {
  Column<uint32_t> reflectance;  // SpectrumId
  Column<uint32_t> texture;      // program of TextureSet in its place, or no_index
};
struct DiffuseTransmissionColumns {
  Column<uint32_t> reflectance, transmittance;                  // SpectrumId
  Column<uint32_t> reflectance_texture, transmittance_texture;  // programs of TextureSet in their place, or no_index
};
struct RoughColumns {
  Column<uint32_t> kd, ks;  // SpectrumId
  Column<float> shininess;
  Column<uint32_t> normalized;  // 1: the reciprocal form
};
// Two of these: coats with a smooth surface and with a rough one. See systems/bsdf/coat_albedo.h for the table.
struct CoatedColumns {
  Column<uint32_t> reflectance, eta;  // SpectrumId
  Column<uint32_t> texture;           // program of TextureSet in place of `reflectance`, or no_index
  Column<float> alpha_x, alpha_y;
  Column<float> thickness, hits;  // of the layer, optical; of the base, negative: without end
  Column<uint32_t> schlick;
  Column<uint32_t> first_row, row_stride, last_pair;  // of `albedos`
  Column<float> eta_least, rows_per_eta;
  Column<float> albedos;  // the table: what the surfaces reflect by themselves
};
// pbrt's coats that have no closed form: see systems/bsdf/layered-inl.h.
struct LayeredColumns {
  Column<float> eta, alpha_x, alpha_y;       // of the layer against the outside, of its surface
  Column<float> thickness, asymmetry;        // optical; mean cosine of what scatters in it
  Column<float> max_depth, walks;            // whole numbers
  Column<uint32_t> albedo, scatters;         // SpectrumId, and whether it is above 0 anywhere
  Column<uint32_t> conductor;                // 1: the base is one, else diffuse
  Column<uint32_t> reflectance, texture;     // of a diffuse base, as CoatedColumns
  Column<uint32_t> base_eta, base_kappa;     // SpectrumId, against vacuum
  Column<float> base_alpha_x, base_alpha_y;  // 0 where smooth
  // Programs of TextureSet in their place, or no_index. `texture` is also a conductor's, as in ConductorColumns.
  Column<uint32_t> alpha_texture[2], base_alpha_texture[2];
  Column<uint32_t> thickness_texture, asymmetry_texture, albedo_texture;
};
// See systems/bsdf/hair.h.
struct HairColumns {
  Column<float> eta, variance, width;
  std::array<Column<float>, 3> sin_tilt, cos_tilt;
  Column<uint32_t> sigma_a;         // SpectrumId
  Column<uint32_t> texture;         // program of TextureSet, no_index: none. Its colour stands for sigma_a
  Column<float> absorption_of_log;  // sigma_a = (that times log(colour))^2
};
struct ConductorColumns {
  Column<uint32_t> eta, kappa;  // SpectrumId
  Column<uint32_t> texture;     // program of TextureSet, no_index: none. Its reflectance stands for eta and kappa
  Column<float> alpha_x, alpha_y;
  Column<uint32_t> alpha_texture[2];  // programs in place of alpha_x and alpha_y, or no_index
  Column<uint32_t> schlick;           // 1: Schlick's approximation
};
// Everything that light enters, smooth, rough or thin.
struct DielectricColumns {
  Column<uint32_t> eta, kappa;  // SpectrumId; eta against vacuum where `medium` is not 0, else against the outside
  Column<uint32_t> schlick;
  Column<uint32_t> dispersive;        // 1: wavelengths part in refraction: eta differs, or some are opaque
  Column<uint32_t> partly_opaque;     // 1: kappa reaches refracting_kappa on some wavelengths
  Column<uint32_t> medium;            // row of World::media that is inside; 0: not followed
  Column<float> alpha_x, alpha_y;     // rough ones
  Column<uint32_t> alpha_texture[2];  // programs in place of alpha_x and alpha_y, or no_index
  Column<float> thickness;            // metres; thin ones
  Column<uint32_t> is_absolute;       // thin ones: eta is against vacuum
};
// Which of two materials a hit is of: the second with the chance `amount`. A kind may be mixed_kind again.
struct MixRow {
  uint32_t kind[2] = {}, row[2] = {};
  float amount = 0;
  uint32_t amount_texture = no_index;  // program of TextureSet in its place
};
inline constexpr uint32_t keeps_volume = 0xffffffffu;  // in place of a row of volumes: what was there before

// What paths remember being inside of. Row 0 is the vacuum, of priority 0; all others have 1 at least.
struct MediumColumns {
  Column<uint32_t> eta, kappa;  // SpectrumId
  Column<uint32_t> priority;    // where solids overlap, the highest fills the space
  Column<uint32_t> dispersive;
  // Row of VolumeColumns that fills the solid where no other of higher priority does, by the sides of its surface;
  // keeps_volume: nothing of its own.
  Column<uint32_t> volume;
};
// A path's media, highest priority first: four rows of 16 bits, the first in the low half of [0].
inline constexpr uint32_t media_stack_size = 4, largest_medium = 0xffff;

// What fills space between surfaces (component Medium), beside the optics of solids in MediumColumns. Row 0 is empty.
struct VolumeColumns {
  Column<uint32_t> sigma_a, sigma_s;  // SpectrumId, per metre, times `scale`
  Column<uint32_t> emission;          // SpectrumId, W m^-2 sr^-1 nm^-1, times `emission_scale`
  Column<float> scale, emission_scale, g, g2, g2_share;
  Column<uint32_t> scatters;  // 0: rays go straight through, whatever is absorbed on the way
  Column<uint32_t> grid;  // row of World::grid_volumes: the coefficients are multiplied by grids; no_index: they hold
};
// Beside those of component Visibility: shadow rays that look for the interfaces on their way.
inline constexpr uint32_t visible_to_crossings = 8;

// A light that can be chosen: one triangle or quadric, a point, a direction or a disc of directions, or an
// environment.
enum class LightShape : uint32_t {
  triangle,
  sphere,
  ellipsoid,  // and parts of spheres
  disk,
  cylinder,
  point,  // shapes before this one have an area
  spot,
  goniometric,
  projection,
  directional,
  distant_disk,
  environment
};
// Abstract lights have no extent: nothing runs into them, and one direction is all there is to sample.
constexpr bool is_abstract(LightShape shape) { return shape >= LightShape::point && shape <= LightShape::directional; }
struct LightRow {
  uint32_t shape = 0;  // LightShape
  uint32_t spectrum = 0;
  float scale = 0;
  uint32_t two_sided = 0;
  float choice_probability = 0;
  // triangle: a vertex and two edges. sphere, ellipsoid, disk: centre, and `axes`. cylinder: of the circle at z_min.
  // point, spot, goniometric, projection: position.
  // directional, distant_disk: the direction towards the (centre of the) light.
  float p[3] = {};
  // triangle: two edges. quadrics: world images of the local x, y, z axes (times the radius; a cylinder's z times its
  // height).
  // spot: 1 - cos of the cone's half angle; 1 / (its difference to that where the falloff starts).
  // distant_disk: 1 - cos of the half angle. projection: half the image's width and height at unit distance.
  float axes[9] = {};
  // triangle, disk: unit normal of the emitting side. spot: unit direction of its axis. sphere, ellipsoid: least and
  // greatest z on the unit sphere it is the image of, and how much of a turn around z. cylinder: [2] the same.
  float normal[3] = {};
  float area = 0;  // m^2
  // sphere, ellipsoid, cylinder: rows of the inverse of `axes` as columns. disk: [0] how much of a turn. goniometric,
  // projection: world to local. triangle: uv of the first vertex, and what the others' have more, where it has an
  // image.
  float inverse[9] = {};
  union {
    float normal_sign = 1;  // sphere, ellipsoid, cylinder: -1 emits inwards
    float inner;            // disk: inner radius / radius
    uint32_t mapping;       // goniometric: ImageMapping
  };
  float cosine_power = 0;  // shapes with an area: radiance goes with cos^cosine_power
};
static_assert(sizeof(LightRow) == 32 * sizeof(float));
// Who finds a light: light samples and rays that run into it; samples alone (no bounced ray sees it); or rays alone
// (whether it is there differs from point to point).
enum class LightFinding : uint32_t { both, samples, rays };

// An image that is a factor on a light's spectrum: RGB fitted to spectra. nearest: the texel, as pbrt-v4 reads images
// of equal areas. linear: between the texels' centres, clamped at the image's edges, or around the circle in u.
enum class ImageLookup : uint32_t { nearest, linear, linear_around };
struct LightImage {
  uint32_t first_texel = 0, width = 0, height = 0;
  uint32_t lookup = 0;         // ImageLookup
  uint32_t source = no_index;  // ImageId: rows of one image share its texels
  float weight = 1;            // integral of its luminance over the directions it is sent to, sr; on a shape its mean
  uint32_t padding[2] = {};
};
static_assert(sizeof(LightImage) == 8 * sizeof(uint32_t));
struct LightImages {
  Column<LightImage> rows;
  // Four per texel: sigmoid coefficients c0 c1 c2 and scale; in RGB mode the texel's three coefficients and 0.
  Column<float> texels;
  bool has_coefficients = false;
};

// A rectangle by which the light of an environment enters.
struct Portal {
  // Rows: unit vectors along the width, along the height, and through it, against the light.
  float frame[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  float corner[3] = {};
  float width = 0, height = 0;  // metres; 0: there is no portal
  // Of directions, by the angles that their projections on the frame's xz and yz planes make with z, each from -pi / 2
  // to pi / 2 as 0 to 1: lines of a window's edges are lines of constant angle.
  WindowDistribution density;
};

// Radiance from infinity: a spectrum, and where there is an image, times that.
struct Environment {
  uint32_t light = no_index;  // its row of lights
  uint32_t image = no_index;  // its row of images
  ImageMapping mapping = ImageMapping::latitude_longitude;
  Distribution2D density;  // over the image's square, proportional to the texels' luminance times the measure
  float to_world[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // rotation, row-major; to_local is its inverse
  float to_local[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  Portal portal;
  bool has_portal() const { return portal.width > 0; }
};

// A pixel coordinate (x, y), y down, is seen along direction = normalize(axis + x right + y down) from `origin`
// (perspective), or along `axis` from origin + x right + y down (orthographic). Spherical: right, axis, down are the
// camera's x, y and z axes, and (x x_step, y y_step) a place in the unit square.
struct CameraRow {
  CameraKind kind = CameraKind::perspective;
  float origin[3] = {}, axis[3] = {}, right[3] = {}, down[3] = {};
  float lens_x[3] = {}, lens_y[3] = {};  // world vectors of the lens radius
  float lens_radius = 0, focal_distance = 1;
  float forward[3] = {};  // unit depth along the camera's axis, for the plane of focus
  ImageMapping mapping = ImageMapping::latitude_longitude;  // spherical only
  float x_step = 0, y_step = 0;
  // How wide a texture lookup is: radians seen from `origin`, plus metres. The camera as the shutter opens.
  float footprint_angle = 0, footprint_width = 0;
};
// What of a CameraRow moves, in its order; interpolated linearly like MotionKey.
struct CameraKey {
  float origin[3] = {}, axis[3] = {}, right[3] = {}, down[3] = {}, lens_x[3] = {}, lens_y[3] = {}, forward[3] = {};
  float padding[11] = {};
};
static_assert(sizeof(CameraKey) == 32 * sizeof(float));

// How many of a path's four wavelengths carry light. In RGB mode they are the channels' three, see color_mode.h.
inline uint32_t live_wavelengths(const RenderSettings& settings) {
  return settings.color == ColorMode::spectral ? 4 : 3;
}

inline constexpr uint32_t blackbody_steps = 4096;
inline constexpr double blackbody_coldest = 100, blackbody_hottest = 1e6;  // kelvin

// Embree's scene: known to build_accelerator, intersect and shadow only.
struct Accelerator;

struct World {
  ObjectColumns objects;
  Column<float> positions;             // three per vertex, and one of padding at the end
  Column<float> normals;               // three per vertex; (0, 0, 0): use the geometric one
  Column<float> uvs;                   // two per vertex; NaN: (0, 0), (1, 0), (1, 1) on every triangle, as in pbrt
  Column<uint32_t> triangle_vertices;  // three per triangle
  Column<float> curve_points;          // four per point: x y z and half of the width
  Column<float> curve_normals;         // three per point, and padding; empty where there are no ribbons
  Column<uint32_t> curve_segments;     // the first of four points of each
  Column<float> curve_u;               // two per segment: where it begins along its curve's segment, and how long it is
  Column<Placement> placements;
  Column<MotionKey> motion_keys;
  DiffuseColumns diffuse;
  DiffuseTransmissionColumns diffuse_transmission;
  RoughColumns rough;
  CoatedColumns smooth_coated, rough_coated;
  LayeredColumns layered;
  HairColumns hair;
  ConductorColumns conductor;
  DielectricColumns dielectric;
  Column<MixRow> mixes;
  MediumColumns media;
  uint32_t camera_media[2] = {0, 0};  // the stack that paths start with
  VolumeColumns volumes;
  uint32_t camera_volume = 0;  // the row of volumes that paths start in
  GridColumns grids;
  std::vector<GridVolume> grid_volumes;
  Column<float> majorants;  // two per cell, x fastest: the majorant, and what is there at least in the same unit
  // In the modes of coefficients: three for blackbodies of unit peak, blackbody_steps times from blackbody_coldest to
  // blackbody_hottest, evenly in the temperature's logarithm. Empty where no grid holds temperatures.
  Column<float> blackbody_coefficients;
  Column<LightRow> lights;
  Column<uint32_t> image_of_light;  // its row of images, or no_index
  LightImages light_images;
  Column<uint32_t> light_finding;       // LightFinding by row of lights
  std::vector<uint32_t> distant_disks;  // the rows of lights of that shape: rays that leave the scene run into them
  Distribution1D light_choice;          // over the rows of lights that are sampled; empty where there is none
  // The same of points that shine, spots and the like, where `path` finds them also by their angles from a ray through
  // a homogeneous volume; empty where there are none, or no such volume.
  Distribution1D positional_choice;
  Column<uint32_t> summed_lights;  // rows of abstract lights that are summed one by one (local, recursive), not sampled
  std::vector<Environment> environments;  // rays that leave the scene run into all of them
  TextureSet textures;
  SpectrumId ambient_light = zero_spectrum;  // radiance of what ambient_occlusion sees
  float indirect_limit =
      std::numeric_limits<float>::infinity();  // RenderSettings::clamp_indirect in units of Slots::radiance
  // By kind and row: what bends the shading normal. A program of TextureSet, or their number plus a row of normal_maps;
  // no_index: nothing. Columns end with the last that has one.
  std::array<Column<uint32_t>, shade_kind_count> bumps;
  CameraRow camera;               // as the shutter opens
  Column<CameraKey> camera_keys;  // empty: the camera stands still
  SpectrumSet spectra;
  RenderSettings settings;
  PixelFilter filter;
  std::array<float, 9> sensor_matrix = {};  // on XYZ, row by row; only where the scene has a white balance
  uint32_t branches = 1;        // rays that leave one smooth surface at most: 2 where light is refracted, 5 dispersed
  bool disperses = false;       // some medium's index differs between wavelengths
  bool needs_tangents = false;  // an anisotropic material is present
  bool has_instances = false;   // some triangles are in their object's space
  bool has_quadrics = false;
  bool has_curves = false;
  bool has_motion = false;           // some objects move: paths carry their time
  bool has_interiors = false;        // some material is followed: paths carry their media
  bool has_volumes = false;          // volumes other than the empty one, or interfaces: paths carry what they are in
  bool has_interfaces = false;       // surfaces of ShadeKind::interface
  bool has_grids = false;            // some volume varies in space: shadow rays carry the keys of their paths
  bool shares_paths = false;         // free paths differ between wavelengths: paths carry their shares (PathStream)
  bool has_textured_alpha = false;   // some roughness varies
  bool has_textured_layers = false;  // some layer has textures beside its reflectance
  bool has_bumps = false;
  bool has_mips = false;          // some texture chooses between levels
  bool has_masks = false;         // some object's alpha is not 1
  bool has_portals = false;       // some environment's light depends on where a ray that leaves the scene came from
  bool has_shape_images = false;  // some shape emits an image
  bool has_hair = false;
  bool has_textures() const { return !textures.programs.empty() || !textures.normal_maps.empty(); }
  bool needs_uvs() const { return has_textures() || has_shape_images || has_curves || has_hair; }
  uint64_t zero_area_triangles = 0;
  std::unique_ptr<Accelerator, void (*)(Accelerator*)> accelerator{nullptr, nullptr};
};

}  // namespace metamer
