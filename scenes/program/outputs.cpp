#include "scenes/program/outputs.h"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "engine/files/output_kind.h"
#include "scenes/program/failure.h"

namespace metamer {
namespace {

namespace fs = std::filesystem;

std::string beside(const std::string& path, const char* ending) {
  return fs::path(path).replace_extension(ending).string();
}

// One name for one file, whether or not it exists yet.
fs::path identity(const std::string& path) {
  std::error_code failed;
  const fs::path absolute = fs::absolute(path, failed);
  const fs::path canonical = fs::weakly_canonical(absolute, failed);
  return failed ? absolute.lexically_normal() : canonical;
}

void check_kind(const std::string& path, OutputKind expected, const char* flag) {
  if (output_kind(path) == expected) return;
  const FileError error = check_writable(path, expected);
  throw Failure(exit_wrong_input,
                fmt::format("{}: {}", flag, error.value_or(fmt::format("{}: is of another kind", path))));
}

}  // namespace

bool is_same_file(const std::string& a, const std::string& b) { return identity(a) == identity(b); }

std::string scene_title(const std::string& scene_path) {
  std::error_code failed;
  const fs::path absolute = fs::absolute(scene_path, failed).lexically_normal();
  const std::string stem = absolute.stem().string();
  const std::string folder = absolute.parent_path().filename().string();
  return stem == "scene" && !folder.empty() ? folder : stem;
}

Outputs choose_outputs(const RenderArguments& arguments, const std::string& scene_path) {
  Outputs outputs{arguments.exr, arguments.png, arguments.stats};
  if (outputs.exr.empty() && outputs.png.empty()) {
    const std::string title = scene_title(scene_path);
    return {title + ".exr", title + ".png", arguments.stats};
  }
  if (outputs.exr.empty()) outputs.exr = beside(outputs.png, ".exr");
  if (outputs.png.empty()) outputs.png = beside(outputs.exr, ".png");
  return outputs;
}

void check_outputs(const Outputs& outputs, const std::string& scene_path) {
  check_kind(outputs.exr, OutputKind::exr, "--output");
  check_kind(outputs.png, OutputKind::png, "--png");
  std::vector<std::string> files = {outputs.exr, outputs.png};
  if (!outputs.stats.empty()) files.push_back(outputs.stats);
  for (size_t i = 0; i < files.size(); ++i) {
    if (is_same_file(files[i], scene_path))
      throw Failure(exit_wrong_input, files[i] + ": is the scene itself, another file was expected for the output");
    for (size_t j = 0; j < i; ++j)
      if (is_same_file(files[i], files[j])) throw Failure(exit_wrong_input, files[i] + ": is named for two outputs");
  }
  std::string mistakes;
  for (const std::string& file : files)
    if (const FileError error = check_target(file)) mistakes += (mistakes.empty() ? "" : "\n") + *error;
  if (!mistakes.empty()) throw Failure(exit_failed, mistakes);
}

}  // namespace metamer
