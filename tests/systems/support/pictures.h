// Pictures from code, for the tests of what develops them.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "engine/film/picture.h"

namespace metamer {

// One row of pixels.
inline Picture picture_of(const std::vector<std::array<float, 3>>& colours) {
  Picture picture{static_cast<uint32_t>(colours.size()), 1, {}, {}, {}};
  for (const std::array<float, 3>& c : colours) {
    picture.r.push_back(c[0]);
    picture.g.push_back(c[1]);
    picture.b.push_back(c[2]);
  }
  return picture;
}

}  // namespace metamer
