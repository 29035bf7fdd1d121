#include "scenes/volumes/medium_box.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/vec4.hpp>
#include <limits>

namespace metamer {

void set_medium_box(MediumGrid& medium, std::span<const Grid* const> grids, double margin) {
  glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper(-lower);
  for (const Grid* grid : grids) {
    const bool is_empty = grid->lower.x >= grid->upper.x;
    const glm::dvec3 low = glm::dvec3(is_empty ? glm::ivec3(0) : grid->lower) - margin;
    const glm::dvec3 high(is_empty ? glm::ivec3(1) : grid->upper);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec4 at((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                          (corner & 4) != 0 ? high.z : low.z, 1);
      const glm::dvec3 p(grid->index_to_local * at);
      lower = glm::min(lower, p);
      upper = glm::max(upper, p);
    }
  }
  medium.lower = glm::vec3(lower);
  medium.upper = glm::vec3(upper);
}

}  // namespace metamer
