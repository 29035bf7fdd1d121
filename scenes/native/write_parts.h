// The parts of the native writer, twins of the parts of the reader (components.h), and what they share.
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "engine/ecs/scene.h"
#include "scenes/native/json_text.h"
#include "scenes/native/write_spectra.h"

// The writer's switches over kinds have no default: a new kind of shape, material, light, ... does not compile here
// until it is written.
#pragma GCC diagnostic error "-Wswitch"

namespace metamer {

// Names of which none is taken twice: "name", "name 2", "name 3", ... in the order of asking.
class UniqueNames {
 public:
  explicit UniqueNames(char separator) : separator_(separator) {}
  std::string take(std::string wanted);

 private:
  char separator_;
  std::set<std::string> taken_;
  std::map<std::string, size_t> last_number_;
};

// Files beside the scene, by their names within the folder.
struct MeshFile {
  MeshId id;
  std::string name;
};
struct ImageFile {
  ImageId id;
  std::string name;
  bool is_copy;            // of the file that the image was read from
  bool is_linear = false;  // to be read as linear: floats, or integers without sRGB
};

struct GridFile {
  GridId id;
  std::string name;  // without ".vdb"; also of the grid in it
};

struct WriteContext {
  WriteContext(const Scene& scene_, std::string folder_) : scene(scene_), folder(std::move(folder_)) {}

  const Scene& scene;
  std::string folder;                      // of the side files, as the scene file names it
  SpectrumSet own_spectra{scene.spectra};  // and those that only the file has
  SpectrumWriter spectra{own_spectra};
  Diagnostics remarks;  // what is lost
  UniqueNames entity_names{' '}, file_names{'-'};
  std::vector<std::string> material_names, names, medium_names;  // by entity index; empty: none
  JsonText mesh_definitions = JsonText::object().break_lines();
  std::map<MeshId, std::string> mesh_names;  // those that were asked for
  JsonText texture_definitions = JsonText::object().break_lines();
  std::map<TextureId, std::string> texture_names;
  JsonText curve_definitions = JsonText::object().break_lines();
  std::map<CurvesId, std::string> curve_names;
  std::vector<MeshFile> meshes;
  std::vector<ImageFile> images;
  std::vector<GridFile> grids;
  std::vector<std::string> mistakes;  // what the format cannot say

  // The name of a mesh in "meshes", the file of an image as textures or as lights read it: all become side files.
  std::string mesh_name(MeshId id);
  const ImageFile& texture_image_file(ImageId id);
  const ImageFile& light_image_file(ImageId id);
  const ImageFile& add_image_file(ImageId id, bool is_copy, bool is_linear);
  std::string grid_file_name(GridId id);
  // The name of curves in "curves".
  std::string curves_name(CurvesId id);
  // What stands where the texture is used: {"texture": name}. It goes to the file's "textures".
  JsonText texture(TextureId id);
};

// An offset where nothing else is done, else the matrix.
JsonText write_transform(const Transform& transform);
// Only what differs from the format's defaults.
JsonText write_settings(const RenderSettings& settings);
// Every Material of the registry in the order of its table, by a name of its own.
JsonText write_materials(WriteContext& context);
std::string_view mapping_name(ImageMapping mapping);
JsonText write_light(WriteContext& context, const Light& light);
// Every Medium likewise; then what is on both sides of a surface.
JsonText write_media(WriteContext& context);
JsonText write_medium_slot(const WriteContext& context, const MediumSlot& slot);
// All entities that are more than a material, in an order that keeps the order of shapes, of lights and of cameras.
JsonText write_entities(WriteContext& context);

}  // namespace metamer
