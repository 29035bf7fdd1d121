#include "systems/image_levels.h"

#include <algorithm>

namespace metamer {
namespace {

// How much the three texels 2 i, 2 i + 1 and 2 i + 2 of a side count in texel i of the next level's, which is half as
// long, rounded down: their shares of its length.
struct Shares {
  float first, second, third;
};
Shares shares(uint32_t side, uint32_t i) {
  if (side == 1) return {1, 0, 0};
  if (side % 2 == 0) return {0.5f, 0.5f, 0};
  const uint32_t half = side / 2;
  const auto of_side = [&](uint32_t n) { return static_cast<float>(n) / static_cast<float>(side); };
  return {of_side(half - i), of_side(half), of_side(i + 1)};
}

uint32_t halved(uint32_t side) { return std::max(side / 2, 1u); }

}  // namespace

std::vector<LevelSize> level_sizes(uint32_t width, uint32_t height) {
  std::vector<LevelSize> sizes = {{width, height}};
  while (sizes.back().width > 1 || sizes.back().height > 1)
    sizes.push_back({halved(sizes.back().width), halved(sizes.back().height)});
  return sizes;
}

LevelRows::LevelRows(uint32_t width, uint32_t height, uint32_t channels, Take take, void* context)
    : channels_(channels), take_(take), context_(context) {
  const std::vector<LevelSize> sizes = level_sizes(width, height);
  for (size_t level = 0; level + 1 < sizes.size(); ++level) {
    const size_t next = size_t{sizes[level + 1].width} * channels;
    levels_.push_back({sizes[level], 0, std::vector<float>(next), std::vector<float>(next)});
  }
}

void LevelRows::emit(size_t level) {
  Level& l = levels_[level];
  take_(context_, static_cast<uint32_t>(level + 1), l.sum.data());
  add(level + 1, l.sum.data());
  std::fill(l.sum.begin(), l.sum.end(), 0.0f);
}

void LevelRows::add(size_t level, const float* row) {
  if (level >= levels_.size()) return;
  Level& l = levels_[level];
  const auto [width, height] = l.size;
  for (uint32_t i = 0; i < halved(width); ++i) {
    const Shares s = shares(width, i);
    // Shares of 0 are beyond the row's end.
    const size_t at = size_t{2 * i} * channels_;
    for (uint32_t c = 0; c < channels_; ++c) {
      float sum = s.first * row[at + c];
      if (s.second > 0) sum += s.second * row[at + channels_ + c];
      if (s.third > 0) sum += s.third * row[at + 2 * channels_ + c];
      l.narrow[i * channels_ + c] = sum;
    }
  }
  const auto gather = [&](float share) {
    for (size_t k = 0; k < l.sum.size(); ++k) l.sum[k] += share * l.narrow[k];
  };
  const uint32_t nth = l.rows++, i = nth / 2;
  if (height == 1) {
    gather(1);
    return emit(level);
  }
  if (nth % 2 == 1) {
    gather(shares(height, i).second);
    if (height % 2 == 0) emit(level);
    return;
  }
  if (height % 2 == 1 && nth > 0) {  // the row is the last of one and the first of the next
    gather(shares(height, i - 1).third);
    emit(level);
  }
  if (nth + 1 < height) gather(shares(height, i).first);
}

}  // namespace metamer
