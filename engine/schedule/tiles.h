// The picture cut into tiles, and the order of work: passes of 1, 1, 2, 4, ... samples over all tiles, so that an
// interrupted picture covers the whole frame.
#pragma once
#include <cstdint>
#include <vector>

namespace metamer {

// A rectangle of pixels, [x0, x1) by [y0, y1).
struct TileRect {
  uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  uint32_t width() const { return x1 - x0; }
  uint32_t height() const { return y1 - y0; }
};

// Samples [begin, end) of every pixel.
struct SampleRange {
  uint32_t begin = 0, end = 0;
};

// Square tiles of `size` pixels (cut at the borders) along a Hilbert curve: consecutive tiles are neighbours and share
// what they cached. `size` is rounded up to a multiple of 4, the side of a camera packet.
std::vector<TileRect> make_tiles(uint32_t width, uint32_t height, uint32_t size);

// 1, 1, 2, 4, 8 and then 16 samples at a time: a unit of work stays short enough to be waited for.
std::vector<SampleRange> make_passes(uint32_t samples_per_pixel);

}  // namespace metamer
