#include "scenes/native/write_native.h"

#include <fmt/format.h>

#include <filesystem>

#include "engine/files/staged_folder.h"
#include "scenes/file_bytes.h"
#include "scenes/images/read_image.h"
#include "scenes/images/write_image.h"
#include "scenes/meshes/write_ply.h"
#include "scenes/native/write_parts.h"
#include "scenes/volumes/write_vdb.h"

namespace metamer {
namespace {

namespace fs = std::filesystem;

std::string side_folder(const std::string& path) {
  return (fs::path(path).parent_path() / (fs::path(path).stem().string() + "-files")).string();
}

// A name that every file system takes, made of the last part of what a mesh or an image is called.
std::string file_stem(const std::string& called, std::string_view fallback) {
  std::string stem = fs::path(called).filename().string();
  const std::string ending = file_extension(stem);
  for (const std::string_view known :
       {"ply", "obj", "gz", "exr", "png", "jpg", "jpeg", "tga", "hdr", "pfm", "vdb", "nvdb"})
    if (ending == known) stem = fs::path(stem).stem().string();
  constexpr size_t longest = 80;
  if (stem.size() > longest) stem.resize(longest);
  for (char& c : stem) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    if (!is_plain) c = '-';
  }
  const bool has_letter = stem.find_first_not_of('-') != std::string::npos;
  return has_letter ? stem : std::string(fallback);
}

// Whether the file that the image is called after still holds its pixels if it is decoded so.
bool is_file(const Image& image, const ImageEncoding& encoding, bool with_alpha) {
  Diagnostics ignored;
  Image read;
  return fs::is_regular_file(image.name) && read_image(image.name, {}, read, ignored, encoding) &&
         image.width == read.width && image.height == read.height && image.rgb == read.rgb &&
         (!with_alpha || image.alpha == read.alpha);
}

JsonText scene_text(WriteContext& context) {
  JsonText settings = write_settings(context.scene.settings);
  JsonText materials = write_materials(context);
  JsonText media = write_media(context);
  JsonText entities = write_entities(context);
  JsonText root = JsonText::object().break_lines();
  root.add("metamer", JsonText::integer(1)).add("settings", std::move(settings));
  if (!context.spectra.definitions().empty()) root.add("spectra", context.spectra.definitions());
  if (!context.texture_definitions.empty()) root.add("textures", context.texture_definitions);
  if (!materials.empty()) root.add("materials", std::move(materials));
  if (!media.empty()) root.add("media", std::move(media));
  if (!context.mesh_definitions.empty()) root.add("meshes", context.mesh_definitions);
  if (!context.curve_definitions.empty()) root.add("curves", context.curve_definitions);
  return root.add("entities", std::move(entities));
}

FileError write_image_file(const Image& image, const ImageFile& file, StagedFolder& folder) {
  if (!file.is_copy) {
    folder.note_written(file.name);
    return write_image(folder.path_of(file.name), image);
  }
  FileBytes bytes;
  Diagnostics messages;
  if (!read_file(image.name, {}, bytes, messages)) return format_diagnostics(messages);
  return folder.write(file.name, bytes.text());
}

FileError write_side_files(const WriteContext& context, const Cancellation& cancellation, StagedFolder& folder,
                           NativeFiles& files) {
  for (const auto& [id, name] : context.meshes) {
    if (cancellation.requested()) return "interrupted; nothing was written";
    const std::string bytes = ply_bytes(context.scene.meshes[id]);
    if (const FileError error = folder.write(name, bytes)) return error;
    files.bytes += bytes.size();
  }
  for (const ImageFile& file : context.images) {
    if (cancellation.requested()) return "interrupted; nothing was written";
    if (const FileError error = write_image_file(context.scene.images[file.id], file, folder)) return error;
    files.bytes += fs::file_size(folder.path_of(file.name));
  }
  for (const GridFile& file : context.grids) {
    if (cancellation.requested()) return "interrupted; nothing was written";
    const NamedGrid grid{file.name, &context.scene.grids[file.id]};
    folder.note_written(file.name + ".vdb");
    const std::string path = folder.path_of(file.name + ".vdb");
    if (const FileError error = write_vdb(path, {&grid, 1})) return error;
    files.bytes += fs::file_size(path);
  }
  files.meshes = context.meshes.size();
  files.grids = context.grids.size();
  files.images = context.images.size();
  return std::nullopt;
}

}  // namespace

std::string UniqueNames::take(std::string wanted) {
  wanted = valid_text(wanted);
  std::string name = wanted;
  if (!taken_.insert(name).second) {
    size_t& number = last_number_.try_emplace(wanted, 1).first->second;
    do {
      name = fmt::format("{}{}{}", wanted, separator_, ++number);
    } while (!taken_.insert(name).second);
  }
  return name;
}

// Meshes that no entity shows are left out; two meshes stay two, even equal ones: those shown twice are instances.
std::string WriteContext::mesh_name(MeshId id) {
  const auto known = mesh_names.find(id);
  if (known != mesh_names.end()) return known->second;
  const std::string name = file_names.take(file_stem(scene.meshes[id].name, "mesh"));
  meshes.push_back({id, name + ".ply"});
  const std::string path = folder + "/" + name + ".ply";
  mesh_definitions.add(name, JsonText::object().add("file", JsonText::string(path)));
  return mesh_names[id] = name;
}

// In place: curves have no files of their own.
std::string WriteContext::curves_name(CurvesId id) {
  const auto known = curve_names.find(id);
  if (known != curve_names.end()) return known->second;
  const Curves& curves = scene.curves[id];
  JsonText points = JsonText::array(), widths = JsonText::array(), segments = JsonText::array();
  JsonText normals = JsonText::array();
  for (const glm::vec4& p : curves.points) {
    points.add(JsonText::numbers(std::array{p.x, p.y, p.z}));
    widths.add(JsonText::number(2 * p.w));
  }
  for (const uint32_t segment : curves.segments) segments.add(JsonText::integer(segment));
  for (const glm::vec3& n : curves.normals) normals.add(JsonText::numbers(std::array{n.x, n.y, n.z}));
  JsonText object = JsonText::object();
  object.add("points", points).add("widths", widths).add("segments", segments);
  if (!normals.empty()) object.add("normals", normals);
  const std::string name = "curves " + std::to_string(curve_names.size() + 1);
  curve_definitions.add(name, object);
  return curve_names[id] = name;
}

const ImageFile& WriteContext::add_image_file(ImageId id, bool is_copy, bool is_linear) {
  const Image& image = scene.images[id];
  const std::string ending = is_copy ? file_extension(image.name) : "exr";
  const std::string name = file_names.take(file_stem(image.name, "image")) + "." + ending;
  images.push_back({id, name, is_copy, is_linear});
  return images.back();
}

// A grid's name is "FILE:NAME" or only NAME. What was written by us has the name of its file, which it keeps.
std::string WriteContext::grid_file_name(GridId id) {
  for (const GridFile& known : grids)
    if (known.id == id) return known.name + ".vdb";
  const std::string& called = scene.grids[id].name;
  const size_t colon = called.rfind(':');
  std::string stem = file_stem(colon == std::string::npos ? called : called.substr(0, colon), "grid");
  const std::string name = colon == std::string::npos ? stem : file_stem(called.substr(colon + 1), "grid");
  if (stem != name) stem += "-" + name;
  grids.push_back({id, file_names.take(stem)});
  return grids.back().name + ".vdb";
}

// A copy where that can be, else (generated images, other encodings) the pixels in an EXR.
const ImageFile& WriteContext::texture_image_file(ImageId id) {
  for (const ImageFile& known : images)
    if (known.id == id) return known;
  const Image& image = scene.images[id];
  // Files of floats are the same either way: linear, as normal maps are, which may share them.
  const std::string ending = file_extension(image.name);
  const bool holds_floats = ending == "exr" || ending == "hdr" || ending == "pfm";
  ImageEncoding likely = texture_encoding(image.name), other = likely;
  (holds_floats ? likely : other).gamma = 1;
  const bool is_likely = is_file(image, likely, true), is_other = !is_likely && is_file(image, other, true);
  const bool is_copy = is_likely || is_other;
  return add_image_file(id, is_copy, !is_copy || is_likely == holds_floats);
}

const ImageFile& WriteContext::light_image_file(ImageId id) {
  for (const ImageFile& known : images)
    if (known.id == id) return known;
  return add_image_file(id, is_file(scene.images[id], {}, false), false);
}

FileError check_native_target(const std::string& path) {
  if (const FileError error = check_target(path)) return error;
  return check_folder_target(side_folder(path));
}

FileError write_native(const Scene& scene, const std::string& path, const Cancellation& cancellation,
                       NativeFiles& files) {
  files = {};
  const std::string folder = side_folder(path);
  WriteContext context(scene, fs::path(folder).filename().string());
  const std::string text = scene_text(context).text();
  if (!context.mistakes.empty()) return fmt::format("{}: cannot say: {}", path, fmt::join(context.mistakes, ", "));
  files.bytes = text.size();
  files.remarks = context.remarks;
  StagedFolder staged;
  const bool has_side_files = !context.meshes.empty() || !context.images.empty() || !context.grids.empty();
  if (has_side_files) {
    files.folder = folder;
    if (const FileError error = staged.open(folder)) return error;
    if (const FileError error = write_side_files(context, cancellation, staged, files)) return error;
  }
  AtomicFile file;
  if (const FileError error = file.open(path)) return error;
  if (const FileError error = file.write(text.data(), text.size())) return error;
  if (has_side_files)
    if (const FileError error = staged.commit()) return error;
  return file.commit();
}

}  // namespace metamer
