#include "engine/schedule/tiles.h"

#include <algorithm>
#include <bit>

namespace metamer {
namespace {

struct Cell {
  uint32_t x, y;
};

// Point `d` of the Hilbert curve that fills a square of side `n`, a power of two: from the lowest digit in base 4 up,
// each quadrant's curve is turned and moved into place.
Cell hilbert_cell(uint32_t n, uint64_t d) {
  Cell cell{0, 0};
  for (uint32_t s = 1; s < n; s *= 2, d /= 4) {
    const bool right = (d & 2) != 0, upper = ((d ^ (d >> 1)) & 1) != 0;
    if (!upper) {
      if (right) cell = {s - 1 - cell.x, s - 1 - cell.y};
      std::swap(cell.x, cell.y);
    }
    cell.x += right ? s : 0;
    cell.y += upper ? s : 0;
  }
  return cell;
}

}  // namespace

std::vector<TileRect> make_tiles(uint32_t width, uint32_t height, uint32_t size) {
  size = (std::max(size, 1u) + 3) / 4 * 4;
  const uint32_t columns = (width + size - 1) / size, rows = (height + size - 1) / size;
  // One Hilbert curve per square along the longer side: each ends beside where the next begins.
  const bool wide = columns >= rows;
  const uint32_t length = std::max(columns, rows), breadth = std::min(columns, rows);
  const uint32_t side = std::bit_ceil(breadth);
  std::vector<TileRect> tiles;
  tiles.reserve(size_t{columns} * rows);
  for (uint32_t square = 0; square < length; square += side)
    for (uint64_t d = 0; d < uint64_t{side} * side; ++d) {
      const Cell cell = hilbert_cell(side, d);
      const uint32_t along = square + cell.x, across = cell.y;
      if (along >= length || across >= breadth) continue;
      const uint32_t x = (wide ? along : across) * size, y = (wide ? across : along) * size;
      tiles.push_back({x, y, std::min(x + size, width), std::min(y + size, height)});
    }
  return tiles;
}

std::vector<SampleRange> make_passes(uint32_t samples_per_pixel) {
  constexpr uint32_t longest = 16;
  std::vector<SampleRange> passes;
  for (uint32_t begin = 0; begin < samples_per_pixel;) {
    const uint32_t length = begin == 0 ? 1 : std::min(std::bit_floor(begin), longest);
    const uint32_t end = std::min(begin + length, samples_per_pixel);
    passes.push_back({begin, end});
    begin = end;
  }
  return passes;
}

}  // namespace metamer
