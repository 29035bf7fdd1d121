#include "scenes/native/read_native.h"

#include "scenes/gzip.h"
#include "scenes/images/texture_memory.h"
#include "scenes/native/components.h"
#include "scenes/native/entities.h"
#include "scenes/native/settings.h"
#include "scenes/native/spectra.h"

namespace metamer {
namespace {

constexpr uint32_t format_version = 1;

void read_scene_object(SceneContext& context, const Json::Value& root) {
  const JsonReader& reader = context.reader;
  const JsonObject object(reader, root, *find_object_spec("scene"), "a scene");
  if (!object.is_valid()) return;
  if (const Json::Value* schema = object.find("$schema")) reader.text(*schema, "$schema");
  object.integer("metamer", format_version, format_version, format_version);
  constexpr std::string_view units[] = {"m", "cm", "mm"};
  constexpr double metres[] = {1, 0.01, 0.001};
  context.metres_per_unit = metres[object.choice("units", units, 0)];
  if (const Json::Value* settings = object.find("settings")) context.scene.settings = read_settings(context, *settings);
  if (const Json::Value* spectra = object.find("spectra")) declare_spectra(context, *spectra);
  if (const Json::Value* textures = object.find("textures")) read_textures(context, *textures);
  if (const Json::Value* meshes = object.find("meshes")) read_meshes(context, *meshes);
  if (const Json::Value* curves = object.find("curves")) read_curves(context, *curves);
  if (const Json::Value* materials = object.find("materials")) read_materials(context, *materials);
  if (const Json::Value* media = object.find("media")) read_media(context, *media);
  if (const Json::Value* entities = object.find("entities")) read_entities(context, *entities);
  check_unused_spectra(context);
  if (!reader.diagnostics().has_errors()) read_images_that_fit(context.scene, reader.diagnostics());
}

}  // namespace

bool read_native(const std::string& path, Scene& scene, Diagnostics& diagnostics) {
  FileBytes bytes;
  return read_packed_file(path, {path, 0}, bytes, diagnostics) &&
         read_native(path, std::move(bytes), scene, diagnostics);
}

bool read_native(const std::string& path, FileBytes bytes, Scene& scene, Diagnostics& diagnostics) {
  const size_t errors_before = diagnostics.error_count();
  JsonDocument document;
  document.load(path, std::move(bytes), diagnostics);
  if (!document.is_readable()) return false;
  SceneContext context(document, scene, diagnostics);
  read_scene_object(context, document.root());
  return diagnostics.error_count() == errors_before;
}

}  // namespace metamer
