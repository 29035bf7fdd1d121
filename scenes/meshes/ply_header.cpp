#include "scenes/meshes/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace metamer::ply {
namespace {

constexpr size_t longest_line = 4096;  // a header line; beyond it this is no PLY
constexpr size_t most_properties = 4096;

constexpr std::pair<std::string_view, Type> type_names[] = {
    {"char", Type::int8},     {"int8", Type::int8},       {"uchar", Type::uint8},    {"uint8", Type::uint8},
    {"short", Type::int16},   {"int16", Type::int16},     {"ushort", Type::uint16},  {"uint16", Type::uint16},
    {"int", Type::int32},     {"int32", Type::int32},     {"uint", Type::uint32},    {"uint32", Type::uint32},
    {"float", Type::float32}, {"float32", Type::float32}, {"double", Type::float64}, {"float64", Type::float64}};

std::optional<Type> find_type(std::string_view name) {
  for (const auto& [known, type] : type_names)
    if (known == name) return type;
  return std::nullopt;
}

std::vector<std::string_view> split_words(std::string_view line) {
  std::vector<std::string_view> words;
  for (size_t at = 0; at < line.size();) {
    const size_t begin = line.find_first_not_of(" \t", at);
    if (begin == std::string_view::npos) break;
    at = std::min(line.find_first_of(" \t", begin), line.size());
    words.push_back(line.substr(begin, at - begin));
  }
  return words;
}

// A header word as it may be printed: control characters and over-long garbage do not reach the terminal.
std::string printable(std::string_view word) {
  std::string text(word.substr(0, 40));
  for (char& c : text)
    if (c < 0x20 || c > 0x7e) c = '?';
  return word.size() > 40 ? text + "..." : text;
}

class HeaderParser {
 public:
  HeaderParser(std::string_view file, const std::string& path, Diagnostics& diagnostics)
      : file_(file), path_(path), diagnostics_(diagnostics) {}

  std::optional<Header> parse() {
    const size_t errors_before = diagnostics_.error_count();
    if (!find_line_end() || !read_lines()) return std::nullopt;
    if (!has_format_) error("the header has no 'format' line");
    if (diagnostics_.error_count() == errors_before) check_sizes();
    if (diagnostics_.error_count() != errors_before) return std::nullopt;
    return std::move(header_);
  }

 private:
  void error(const std::string& message) { diagnostics_.error({path_, line_}, message); }

  // The first line decides how lines end: after a lone carriage return a binary row may well begin with a line feed.
  bool find_line_end() {
    line_ = 1;
    if (file_.starts_with("ply\r\n")) {
      line_end_ = "\r\n";
    } else if (file_.starts_with("ply\n")) {
      line_end_ = "\n";
    } else if (file_.starts_with("ply\r")) {
      line_end_ = "\r";
    } else {
      error(file_.empty() ? "the file is empty; expected a PLY mesh" : "not a PLY file: the first line must be 'ply'");
      return false;
    }
    header_.end = 3 + line_end_.size();
    return true;
  }

  bool read_lines() {
    while (true) {
      ++line_;
      const size_t end = file_.find(line_end_, header_.end);
      const size_t length = std::min(end, file_.size()) - header_.end;
      if (end == std::string_view::npos && file_.substr(header_.end) != "end_header") {
        error("the header ends without 'end_header'");
        return false;
      }
      if (length > longest_line) {
        error(fmt::format("a header line of {} bytes; this is not a PLY file", length));
        return false;
      }
      const auto words = split_words(file_.substr(header_.end, length));
      header_.end = end == std::string_view::npos ? file_.size() : end + line_end_.size();
      if (!words.empty() && words[0] == "end_header") return true;
      if (!read_statement(words)) return false;
    }
  }

  // False where going on would only produce noise.
  bool read_statement(const std::vector<std::string_view>& words) {
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return true;
    if (words[0] == "format") return read_format(words);
    if (words[0] == "element") return read_element(words);
    if (words[0] == "property") return read_property(words);
    error(fmt::format("unknown header word '{}'; expected format, comment, obj_info, element, property or end_header",
                      printable(words[0])));
    return false;
  }

  bool read_format(const std::vector<std::string_view>& words) {
    constexpr std::string_view names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    const std::string_view name = words.size() > 1 ? words[1] : std::string_view();
    const auto found = std::find(std::begin(names), std::end(names), name);
    if (found == std::end(names) || words.size() != 3 || words[2] != "1.0") {
      error("expected 'format ascii 1.0', 'format binary_little_endian 1.0' or 'format binary_big_endian 1.0'");
      return false;
    }
    header_.format = static_cast<Format>(found - std::begin(names));
    has_format_ = true;
    return true;
  }

  bool read_element(const std::vector<std::string_view>& words) {
    uint64_t count = 0;
    bool good = words.size() == 3;
    if (good) {
      const auto [rest, status] = std::from_chars(words[2].begin(), words[2].end(), count);
      good = status == std::errc() && rest == words[2].end();
    }
    if (!good) {
      error("expected 'element NAME COUNT' with a count from 0 to 2^64-1");
      return false;
    }
    for (const Element& other : header_.elements) {
      if (other.name == words[1]) error(fmt::format("element '{}' is declared twice", printable(words[1])));
    }
    header_.elements.push_back({std::string(words[1]), count, {}, line_});
    return true;
  }

  bool read_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) {
      error("'property' before the first 'element'");
      return false;
    }
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (!is_list && words.size() != 3) {
      error("expected 'property TYPE NAME' or 'property list COUNT_TYPE TYPE NAME'");
      return false;
    }
    const auto type = find_type(words[is_list ? 3 : 1]);
    const auto count_type = is_list ? find_type(words[2]) : Type::uint8;
    if (!type || !count_type) {
      error(fmt::format("unknown type '{}'; expected char, uchar, short, ushort, int, uint, float or double",
                        printable(!type ? words[is_list ? 3 : 1] : words[2])));
      return false;
    }
    if (is_list && *count_type >= Type::float32) {
      error("the count of a list must be of an integer type");
      return false;
    }
    auto& properties = header_.elements.back().properties;
    if (properties.size() >= most_properties) {
      error(fmt::format("more than {} properties in one element", most_properties));
      return false;
    }
    properties.push_back({std::string(words.back()), *type, is_list, *count_type});
    return true;
  }

  // The least bytes a row takes: an empty list for each list; in ascii a digit and a separator per number.
  void check_sizes() {
    const uint64_t available = file_.size() - header_.end;
    for (const Element& element : header_.elements) {
      uint64_t row = 0;
      for (const Property& p : element.properties) {
        row += header_.format == Format::ascii ? 2 : size_of(p.is_list ? p.count_type : p.type);
      }
      // In ascii the last number of the file needs no separator.
      if (row == 0 || element.count <= (available + 1) / row) continue;
      diagnostics_.error({path_, element.line},
                         fmt::format("declares {} rows of '{}', at least {} bytes each, but only {} bytes follow the "
                                     "header; the file was cut short or its header is wrong",
                                     element.count, printable(element.name), row, available));
    }
  }

  std::string_view file_;
  const std::string& path_;
  Diagnostics& diagnostics_;
  Header header_;
  std::string_view line_end_;
  uint32_t line_ = 1;
  bool has_format_ = false;
};

}  // namespace

size_t size_of(Type type) {
  constexpr std::array<size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<size_t>(type)];
}

std::optional<Header> parse_header(std::string_view file, const std::string& path, Diagnostics& diagnostics) {
  return HeaderParser(file, path, diagnostics).parse();
}

uint32_t line_of(std::string_view file, size_t offset) {
  uint32_t line = 1;
  for (size_t i = 0; i < std::min(offset, file.size()); ++i) {
    // A line ends with "\n", "\r\n" or "\r".
    if (file[i] == '\n' || (file[i] == '\r' && (i + 1 >= file.size() || file[i + 1] != '\n'))) ++line;
  }
  return line;
}

}  // namespace metamer::ply
