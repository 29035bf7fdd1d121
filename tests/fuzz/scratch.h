// A folder of files for readers that open them, and the promises that are checked.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/ecs/scene.h"

namespace metamer::fuzz {

// Stops the program, as a crash would, if a promise is broken.
void require(bool kept, std::string_view promise);

// What every reader promises: false if and only if it has reported an error.
void require_consistent(bool ok, const Diagnostics& diagnostics);

// A scene that was read without an error: handles within their tables, finite numbers, valid meshes.
void require_valid(const Scene& scene);

// Whether a name in the input could lead out of the folder.
bool names_outside(std::string_view input);

// In the folder for temporary files, removed at the end of the program.
class Scratch {
 public:
  Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch();

  std::string path(std::string_view name) const { return (folder_ / name).string(); }
  std::string write(std::string_view name, std::string_view content);
  // Removes what was written since the folder was made, but for map.tga, sky.pfm and mesh.ply.
  void clear();

 private:
  std::filesystem::path folder_;
  std::vector<std::string> written_;
};

// The one of this program.
Scratch& scratch();

}  // namespace metamer::fuzz
