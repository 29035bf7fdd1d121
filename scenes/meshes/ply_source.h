// Where the numbers of a PLY file come from: text, or bytes of either order. Both sources have the same two
// functions; they return false at the end of the file or at something that is not a number, and stay there.
#pragma once
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <string_view>

#include "scenes/meshes/ply_header.h"

namespace metamer::ply {

class AsciiSource {
 public:
  AsciiSource(std::string_view file, size_t begin)
      : begin_(file.data()), at_(file.data() + begin), end_(file.data() + file.size()) {}

  size_t offset() const { return static_cast<size_t>(at_ - begin_); }
  bool at_end() {
    skip_space();
    return at_ == end_;
  }

  // In text the type of a number does not matter. Numbers beyond double precision become infinities or zeros.
  bool read(Type, double& value) {
    skip_space();
    if (at_ != end_ && *at_ == '+') ++at_;
    const auto [rest, status] = std::from_chars(at_, end_, value);
    if (status == std::errc::invalid_argument || (rest != end_ && !is_space(*rest))) return false;
    if (status == std::errc::result_out_of_range) value = std::numeric_limits<double>::infinity();
    at_ = rest;
    return true;
  }
  bool skip(Type type, uint64_t count) {
    double ignored;
    for (uint64_t i = 0; i < count; ++i)
      if (!read(type, ignored)) return false;
    return true;
  }
  // Whether that many numbers may still follow: each takes a digit and a separator.
  bool may_hold(Type, uint64_t count) const { return count <= (static_cast<uint64_t>(end_ - at_) + 1) / 2; }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  void skip_space() {
    while (at_ != end_ && is_space(*at_)) ++at_;
  }

  const char* begin_;
  const char* at_;
  const char* end_;
};

template <std::endian order>
class BinarySource {
 public:
  BinarySource(std::string_view file, size_t begin)
      : begin_(file.data()), at_(file.data() + begin), end_(file.data() + file.size()) {}

  size_t offset() const { return static_cast<size_t>(at_ - begin_); }
  bool at_end() const { return at_ == end_; }

  bool read(Type type, double& value) {
    switch (type) {
      case Type::int8: return read_as<int8_t>(value);
      case Type::uint8: return read_as<uint8_t>(value);
      case Type::int16: return read_as<int16_t>(value);
      case Type::uint16: return read_as<uint16_t>(value);
      case Type::int32: return read_as<int32_t>(value);
      case Type::uint32: return read_as<uint32_t>(value);
      case Type::float32: return read_as<float>(value);
      case Type::float64: return read_as<double>(value);
    }
    return false;
  }
  bool skip(Type type, uint64_t count) {
    if (!may_hold(type, count)) return false;
    at_ += count * size_of(type);
    return true;
  }
  bool may_hold(Type type, uint64_t count) const { return count <= static_cast<uint64_t>(end_ - at_) / size_of(type); }

 private:
  template <class T>
  bool read_as(double& value) {
    if (static_cast<size_t>(end_ - at_) < sizeof(T)) return false;
    char bytes[sizeof(T)];
    if constexpr (order == std::endian::native) {
      std::memcpy(bytes, at_, sizeof(T));
    } else {
      for (size_t i = 0; i < sizeof(T); ++i) bytes[i] = at_[sizeof(T) - 1 - i];
    }
    at_ += sizeof(T);
    T number;
    std::memcpy(&number, bytes, sizeof(T));
    value = static_cast<double>(number);
    return true;
  }

  const char* begin_;
  const char* at_;
  const char* end_;
};

}  // namespace metamer::ply
