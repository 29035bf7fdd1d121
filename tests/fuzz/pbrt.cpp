#include <algorithm>
#include <array>

#include "scenes/pbrt/read_pbrt.h"
#include "tests/fuzz/scratch.h"
#include "tests/fuzz/targets.h"

namespace metamer::fuzz {
namespace {

constexpr std::string_view mark = "#= ";  // a comment in pbrt's eyes
constexpr std::array<std::string_view, 6> part_names = {"part.pbrt", "more.pbrt",    "mesh.ply",
                                                        "table.spd", "part.pbrt.gz", "mesh.ply.gz"};

// The first line break in front of a mark with a known name, and that name.
struct Cut {
  size_t at = std::string_view::npos, after = std::string_view::npos;
  std::string_view name;
};

Cut find_cut(std::string_view text) {
  for (size_t at = text.find('\n'); at != std::string_view::npos; at = text.find('\n', at + 1)) {
    if (!text.substr(at + 1).starts_with(mark)) continue;
    const size_t begin = at + 1 + mark.size(), end = text.find('\n', begin);
    const std::string_view name = text.substr(begin, end == std::string_view::npos ? end : end - begin);
    if (std::find(part_names.begin(), part_names.end(), name) == part_names.end()) continue;
    return {at + 1, end == std::string_view::npos ? text.size() : end + 1, name};
  }
  return {};
}

}  // namespace

void pbrt(std::string_view input) {
  if (names_outside(input)) return;
  Scratch& folder = scratch();
  std::string_view name = "scene.pbrt";
  while (true) {
    const Cut cut = find_cut(input);
    folder.write(name, input.substr(0, cut.at));
    if (cut.at == std::string_view::npos) break;
    name = cut.name;
    input.remove_prefix(cut.after);
  }
  Scene scene;
  Diagnostics diagnostics;
  const bool ok = read_pbrt(folder.path("scene.pbrt"), scene, diagnostics);
  folder.clear();
  require_consistent(ok, diagnostics);
  if (ok) require_valid(scene);
}

}  // namespace metamer::fuzz
