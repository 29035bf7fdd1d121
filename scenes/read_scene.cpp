#include "scenes/read_scene.h"

#include "scenes/gzip.h"
#include "scenes/native/read_native.h"
#include "scenes/pbrt/read_pbrt.h"

namespace metamer {
namespace {

// JSON begins with a brace, our format with nothing else, except for comments and a byte order mark.
bool looks_like_json(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  const size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && (text[first] == '{' || text[first] == '/');
}

}  // namespace

bool read_scene(const std::string& path, Scene& scene, Diagnostics& diagnostics) {
  const std::string extension = packed_file_extension(path);
  if (extension == "json") return read_native(path, scene, diagnostics);
  if (extension == "pbrt") return read_pbrt(path, scene, diagnostics);
  FileBytes bytes;
  if (!read_packed_file(path, {path, 0}, bytes, diagnostics)) return false;
  if (looks_like_json(bytes.text())) return read_native(path, std::move(bytes), scene, diagnostics);
  diagnostics.error({path, 0}, "unknown kind of scene; expected a file ending in .json or .pbrt");
  return false;
}

}  // namespace metamer
