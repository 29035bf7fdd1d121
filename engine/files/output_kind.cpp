#include "engine/files/output_kind.h"

#include <fmt/format.h>

namespace metamer {
namespace {

constexpr std::string_view kinds = ".exr (linear, 32-bit float) and .png (8-bit, display-encoded)";

std::string ending_of(std::string_view path) {
  path.remove_prefix(path.rfind('/') + 1);  // npos + 1 is 0
  const size_t dot = path.rfind('.');
  if (dot == std::string_view::npos || dot == 0) return "";
  std::string ending(path.substr(dot));
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return ending;
}

}  // namespace

std::optional<OutputKind> output_kind(std::string_view path) {
  const std::string ending = ending_of(path);
  if (ending == ".exr") return OutputKind::exr;
  if (ending == ".png") return OutputKind::png;
  return std::nullopt;
}

FileError check_writable(const std::string& path) {
  if (path.empty()) return "an empty name was given for an output file";
  if (!output_kind(path)) {
    const std::string ending = ending_of(path);
    return fmt::format("{}: {}; the kinds that can be written are {}", path,
                       ending.empty() ? "the name has no ending that says its kind"
                                      : fmt::format("'{}' is an unknown kind of picture", ending),
                       kinds);
  }
  return check_target(path);
}

FileError check_writable(const std::string& path, OutputKind expected) {
  const std::optional<OutputKind> kind = output_kind(path);
  if (kind && *kind != expected)
    return fmt::format("{}: {} was expected here", path, expected == OutputKind::exr ? "an .exr file" : "a .png file");
  return check_writable(path);
}

}  // namespace metamer
