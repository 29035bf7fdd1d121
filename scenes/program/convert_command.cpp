#include <fmt/format.h>

#include "scenes/native/write_native.h"
#include "scenes/program/commands.h"
#include "scenes/program/failure.h"
#include "scenes/program/load.h"
#include "scenes/program/outputs.h"
#include "scenes/program/progress.h"
#include "scenes/program/signals.h"

namespace metamer {
namespace {

Cancellation cancellation;

std::string counted(size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

void tell(const std::string& path, const NativeFiles& files) {
  fmt::print("JSON  {}\n", path);
  if (!files.folder.empty())
    fmt::print("files {}: {}, {}, {}, {} with the JSON\n", files.folder, counted(files.meshes, "mesh"),
               counted(files.images, "image"), counted(files.grids, "grid"),
               short_bytes(static_cast<double>(files.bytes)));
}

}  // namespace

int run_convert(const ConvertArguments& arguments) {
  const std::string &source = arguments.paths[0], &target = arguments.paths[1];
  if (is_same_file(source, target))
    throw Failure(exit_wrong_input, target + ": is the scene itself, another file was expected for the output");
  if (const FileError error = check_native_target(target)) throw Failure(exit_failed, *error);
  const LoadedScene loaded = load_scene(source, {}, {arguments.quiet, arguments.strict});
  if (arguments.strict) build_world(loaded, source, {arguments.quiet, true});  // for its remarks
  install_signal_handlers(cancellation);
  save_when_interrupted();
  NativeFiles files;
  if (const FileError error = write_native(loaded.scene, target, cancellation, files))
    throw Failure(exit_failed, *error);
  if (arguments.quiet) return exit_done;
  std::fputs(format_diagnostics(files.remarks).c_str(), stderr);
  tell(target, files);
  return exit_done;
}

}  // namespace metamer
