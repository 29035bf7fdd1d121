// What the parts of the native reader share while one file is read.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "engine/ecs/scene.h"
#include "scenes/native/json_reader.h"

namespace metamer {

// What a spectrum is for: this decides how rgb becomes a spectrum, which values are valid, and what a table is worth
// outside its range.
enum class Quantity : uint8_t {
  any,          // not used by anything: only its form is checked
  reflectance,  // 0 to 1; keeps its end values
  brdf,         // at least 0; keeps its end values
  eta,          // above 0; keeps its end values
  kappa,        // at least 0; keeps its end values
  coefficient,  // at least 0; keeps its end values
  light,        // at least 0; zero outside
};

// A spectrum of the file's "spectra".
struct NamedSpectrum {
  const Json::Value* value = nullptr;
  std::map<Quantity, SpectrumId> ids;  // by what it has been used for
  bool is_wrong = false;               // its mistakes have been reported
};

struct NamedEntity {
  Entity entity;
  SourceLocation at;
  bool has_material = false;  // of its own
};

struct SceneContext {
  SceneContext(const JsonDocument& document, Scene& scene_, Diagnostics& diagnostics)
      : reader(document, diagnostics), scene(scene_), file(scene_.names.add(document.path())) {}

  JsonReader reader;
  Scene& scene;
  NameId file;
  double metres_per_unit = 1;
  std::map<std::string, NamedSpectrum> spectra;
  std::map<std::string, MeshId> meshes;       // of the file's "meshes"
  std::map<std::string, CurvesId> curves;     // of the file's "curves"
  std::map<std::string, MeshId> mesh_files;   // by resolved path: a file is read once
  std::map<std::string, TextureId> textures;  // those read so far
  std::string texture_being_read;
  std::map<std::tuple<std::string, double, std::optional<ColorSpace>>, std::optional<ImageId>>
      images;                                   // by path, gamma and space
  std::map<std::string, NamedEntity> entities;  // materials too
  std::map<std::string, Entity> media;

  float metres(double length) const { return static_cast<float>(length * metres_per_unit); }
  Source source_of(const Json::Value& value) const { return {file, reader.document().at(value).line}; }
};

// ` (did you mean 'x'?)` among the keys of a map.
template <class Map>
std::string did_you_mean_key(const std::string& word, const Map& map) {
  std::vector<std::string_view> keys;
  for (const auto& entry : map) keys.push_back(entry.first);
  return did_you_mean(word, keys);
}

}  // namespace metamer
