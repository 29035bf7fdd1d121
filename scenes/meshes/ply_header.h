// The header of a PLY file: what elements follow, of how many rows, with which properties.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/diagnostics.h"

namespace metamer::ply {

enum class Format : uint8_t { ascii, binary_little_endian, binary_big_endian };
enum class Type : uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
size_t size_of(Type type);  // bytes

struct Property {
  std::string name;
  Type type = Type::float32;  // of the entries, for a list
  bool is_list = false;
  Type count_type = Type::uint8;  // lists only
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;
  uint32_t line = 0;
};

struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
  size_t end = 0;  // byte offset of the first row
};

// Every mistake of the header is reported with its line. Elements that need more bytes than follow are mistakes, so
// that rows may be reserved without fear.
std::optional<Header> parse_header(std::string_view file, const std::string& path, Diagnostics& diagnostics);

// The 1-based line of a byte offset.
uint32_t line_of(std::string_view file, size_t offset);

}  // namespace metamer::ply
