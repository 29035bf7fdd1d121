// What the grids of a scene's media take, for `info` and `--stats`.
#pragma once
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "engine/ecs/scene.h"

namespace Json {
class Value;
}

namespace metamer {

struct GridReport {
  std::string name, type;
  size_t voxels = 0, bytes = 0;  // as they were read: those stored, in bricks
  glm::ivec3 extent{0};          // voxels along the axes of the box of those that count
  glm::dvec3 mean{0};            // over that box, per channel
  uint32_t channels = 1;
};

std::vector<GridReport> report_grids(const Scene& scene);
Json::Value to_json(const std::vector<GridReport>& grids);
// One grid in a line.
std::string describe(const GridReport& grid);

}  // namespace metamer
