// A scene as its author made it: entities, and the heavy data their components refer to by handle.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/diagnostics.h"
#include "engine/ecs/components.h"
#include "engine/sampling/filters.h"
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

enum class ImageMapping : uint32_t { latitude_longitude, equal_area };

// Linear RGB, row by row from the top.
struct Image {
  std::string name;
  uint32_t width = 0, height = 0;
  std::vector<float> rgb;  // 3 * width * height
  ImageMapping mapping = ImageMapping::latitude_longitude;
  ColorSpace color_space = ColorSpace::srgb;
};

// Values at the centres of nx by ny by nz cells, x fastest.
struct Grid {
  uint32_t nx = 1, ny = 1, nz = 1;
  uint32_t channels = 1;  // or 3: linear RGB
  ColorSpace color_space = ColorSpace::srgb;
  std::vector<float> values;  // channels * nx * ny * nz
};

struct Filter {
  FilterKind kind = FilterKind::gaussian;
  float radius_x = 1.5f, radius_y = 1.5f;  // pixels
  float sigma = 0.5f;                      // pixels; gaussian only
};

// Which light is followed (DESIGN.md, section 1). local: what the eye ray meets, lit by the light sources. recursive:
// and ideal reflection and refraction. path: global illumination.
enum class Integrator : uint32_t { local, recursive, path };
inline constexpr std::array<std::string_view, 3> integrator_names = {"local", "recursive", "path"};
constexpr std::string_view integrator_name(Integrator integrator) {
  return integrator_names[static_cast<size_t>(integrator)];
}

struct RenderSettings {
  uint32_t width = 1280, height = 720;
  uint32_t samples_per_pixel = 64;
  uint32_t max_depth = 16;  // scattering events on a path: 0 shows emission only
  uint32_t seed = 0;
  Integrator integrator = Integrator::path;
  bool shadows = true;      // false: light sources shine through everything on what they light
  uint32_t band_count = 0;  // of the spectral film; 0: none
  Filter filter;
  float sensor_scale = 1;    // exposure time times ISO / 100: multiplies what the film records
  float exposure_stops = 0;  // tone mapping only
  ColorMode color = ColorMode::spectral;
};

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
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<Grid> grids;
  NameTable names;
  RenderSettings settings;

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
