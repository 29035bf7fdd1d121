// A scene as its author made it: entities, and the heavy data their components refer to by handle.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/diagnostics.h"
#include "engine/ecs/components.h"
#include "engine/ecs/grid.h"
#include "engine/sampling/filters.h"
#include "engine/schedule/tiles.h"
#include "engine/spectrum/color_mode.h"
#include "engine/spectrum/spectrum_set.h"

namespace metamer {

// A triangle mesh in local space. Normals and uvs are empty or one per vertex.
struct Mesh {
  std::string name;             // the file or the entity it came from, for messages
  Column<glm::vec3> positions;  // metres
  Column<glm::vec3> normals;    // need not be unit length
  Column<glm::vec2> uvs;
  Column<uint32_t> indices;  // three per triangle, counter-clockwise seen from the side of the normal
};

// Cubic Bezier curves with a width, in local space. A curve of several segments shares their ends.
struct Curves {
  std::string name;
  Column<glm::vec4> points;   // metres; w: half of the width
  Column<glm::vec3> normals;  // ribbons: one per point, whose Bezier curve is the direction of the ribbon's normal
  Column<uint32_t> segments;  // the first of four points of each
};

// How integer channels of an image file are encoded: 0 as sRGB, else as the power `gamma` (1: linear).
struct ImageEncoding {
  double gamma = 0;
  bool allows_negative = false;
  bool decodes_alpha = false;  // like the colours; else alpha is linear
};

// Linear RGB, row by row from the top.
struct Image {
  std::string name;
  uint32_t width = 0, height = 0;
  std::vector<float> rgb;    // 3 * width * height
  std::vector<float> alpha;  // width * height, or none: 1 everywhere
  ImageMapping mapping = ImageMapping::latitude_longitude;
  ColorSpace color_space = ColorSpace::srgb;
  // Too large for the memory that textures may take: there are no pixels here; they are those of the file `name`, to be
  // read row by row (engine/files/image_rows.h).
  bool is_in_file = false;
  ImageEncoding encoding;       // of that file
  bool file_has_alpha = false;  // that is not 1 everywhere
};

struct Filter {
  FilterKind kind = FilterKind::gaussian;
  float radius_x = 1.5f, radius_y = 1.5f;  // pixels
  float sigma = 0.5f;                      // pixels; gaussian only
  float b = 1 / 3.0f, c = 1 / 3.0f;        // mitchell only
  float tau = 3;                           // pixels; sinc only
};

// Which light is followed (DESIGN.md, section 1). local: what the eye ray meets, lit by the light sources. recursive:
// and ideal reflection and refraction. path: global illumination. ambient_occlusion: no light of the scene; how much of
// its hemisphere the first surface sees, weighted by the cosine, times white of 1 cd/m^2.
enum class Integrator : uint32_t { local, recursive, path, ambient_occlusion };
inline constexpr std::array<std::string_view, 4> integrator_names = {"local", "recursive", "path", "ambient_occlusion"};
constexpr std::string_view integrator_name(Integrator integrator) {
  return integrator_names[static_cast<size_t>(integrator)];
}

struct RenderSettings {
  uint32_t width = 1280, height = 720;
  uint32_t samples_per_pixel = 64;
  uint32_t max_depth = 16;  // scattering events on a path: 0 shows emission only
  uint32_t seed = 0;
  Integrator integrator = Integrator::path;
  float occlusion_distance = std::numeric_limits<float>::infinity();  // metres; ambient_occlusion: what lies beyond
                                                                      // does not count
  // cd/m^2: the most that one contribution of light that was scattered more than once may add to a sample; biased.
  float clamp_indirect = std::numeric_limits<float>::infinity();
  bool shadows = true;      // false: light sources shine through everything on what they light
  uint32_t band_count = 0;  // of the spectral film; 0: none
  Filter filter;
  // x_min x_max y_min y_max of what is rendered, as fractions of the picture from its upper left corner.
  glm::dvec4 crop{0, 1, 0, 1};
  bool pixel_jitter = true;                    // false: all samples of a pixel go through its centre, and the lens's
  double shutter_open = 0, shutter_close = 1;  // seconds; close after open. What moves is seen all the time in between
  float sensor_scale = 1;                      // exposure time times ISO / 100: multiplies what the film records
  // cd/m^2 after sensor_scale: samples of which X, Y or Z is above are scaled down until none is.
  float largest_component = std::numeric_limits<float>::infinity();
  float white_balance_kelvin = 0;  // CIE daylight (from 4000 K) that is recorded as the colour space's white; 0: none
  ColorSpace primaries = ColorSpace::srgb;  // of the EXR, one of those that scenes may name
  float exposure_stops = 0;                 // tone mapping only
  ColorMode color = ColorMode::spectral;
};

// The pixels that are rendered: those of which the crop covers the upper left corner, at least one.
inline TileRect rendered_pixels(const RenderSettings& settings) {
  const auto pixel = [](double fraction, uint32_t side) {
    // Fractions of whole pixels may have been rounded up.
    return static_cast<uint32_t>(std::clamp(std::ceil(fraction * side - 1e-4), 0.0, double(side)));
  };
  const glm::dvec4& c = settings.crop;
  TileRect rect{pixel(c.x, settings.width), pixel(c.z, settings.height), pixel(c.y, settings.width),
                pixel(c.w, settings.height)};
  rect.x0 = std::min(rect.x0, settings.width - 1);
  rect.y0 = std::min(rect.y0, settings.height - 1);
  rect.x1 = std::max(rect.x1, rect.x0 + 1);
  rect.y1 = std::max(rect.y1, rect.y0 + 1);
  return rect;
}

class NameTable {
 public:
  NameId add(std::string_view name) {
    for (size_t i = recent_; i < names_.size(); ++i)
      if (names_[i] == name) return static_cast<NameId>(i);
    names_.emplace_back(name);
    recent_ = names_.size() > 8 ? names_.size() - 8 : 0;
    return static_cast<NameId>(names_.size() - 1);
  }
  const std::string& operator[](NameId id) const { return names_[id]; }

 private:
  // Only the last few names are compared: enough to share a file name among its entities, without a hash map.
  std::vector<std::string> names_;
  size_t recent_ = 0;
};

struct Scene {
  Registry registry;
  SpectrumSet spectra;
  std::vector<Mesh> meshes;
  std::vector<Curves> curves;
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<Grid> grids;
  NameTable names;
  RenderSettings settings;
  // Bytes that the texels of textures may take; readers leave images in their files, the largest first, where all of
  // them would take more.
  uint64_t texture_memory = std::numeric_limits<uint64_t>::max();

  // "file:line" of an entity, as far as known.
  SourceLocation location(Entity entity) const {
    const Source source = registry.get<Source>(entity);
    return source.file == no_index ? SourceLocation{} : SourceLocation{names[source.file], source.line};
  }
  // The entity's name, or "entity N".
  std::string describe(Entity entity) const {
    const Name name = registry.get<Name>(entity);
    return name.name == no_index ? "entity " + std::to_string(entity.index) : "'" + names[name.name] + "'";
  }
};

}  // namespace metamer
