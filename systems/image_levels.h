// Images at half, a quarter, an eighth ... of their size.
#pragma once
#include <cstdint>
#include <vector>

namespace metamer {

struct LevelSize {
  uint32_t width, height;
};
// Of the image itself, then half as much each time, rounded down, until a level has one texel.
std::vector<LevelSize> level_sizes(uint32_t width, uint32_t height);

// Makes the levels of an image from its rows, one after the other: each texel is the mean over its area of the level
// before, so all levels have the same mean. Holds one row per level.
class LevelRows {
 public:
  using Take = void (*)(void* context, uint32_t level, const float* row);
  // `take` gets the rows of the levels from 1 on, each level's from the top down, as soon as they are known.
  LevelRows(uint32_t width, uint32_t height, uint32_t channels, Take take, void* context);
  // The next row of the image, from the top down.
  void add(const float* row) { add(0, row); }

 private:
  void add(size_t level, const float* row);
  void emit(size_t level);

  struct Level {
    LevelSize size;
    uint32_t rows = 0;          // added so far
    std::vector<float> narrow;  // the row that was added last, as wide as the next level
    std::vector<float> sum;     // of the next level's row that is being made
  };
  std::vector<Level> levels_;
  uint32_t channels_;
  Take take_;
  void* context_;
};

}  // namespace metamer
