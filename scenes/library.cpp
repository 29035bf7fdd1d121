#include "scenes/library.h"

#include <cstdlib>
#include <filesystem>

namespace metamer {

std::string shipped_scene(std::string_view name) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  if (!failed) {
    const fs::path installed = program.parent_path().parent_path() / "share/metamer/scenes" / name;
    if (fs::exists(installed, failed)) return installed.string();
  }
  return (fs::path(METAMER_SOURCE_DIR) / "scenes/library" / name).string();
}

std::string default_scene() {
  const char* chosen = std::getenv("METAMER_DEFAULT_SCENE");
  return chosen != nullptr && *chosen != '\0' ? chosen : shipped_scene(default_scene_name);
}

}  // namespace metamer
