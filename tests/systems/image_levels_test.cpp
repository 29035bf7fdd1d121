#include "systems/image_levels.h"

#include <gmock/gmock.h>

#include <numeric>

namespace metamer {
namespace {

// All levels from 1 on, one after the other.
std::vector<std::vector<float>> levels_of(uint32_t width, uint32_t height, uint32_t channels,
                                          const std::vector<float>& image) {
  struct Store {
    std::vector<LevelSize> sizes;
    uint32_t channels;
    std::vector<std::vector<float>> levels;
  } store{level_sizes(width, height), channels, {}};
  store.levels.resize(store.sizes.size() - 1);
  const auto take = [](void* context, uint32_t level, const float* row) {
    Store& s = *static_cast<Store*>(context);
    s.levels[level - 1].insert(s.levels[level - 1].end(), row, row + size_t{s.channels} * s.sizes[level].width);
  };
  LevelRows rows(width, height, channels, take, &store);
  for (uint32_t y = 0; y < height; ++y) rows.add(image.data() + size_t{y} * width * channels);
  for (size_t level = 1; level < store.sizes.size(); ++level)
    EXPECT_EQ(store.levels[level - 1].size(), size_t{channels} * store.sizes[level].width * store.sizes[level].height);
  return store.levels;
}

TEST(ImageLevels, HalveUntilOneTexelIsLeft) {
  std::vector<std::pair<uint32_t, uint32_t>> sizes;
  for (const auto& [width, height] : level_sizes(13, 4)) sizes.emplace_back(width, height);
  EXPECT_THAT(sizes, testing::ElementsAre(std::pair{13u, 4u}, std::pair{6u, 2u}, std::pair{3u, 1u}, std::pair{1u, 1u}));
  EXPECT_EQ(level_sizes(1, 1).size(), 1u);
}

TEST(ImageLevels, TakeTheMeanOfFourTexels) {
  const auto levels = levels_of(4, 2, 1, {1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_THAT(levels[0], testing::ElementsAre(3.5f, 5.5f));
  EXPECT_THAT(levels[1], testing::ElementsAre(4.5f));
}

// Five texels as two: each is as wide as two and a half.
TEST(ImageLevels, TakeShareOfTexelsThatLieInTwoOfTheNext) {
  const auto levels = levels_of(5, 1, 1, {10, 20, 30, 40, 50});
  EXPECT_NEAR(levels[0][0], (10 + 20 + 30 / 2.0) / 2.5, 1e-5);
  EXPECT_NEAR(levels[0][1], (30 / 2.0 + 40 + 50) / 2.5, 1e-5);
  const auto column = levels_of(1, 5, 1, {10, 20, 30, 40, 50});
  EXPECT_EQ(column[0], levels[0]);
}

TEST(ImageLevels, KeepTheMeanWhateverTheSize) {
  for (const auto& [width, height] : {std::pair{37u, 53u}, {64u, 1u}, {1u, 7u}, {3u, 3u}, {100u, 63u}}) {
    std::vector<float> image(size_t{3} * width * height);
    for (size_t i = 0; i < image.size(); ++i) image[i] = static_cast<float>(i * 7919 % 1000) / 1000;
    for (size_t channel = 0; channel < 3; ++channel) {
      const auto mean = [&](const std::vector<float>& values) {
        double sum = 0;
        for (size_t i = channel; i < values.size(); i += 3) sum += double{values[i]};
        return sum / static_cast<double>(values.size() / 3);
      };
      for (const auto& level : levels_of(width, height, 3, image))
        EXPECT_NEAR(mean(level), mean(image), 2e-6) << width << " x " << height;
    }
  }
}

}  // namespace
}  // namespace metamer
