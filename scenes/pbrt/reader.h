// The state of reading a pbrt file, and the directives' parts. Free functions over one struct: each file here adds to
// the scene what it knows about.
#pragma once
#include <deque>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/ecs/scene.h"
#include "scenes/images/read_image.h"
#include "scenes/pbrt/parameters.h"
#include "scenes/volumes/read_grids.h"

namespace metamer::pbrt {

// What AreaLightSource said, for the shapes that follow.
struct AreaLight {
  bool on = false;
  SpectrumId spectrum = 0;
  double scale = 1;   // includes the division by the spectrum's luminance
  double power = -1;  // per shape, in pbrt's sense, over the image's mean; negative: not given
  ImageId image = no_index;
  bool two_sided = false;
};

// Parameters set by Attribute, in the order of attribute_targets.
inline constexpr std::string_view attribute_targets[] = {"shape", "light", "material", "medium", "texture"};
enum class AttributeTarget : uint8_t { shape, light, material, medium, texture };

// The current transformation at the start and at the end of the motion (TransformTimes).
struct TransformPair {
  glm::dmat4 start{1.0}, end{1.0};
  bool moves() const { return start != end; }
};

struct GraphicsState {
  glm::dmat4 transform{1.0};  // object to world; before WorldBegin world to camera; at the motion's start
  glm::dmat4 end_transform{1.0};
  bool start_time_active = true, end_time_active = true;
  TransformPair transforms() const { return {transform, end_transform}; }
  bool reverse_orientation = false;
  ColorSpace color_space = ColorSpace::srgb;
  Entity material;
  MediumSlot media;
  AreaLight area_light;
  ParameterPointers attributes[std::size(attribute_targets)];  // into Reader::attribute_values; no name twice
};

// Whether a shape would become the same under both: what else comes to belong to a shape has its place here.
inline bool is_shaped_alike(const GraphicsState& a, const GraphicsState& b) {
  return a.transform == b.transform && a.end_transform == b.end_transform &&
         a.reverse_orientation == b.reverse_orientation && a.material == b.material;
}

enum class Block : uint8_t { attribute, transform, object, import };

struct SavedState {
  GraphicsState state;
  Block block;
  Source source;
};

struct NamedMaterial {
  Entity entity;
  Source first_use;
  bool defined = false;
};

struct NamedMedium {
  Entity entity;
  Source first_use;
  bool defined = false;
};

// A shape as it was said, not yet an entity: ObjectInstance makes several of one.
struct ShapeRecord {
  Geometry geometry;
  TransformPair transforms;
  Entity material;
  MediumSlot media;
  Source source;
};

// The curves that the next one may join.
struct OpenCurves {
  CurvesId id = no_index;
  ShapeKind kind = ShapeKind::flat_curves;
  TextureId alpha = no_index;
  std::optional<std::string> object;
  GraphicsState state;
};

struct Instance {
  std::string object;
  TransformPair transforms;
  Source source;
};

// A mesh or an image whose place in the scene is known, but whose file has not been read yet.
struct PendingFile {
  std::string path;
  SourceLocation named_at;
  MeshId mesh = no_index;  // one of these
  ImageId image = no_index;
  ImageEncoding encoding = {};  // of an image
};

// A grid of a file, and the media that have it.
struct PendingGrid {
  struct Use {
    Entity medium;
    GridId MediumGrid::*handle;
  };
  GridRequest request;
  std::vector<Use> uses = {};
};

struct Reader {
  Scene& scene;
  Messages messages;
  std::filesystem::path folder;  // of the first file: names in all files are relative to it
  NameId file = no_index;        // being read

  std::deque<Parameter> attribute_values = {};  // their addresses stay
  GraphicsState state = {};
  std::vector<SavedState> stack = {};
  bool in_world = false;
  std::map<std::string, TransformPair> coordinate_systems = {};
  double motion_start = 0, motion_end = 1;  // seconds
  std::map<std::string, NamedMaterial> materials = {};
  std::map<std::string, NamedMedium> media = {};
  std::vector<Entity> interface_materials = {};
  // Nothing where a texture could not be made, which has been said.
  std::map<std::string, std::optional<TextureId>> spectrum_textures = {}, float_textures = {};
  std::map<std::pair<std::string, double>, std::optional<ImageId>> images = {};  // by path and encoding
  std::map<std::string, std::vector<ShapeRecord>> objects = {};
  std::optional<std::string> object = {};  // between ObjectBegin and ObjectEnd
  std::vector<Instance> instances = {};
  std::optional<OpenCurves> open_curves = {};
  std::map<std::string, MeshId> files_of_meshes = {};
  std::vector<PendingFile> pending_files = {};
  std::vector<PendingGrid> pending_grids = {};
  std::vector<TextureId> may_take_alpha = {};  // numbers that are their image's alpha if that turns out to have any
  Entity camera = {};
  double exposure_seconds = 1, iso = 100;

  std::vector<std::filesystem::path> open_files = {};
  size_t files_read = 0;
  bool disables_texture_levels = false;  // Option "disabletexturefiltering"
  bool gave_up = false;                  // too many mistakes

  const ParameterPointers& attributes(AttributeTarget target) const {
    return state.attributes[static_cast<size_t>(target)];
  }
  std::string resolve(const std::string& name) const;
};

// did_you_mean, but for the first mistakes only: there may be as many wrong names as right ones (read_pbrt.cpp).
std::string guess(const Reader& reader, std::string_view word, std::span<const std::string_view> known);

// Everything that a file says, until its end (directives.cpp).
void read_directives(Reader& reader, Tokenizer& tokens);
// The first file, Include and Import (read_pbrt.cpp).
void read_scene_file(Reader& reader, const std::string& path, Source named_at);

// transforms.cpp. False: `directive` is not one of these.
bool read_transform_directive(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);
// Gives the entity its Transform and, if it moves, its Motion.
void set_place(Reader& reader, Entity entity, const TransformPair& transforms);
// A light where the current transformation moves: it stands as at the start, which is said once.
void report_moving_light(Reader& reader, Source source);

// settings.cpp, film.cpp. `kind` is the string after the directive.
void read_camera(Reader& reader, std::string_view kind, Parameters& parameters);
void read_film(Reader& reader, std::string_view kind, Parameters& parameters);
void read_filter(Reader& reader, std::string_view kind, Parameters& parameters);
void read_sampler(Reader& reader, std::string_view kind, Parameters& parameters);
void read_integrator(Reader& reader, std::string_view kind, Parameters& parameters);
void default_camera(Reader& reader, Source source);

// spectra.cpp. A spectrum parameter; nothing if it is absent or wrong.
struct SpectrumValue {
  SpectrumId id = zero_spectrum;
  std::optional<ColorSpace> rgb;  // the space of an rgb value
};
// Materials also take textures (reported, nothing returned) and some a plain "float".
enum class SpectrumAlso : uint8_t { nothing, texture, texture_or_real };
std::optional<SpectrumValue> read_spectrum(Reader& reader, Parameters& parameters, std::string_view name, RgbKind kind,
                                           SpectrumAlso also);
// A "float" parameter that may be a texture (reported, the fallback returned).
double read_real_or_texture(Reader& reader, Parameters& parameters, std::string_view name, double fallback);

// textures.cpp. `kind` is the third string of the directive; nothing where it is not supported or wrong.
std::optional<TextureId> read_texture(Reader& reader, std::string_view kind, Parameters& parameters, bool is_number);
// The texture that a parameter names; nothing if it is not a texture, or none that could be made.
std::optional<TextureId> read_texture_parameter(Reader& reader, Parameters& parameters, std::string_view name,
                                                bool is_number);

// A "float" parameter, or the texture in its place. A texture that is wrong has been reported.
struct NumberOrTexture {
  double number = 0;
  TextureId texture = no_index;
};
NumberOrTexture read_number_or_texture(Reader& reader, Parameters& parameters, std::string_view name, double fallback);
// `alpha` of a shape; nothing: opaque.
TextureId read_alpha(Reader& reader, Parameters& parameters);
TextureId square_root_of(Reader& reader, TextureId texture);
// `displacement` and `normalmap` of a material.
void read_bump(Reader& reader, Parameters& parameters, Material& material);

// materials.cpp
Entity read_material(Reader& reader, std::string_view kind, Parameters& parameters, Entity entity);

// media.cpp
void make_named_medium(Reader& reader, std::string_view name, Parameters& parameters);
// What is inside and outside of the shapes that follow, by name; "": vacuum.
void use_media(Reader& reader, const std::string& inside, const std::string& outside, Source source);
// Only a slot with two different media matters to rays.
inline bool separates(const MediumSlot& media) { return media.inside != media.outside; }
void report_unmade_media(Reader& reader);
// Materials may be used before they are made; the entity is the same (materials.cpp).
NamedMaterial& named_material(Reader& reader, const std::string& name, Source source);

// lights.cpp
void read_light(Reader& reader, std::string_view kind, Parameters& parameters);
// A light's scale in single precision; an error, and 0, if that overflows.
float to_light_scale(Parameters& parameters, double scale);
AreaLight read_area_light(Reader& reader, std::string_view kind, Parameters& parameters);

// pending.cpp. Reads the pending files on all threads; messages come in the order of the statements.
void read_pending(Reader& reader);

// shapes.cpp
void read_shape(Reader& reader, std::string_view kind, Parameters& parameters);
// objects.cpp
void place_instances(Reader& reader);
void drop_interfaces(Reader& reader);

}  // namespace metamer::pbrt
