#include "scenes/pbrt/read_pbrt.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/gzip.h"
#include "scenes/pbrt/reader.h"

namespace metamer {
namespace pbrt {
namespace {

constexpr size_t deepest_include = 64;
// Files that include each other in a fan could be read 2^64 times.
constexpr size_t most_files = 20'000;

std::string include_mistake(const Reader& reader, const std::filesystem::path& path) {
  if (std::find(reader.open_files.begin(), reader.open_files.end(), path) != reader.open_files.end()) {
    return fmt::format("'{}' includes itself", path.string());
  }
  if (reader.open_files.size() >= deepest_include)
    return fmt::format("files are included more than {} deep", deepest_include);
  if (reader.files_read >= most_files) return fmt::format("more than {} files are included", most_files);
  return {};
}

std::string_view encoding_mistake(std::string_view text) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    return "UTF-16 is not supported; save the file as UTF-8";
  return {};
}

void report_open_blocks(Reader& reader) {
  constexpr std::string_view names[] = {"AttributeBegin", "TransformBegin", "ObjectBegin", "Import"};
  for (const SavedState& saved : reader.stack) {
    reader.messages.error(saved.source, fmt::format("this {} is never ended", names[static_cast<size_t>(saved.block)]));
  }
}

void report_unmade_materials(Reader& reader) {
  std::vector<std::string_view> made;
  for (const auto& [name, material] : reader.materials) {
    if (material.defined) made.push_back(name);
  }
  for (const auto& [name, material] : reader.materials) {
    if (material.defined) continue;
    reader.messages.error(material.first_use,
                          fmt::format("there is no material '{}'{}", name, guess(reader, name, made)));
  }
}

void finish(Reader& reader, Source whole_file) {
  if (!reader.in_world) {
    reader.messages.error(whole_file, "there is no WorldBegin, so there is nothing to render");
    default_camera(reader, whole_file);
  }
  read_pending(reader);
  report_open_blocks(reader);
  report_unmade_materials(reader);
  report_unmade_media(reader);
  place_instances(reader);
  drop_interfaces(reader);
  reader.scene.settings.sensor_scale = static_cast<float>(reader.exposure_seconds * reader.iso / 100);
}

}  // namespace

std::string guess(const Reader& reader, std::string_view word, std::span<const std::string_view> known) {
  constexpr size_t most_guesses = 100;  // as many mistakes as are printed
  return reader.messages.diagnostics.error_count() < most_guesses ? did_you_mean(word, known) : std::string();
}

std::string Reader::resolve(const std::string& name) const {
  // As pbrt: relative to the first file, else to the working folder.
  const std::filesystem::path path(name);
  if (path.is_absolute()) return name;
  std::error_code ignored;
  const std::filesystem::path beside = folder / path;
  return std::filesystem::exists(beside, ignored) || !std::filesystem::exists(path, ignored) ? beside.string() : name;
}

void read_scene_file(Reader& reader, const std::string& path, Source named_at) {
  std::error_code ignored;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, ignored);
  const std::string mistake = include_mistake(reader, canonical);
  if (!mistake.empty()) return reader.messages.error(named_at, mistake);
  FileBytes bytes;
  if (!read_packed_file(path, reader.messages.at(named_at), bytes, reader.messages.diagnostics)) return;
  const NameId outer_file = reader.file;
  reader.file = reader.scene.names.add(path);
  const std::string_view encoding = encoding_mistake(bytes.text());
  if (encoding.empty()) {
    reader.open_files.push_back(canonical);
    ++reader.files_read;
    Tokenizer tokens(bytes.text(), path, reader.messages.diagnostics);
    read_directives(reader, tokens);
    reader.open_files.pop_back();
  } else {
    reader.messages.error({reader.file, 1}, std::string(encoding));
  }
  reader.file = outer_file;
}

}  // namespace pbrt

bool read_pbrt(const std::string& path, Scene& scene, Diagnostics& diagnostics) {
  const size_t errors_before = diagnostics.error_count();
  // What holds where the file says nothing: pbrt-v4's defaults.
  scene.settings = {};
  scene.settings.samples_per_pixel = 16;
  scene.settings.max_depth = 5;
  pbrt::Reader reader{scene, {diagnostics, scene.names}, std::filesystem::path(path).parent_path()};
  const Source whole_file{scene.names.add(path), 0};
  pbrt::read_scene_file(reader, path, whole_file);
  if (reader.files_read > 0) pbrt::finish(reader, whole_file);
  return diagnostics.error_count() == errors_before;
}

}  // namespace metamer
