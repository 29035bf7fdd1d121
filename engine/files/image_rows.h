// Image files row by row, so that no more of them than a strip need be in memory.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>

#include "engine/ecs/scene.h"

namespace metamer {

// Reads EXR, HDR, PFM, PNG, JPEG, TGA and what else OpenImageIO knows as linear RGB from the top row down. Channels of
// 8 or 16 bits are decoded; floating-point ones are linear. Grey fills all three channels.
class ImageRows {
 public:
  ImageRows();
  ~ImageRows();
  // False: `error()` says why.
  bool open(const std::string& path, const ImageEncoding& encoding);
  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  bool has_alpha() const { return alpha_ >= 0; }  // a channel of it; it may be 1 everywhere
  // x and y of red, green, blue and white, where the file says so.
  const std::optional<std::array<float, 8>>& chromaticities() const { return chromaticities_; }
  // The next row: 3 * width numbers, and, unless `alpha` is null or there is none, width.
  bool next(float* rgb, float* alpha);
  const std::string& error() const { return error_; }

 private:
  bool read_strip();

  struct File;
  std::unique_ptr<File> file_;
  uint32_t width_ = 0, height_ = 0, row_ = 0;  // the next one
  uint32_t strip_rows_ = 1, strip_begin_ = 0, strip_end_ = 0;
  size_t channels_ = 0;
  std::array<int, 3> rgb_{};
  int alpha_ = -1;
  bool decodes_alpha_ = false;
  std::optional<std::array<float, 8>> chromaticities_;
  std::vector<float> decoded_;  // by code; empty: the file's numbers are linear
  std::vector<float> strip_;
  std::string error_;
};

}  // namespace metamer
