#include "engine/schedule/tiles.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace metamer {
namespace {

TEST(Tiles, CoverEveryPixelOnceForAnySize) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {37u, 29u}, {64u, 64u}, {5u, 200u}, {130u, 3u}})
    for (const uint32_t size : {1u, 4u, 10u, 16u, 64u, 1000u}) {
      std::vector<int> covered(size_t{width} * height);
      for (const TileRect& tile : make_tiles(width, height, size)) {
        ASSERT_LT(tile.x0, tile.x1);
        ASSERT_LT(tile.y0, tile.y1);
        ASSERT_LE(tile.x1, width);
        ASSERT_LE(tile.y1, height);
        for (uint32_t y = tile.y0; y < tile.y1; ++y)
          for (uint32_t x = tile.x0; x < tile.x1; ++x) ++covered[size_t{y} * width + x];
      }
      for (const int count : covered) ASSERT_EQ(count, 1);
    }
}

// A packet of camera rays is an aligned block of 4 x 4 pixels: it never belongs to two tiles.
TEST(Tiles, BeginAtMultiplesOfFour) {
  for (const uint32_t size : {1u, 5u, 16u, 30u})
    for (const TileRect& tile : make_tiles(123, 77, size)) {
      EXPECT_EQ(tile.x0 % 4, 0u);
      EXPECT_EQ(tile.y0 % 4, 0u);
      EXPECT_LE(tile.width(), (size + 3) / 4 * 4);
    }
}

TEST(Tiles, FollowEachOtherAsNeighbours) {
  for (const auto& [width, height] : {std::pair{128u, 128u}, {512u, 64u}, {64u, 256u}}) {
    const std::vector<TileRect> tiles = make_tiles(width, height, 16);
    ASSERT_EQ(tiles.size(), size_t{width} * height / 256);
    for (size_t i = 1; i < tiles.size(); ++i) {
      const int dx = int(tiles[i].x0) - int(tiles[i - 1].x0), dy = int(tiles[i].y0) - int(tiles[i - 1].y0);
      ASSERT_EQ(std::abs(dx) + std::abs(dy), 16) << i;
    }
  }
}

// The square around such a picture has 2^36 tiles.
TEST(Tiles, OfALongStripTakeTheTimeOfTheStrip) { EXPECT_EQ(make_tiles(1u << 20, 3, 4).size(), size_t{1} << 18); }

TEST(Passes, DoubleUpToSixteenAndAddUp) {
  for (const uint32_t samples : {1u, 2u, 3u, 16u, 100u, 1024u}) {
    uint32_t next = 0;
    for (const SampleRange& pass : make_passes(samples)) {
      EXPECT_EQ(pass.begin, next);
      ASSERT_GT(pass.end, pass.begin);
      EXPECT_LE(pass.end - pass.begin, std::min(std::max(pass.begin, 1u), 16u));
      next = pass.end;
    }
    EXPECT_EQ(next, samples);
  }
  EXPECT_EQ(make_passes(64).size(), 8u) << "1 1 2 4 8 16 16 16";
}

}  // namespace
}  // namespace metamer
