// JSON on its way to a file: members keep the order in which they were added, numbers are as short as reading them back
// allows, and what fits in a line stands in a line.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace metamer {

// The text in UTF-8, bytes that are not as if they were Latin-1, and '?' for control characters.
std::string valid_text(std::string_view text);

// The shortest number that reads back, through double precision, as exactly this one. Finite.
std::string number_text(float value);

class JsonText {
 public:
  static JsonText number(float value) { return {Kind::scalar, number_text(value)}; }
  static JsonText number(double value);
  static JsonText decimal(std::string digits) { return {Kind::scalar, std::move(digits)}; }
  static JsonText integer(uint64_t value) { return {Kind::scalar, std::to_string(value)}; }
  static JsonText boolean(bool value) { return {Kind::scalar, value ? "true" : "false"}; }
  static JsonText string(std::string_view text);
  static JsonText array() { return {Kind::array, {}}; }
  static JsonText numbers(std::span<const float> values);
  static JsonText numbers(std::span<const double> values);
  static JsonText object() { return {Kind::object, {}}; }

  JsonText& add(JsonText item);
  JsonText& add(std::string_view key, JsonText value);
  // Its members stand on lines of their own even where they would fit in one.
  JsonText& break_lines();

  bool empty() const { return items_.empty(); }
  bool operator==(const JsonText&) const = default;

  // The whole text, a line break at its end.
  std::string text() const;

 private:
  enum class Kind : uint8_t { scalar, array, object };
  JsonText(Kind kind, std::string text) : kind_(kind), text_(std::move(text)), width_(text_.size()) {}

  void append_in_line(std::string& out) const;
  void append(std::string& out, size_t indent, size_t column) const;
  void append_filled(std::string& out, size_t indent) const;
  bool is_of_scalars() const;

  Kind kind_;
  std::string text_;               // of a scalar
  std::vector<std::string> keys_;  // of an object, quoted
  std::vector<JsonText> items_;    // of an array or object
  size_t width_;                   // characters in one line
  bool is_broken_ = false;
};

}  // namespace metamer
