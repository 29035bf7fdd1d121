#include "scenes/gzip.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>
#include <string_view>

namespace metamer {
namespace {

constexpr int gzip_only = 16 + MAX_WBITS;  // zlib's word for the gzip format, checked by its CRC

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

// Unpacks a whole file: one member after another, as `gunzip` does.
class Inflater {
 public:
  explicit Inflater(std::string_view packed) : packed_(packed), limit_(most_unpacked_bytes(packed.size())) {}
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&stream_); }

  // What is wrong, or nothing.
  std::string unpack(FileBytes& out) {
    if (inflateInit2(&stream_, gzip_only) != Z_OK) return "zlib could not be started";
    grow(std::max<size_t>(stated_size(), 1));
    for (;;) {
      const int status = step();
      if (status == Z_STREAM_END) {
        const std::string_view rest = packed_.substr(read_);
        // Archives pad with zeros.
        if (rest.find_first_not_of('\0') == std::string_view::npos) break;
        if (!is_gzip(rest)) return "it has bytes behind the end of the compressed data";
        inflateReset(&stream_);
      } else if (status == Z_BUF_ERROR && read_ == packed_.size() && written_ < capacity_) {
        return "the compressed data ends too early; the file was cut short";
      } else if (status != Z_OK && status != Z_BUF_ERROR) {
        return fmt::format("the compressed data is damaged{}{}", stream_.msg != nullptr ? ": " : "",
                           stream_.msg != nullptr ? stream_.msg : "");
      }
      if (written_ < capacity_) continue;
      if (capacity_ >= limit_) {
        return fmt::format("its {} bytes unpack to more than {}, which no scene or mesh does", packed_.size(), limit_);
      }
      grow(capacity_ * 2);
    }
    out.data = std::move(data_);
    out.size = written_;
    return {};
  }

 private:
  // What the file says its last member unpacks to, modulo 2^32 and not to be trusted, and one byte to see the end in.
  size_t stated_size() const {
    uint8_t bytes[4] = {};
    if (packed_.size() >= 8) std::memcpy(bytes, packed_.data() + packed_.size() - 4, 4);
    return size_t{bytes[0]} + (size_t{bytes[1]} << 8) + (size_t{bytes[2]} << 16) + (size_t{bytes[3]} << 24) + 1;
  }

  void grow(size_t wanted) {
    const size_t capacity = std::min(wanted, limit_);
    auto data = std::make_unique_for_overwrite<char[]>(capacity);
    if (written_ > 0) std::memcpy(data.get(), data_.get(), written_);
    data_ = std::move(data);
    capacity_ = capacity;
  }

  int step() {
    constexpr size_t most = std::numeric_limits<uInt>::max();
    const size_t in = std::min(packed_.size() - read_, most), room = std::min(capacity_ - written_, most);
    // zlib's interface is older than const.
    stream_.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed_.data() + read_));
    stream_.avail_in = static_cast<uInt>(in);
    stream_.next_out = reinterpret_cast<Bytef*>(data_.get() + written_);
    stream_.avail_out = static_cast<uInt>(room);
    const int status = inflate(&stream_, Z_NO_FLUSH);
    read_ += in - stream_.avail_in;
    written_ += room - stream_.avail_out;
    return status;
  }

  std::string_view packed_;
  size_t limit_;
  z_stream stream_ = {};
  std::unique_ptr<char[]> data_;
  size_t capacity_ = 0, written_ = 0, read_ = 0;
};

}  // namespace

bool read_packed_file(const std::string& path, const SourceLocation& named_at, FileBytes& bytes,
                      Diagnostics& diagnostics) {
  if (!read_file(path, named_at, bytes, diagnostics)) return false;
  if (!is_gzip(bytes.text())) return true;
  FileBytes unpacked;
  std::string mistake;
  try {
    mistake = Inflater(bytes.text()).unpack(unpacked);
  } catch (const std::bad_alloc&) {
    mistake = "what it unpacks to does not fit in memory";
  }
  if (mistake.empty()) {
    bytes = std::move(unpacked);
    return true;
  }
  diagnostics.error(named_at, fmt::format("cannot unpack '{}': {}", path, mistake));
  return false;
}

bool inflate_zlib(std::string_view packed, std::span<char> out) {
  uLongf unpacked = out.size();
  const int status = uncompress(reinterpret_cast<Bytef*>(out.data()), &unpacked,
                                reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  return status == Z_OK && unpacked == out.size();
}

std::string packed_file_extension(const std::string& path) {
  const std::string extension = file_extension(path);
  return extension == "gz" ? file_extension(path.substr(0, path.size() - 3)) : extension;
}

}  // namespace metamer
