#include "engine/files/image_rows.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>

#include "engine/simd/portable_math.h"

namespace metamer {
namespace {

constexpr int64_t most_pixels = int64_t{1} << 31;
constexpr uint32_t usual_strip_rows = 64;

double decode(double encoded, const ImageEncoding& encoding) {
  if (encoding.gamma > 0) return encoding.gamma == 1 ? encoded : portable::pow(encoded, encoding.gamma);
  return encoded <= 0.04045 ? encoded / 12.92 : portable::pow((encoded + 0.055) / 1.055, 2.4);
}

// The decoded value of every code of 8 or 16 bits.
std::vector<float> decoding_table(bool is_wide, const ImageEncoding& encoding) {
  std::vector<float> table(is_wide ? 65536 : 256);
  const double last = static_cast<double>(table.size() - 1);
  for (size_t code = 0; code < table.size(); ++code)
    table[code] = static_cast<float>(decode(static_cast<double>(code) / last, encoding));
  return table;
}

// Which channels of the file are red, green and blue: by name, else the first three, or one for all of grey.
std::array<int, 3> color_channels(const OIIO::ImageSpec& spec) {
  const std::array<int, 3> named = {spec.channelindex("R"), spec.channelindex("G"), spec.channelindex("B")};
  if (named[0] >= 0 && named[1] >= 0 && named[2] >= 0) return named;
  const bool is_grey = spec.nchannels < 3;
  return is_grey ? std::array<int, 3>{0, 0, 0} : std::array<int, 3>{0, 1, 2};
}

}  // namespace

struct ImageRows::File {
  std::unique_ptr<OIIO::ImageInput> input;
};

ImageRows::ImageRows() : file_(std::make_unique<File>()) {}
ImageRows::~ImageRows() = default;

bool ImageRows::open(const std::string& path, const ImageEncoding& encoding) {
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours as the file holds them, not multiplied by its alpha
  file_->input = OIIO::ImageInput::open(path, &wishes);
  if (!file_->input) {
    error_ = OIIO::geterror();
    return false;
  }
  const OIIO::ImageSpec& spec = file_->input->spec();
  const int64_t pixels = int64_t{spec.width} * spec.height;
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.depth > 1 || pixels > most_pixels) {
    error_ = fmt::format("it has {} x {} pixels of {} channels", spec.width, spec.height, spec.nchannels);
    return false;
  }
  width_ = static_cast<uint32_t>(spec.width);
  height_ = static_cast<uint32_t>(spec.height);
  channels_ = static_cast<size_t>(spec.nchannels);
  rgb_ = color_channels(spec);
  alpha_ = spec.alpha_channel >= 0 ? spec.alpha_channel : spec.channelindex("A");
  const auto type = spec.format.basetype;
  if (type == OIIO::TypeDesc::UINT8 || type == OIIO::TypeDesc::UINT16)
    decoded_ = decoding_table(type == OIIO::TypeDesc::UINT16, encoding);
  decodes_alpha_ = encoding.decodes_alpha && !decoded_.empty();
  std::array<float, 8> named{};
  if (spec.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), named.data()))
    chromaticities_ = named;
  strip_rows_ = spec.tile_width > 0 ? static_cast<uint32_t>(spec.tile_height) : usual_strip_rows;
  strip_rows_ = std::min(strip_rows_, height_);
  return true;
}

bool ImageRows::read_strip() {
  const OIIO::ImageSpec& spec = file_->input->spec();
  strip_begin_ = row_;
  strip_end_ = std::min(row_ + strip_rows_, height_);
  try {
    strip_.resize(size_t{strip_rows_} * width_ * channels_);
  } catch (const std::bad_alloc&) {
    error_ = fmt::format("{} x {} pixels do not fit in memory", width_, strip_rows_);
    return false;
  }
  const int begin = spec.y + static_cast<int>(strip_begin_), end = spec.y + static_cast<int>(strip_end_);
  const bool read = spec.tile_width > 0
                        ? file_->input->read_tiles(0, 0, spec.x, spec.x + spec.width, begin, end, spec.z, spec.z + 1, 0,
                                                   spec.nchannels, OIIO::TypeDesc::FLOAT, strip_.data())
                        : file_->input->read_scanlines(0, 0, begin, end, spec.z, 0, spec.nchannels,
                                                       OIIO::TypeDesc::FLOAT, strip_.data());
  if (!read) error_ = file_->input->geterror();
  return read;
}

bool ImageRows::next(float* rgb, float* alpha) {
  if (row_ >= strip_end_ && !read_strip()) return false;
  const float* row = strip_.data() + size_t{row_ - strip_begin_} * width_ * channels_;
  ++row_;
  const float last_code = static_cast<float>(decoded_.size()) - 1;
  const auto decoded = [&](float value) { return decoded_[static_cast<size_t>(value * last_code + 0.5f)]; };
  for (size_t x = 0; x < width_; ++x) {
    const float* pixel = row + x * channels_;
    for (size_t c = 0; c < 3; ++c) {
      const float value = pixel[rgb_[c]];
      rgb[3 * x + c] = decoded_.empty() ? value : decoded(value);
    }
    if (alpha == nullptr || alpha_ < 0) continue;
    const float value = std::clamp(pixel[alpha_], 0.0f, 1.0f);
    alpha[x] = decodes_alpha_ ? decoded(value) : value;
  }
  return true;
}

}  // namespace metamer
