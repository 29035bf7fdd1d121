// Typed reading of JSON values with messages that say what was found and what was expected. A value that is wrong is
// reported and replaced by a harmless one, so that reading goes on and finds the other mistakes.
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scenes/native/json_document.h"
#include "scenes/native/keys.h"

namespace metamer {

inline constexpr double largest_float = 3.4028234663852886e38;

// What a number may be, once it is rounded to single precision. Ends count unless they are open.
struct Range {
  double low, high;
  bool is_low_open = false, is_high_open = false;
  bool contains(double number) const {
    if (!(number >= -largest_float && number <= largest_float)) return false;
    const double x = static_cast<float>(number);
    return (is_low_open ? x > low : x >= low) && (is_high_open ? x < high : x <= high);
  }
};
inline constexpr Range any_number{-largest_float, largest_float};
inline constexpr Range not_negative{0, largest_float};
inline constexpr Range positive{0, largest_float, true};
inline constexpr Range unit_interval{0, 1};

// "a number from 0 to 1", "a number above 0", ...
std::string describe_range(const Range& range, std::string_view noun = "a number");

class JsonReader {
 public:
  JsonReader(const JsonDocument& document, Diagnostics& diagnostics) : document_(document), diagnostics_(diagnostics) {}

  void error(const Json::Value& at, const std::string& message) const {
    diagnostics_.error(document_.at(at), subject_.empty() ? message : message + " (in " + subject_ + ")");
  }
  // Whose mistakes those to come are, for their messages; empty: nobody's in particular.
  void set_subject(std::string subject) { subject_ = std::move(subject); }
  // "'what' is FOUND; expected EXPECTED".
  void expected(const Json::Value& value, std::string_view what, std::string_view expected) const;

  double number(const Json::Value& value, std::string_view what, const Range& range, double fallback) const;
  uint32_t integer(const Json::Value& value, std::string_view what, uint32_t low, uint32_t high,
                   uint32_t fallback) const;
  bool boolean(const Json::Value& value, std::string_view what, bool fallback) const;
  // Empty where it is not a string or an empty one, which is a mistake.
  std::string text(const Json::Value& value, std::string_view what) const;
  // The index of the string among the words, or 0.
  size_t choice(const Json::Value& value, std::string_view what, std::span<const std::string_view> words) const;
  // `out.size()` numbers. False, and out untouched, where they are not.
  bool numbers(const Json::Value& value, std::string_view what, const Range& range, std::span<double> out) const;
  glm::dvec3 vector(const Json::Value& value, std::string_view what, const glm::dvec3& fallback) const;
  bool array(const Json::Value& value, std::string_view what, std::string_view of) const;

  const JsonDocument& document() const { return document_; }
  Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  const JsonDocument& document_;
  Diagnostics& diagnostics_;
  std::string subject_;
};

// An object of the format. On construction unknown and missing keys are reported.
class JsonObject {
 public:
  JsonObject(const JsonReader& reader, const Json::Value& value, const ObjectSpec& spec, std::string_view what);
  // One that comes in types: the spec is that of "family.TYPE" with TYPE the value of the key "type". Invalid without.
  JsonObject(const JsonReader& reader, const Json::Value& value, std::string_view family);

  bool is_valid() const { return spec_ != nullptr; }
  const Json::Value& value() const { return value_; }
  std::string_view type() const;  // "sphere" of "geometry.sphere"

  // Whether the spec has the key.
  bool knows(std::string_view key) const;
  // The value of a key of the spec, or null.
  const Json::Value* find(std::string_view key) const;
  // Whether the key is there; of a key that the spec does not have it is not.
  bool has(std::string_view key) const { return knows(key) && find(key) != nullptr; }
  // The one key of several that is there; where none or more than one is, that is reported, and empty.
  std::string_view one_of(std::span<const std::string_view> keys) const;

  double number(std::string_view key, const Range& range, double fallback) const;
  float number_f(std::string_view key, const Range& range, float fallback) const {
    return static_cast<float>(number(key, range, fallback));
  }
  uint32_t integer(std::string_view key, uint32_t low, uint32_t high, uint32_t fallback) const;
  bool boolean(std::string_view key, bool fallback) const;
  size_t choice(std::string_view key, std::span<const std::string_view> words, size_t fallback) const;

 private:
  void check_keys(std::string_view what) const;

  const JsonReader& reader_;
  const Json::Value& value_;
  const ObjectSpec* spec_ = nullptr;
};

}  // namespace metamer
