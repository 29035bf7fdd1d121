#include "scenes/native/json_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace metamer {
namespace {

const Json::Value* find_member(const Json::Value& object, std::string_view key) {
  return object.find(key.data(), key.data() + key.size());
}

std::string quoted_list(std::span<const std::string_view> words) {
  std::string list;
  for (size_t i = 0; i < words.size(); ++i)
    list += fmt::format("{}'{}'", i == 0 ? "" : i + 1 == words.size() ? " or " : ", ", words[i]);
  return list;
}

}  // namespace

std::string describe_range(const Range& range, std::string_view noun) {
  const bool has_low = range.low > -largest_float, has_high = range.high < largest_float;
  if (has_low && has_high && !range.is_low_open && !range.is_high_open)
    return fmt::format("{} from {} to {}", noun, range.low, range.high);
  std::string text(noun);
  if (has_low) text += fmt::format(" {} {}", range.is_low_open ? "above" : "of at least", range.low);
  if (has_high)
    text += fmt::format("{} {} {}", has_low ? " and" : "", range.is_high_open ? "below" : "of at most", range.high);
  return has_low || has_high ? text : fmt::format("{} within single precision", noun);
}

void JsonReader::expected(const Json::Value& value, std::string_view what, std::string_view expected) const {
  error(value, fmt::format("'{}' is {}; expected {}", what, describe_value(value), expected));
}

double JsonReader::number(const Json::Value& value, std::string_view what, const Range& range, double fallback) const {
  // In JsonCpp true and false pass for numbers.
  if (value.isNumeric() && !value.isBool() && range.contains(value.asDouble())) return value.asDouble();
  expected(value, what, describe_range(range));
  return fallback;
}

uint32_t JsonReader::integer(const Json::Value& value, std::string_view what, uint32_t low, uint32_t high,
                             uint32_t fallback) const {
  const bool good = value.isNumeric() && !value.isBool() && value.asDouble() >= low && value.asDouble() <= high &&
                    value.asDouble() == std::floor(value.asDouble());
  if (good) return static_cast<uint32_t>(value.asDouble());
  expected(value, what, low == high ? fmt::format("{}", low) : fmt::format("a whole number from {} to {}", low, high));
  return fallback;
}

bool JsonReader::boolean(const Json::Value& value, std::string_view what, bool fallback) const {
  if (value.isBool()) return value.asBool();
  expected(value, what, "true or false");
  return fallback;
}

std::string JsonReader::text(const Json::Value& value, std::string_view what) const {
  if (value.isString() && !value.asString().empty()) return value.asString();
  expected(value, what, "a string with at least one character");
  return {};
}

size_t JsonReader::choice(const Json::Value& value, std::string_view what,
                          std::span<const std::string_view> words) const {
  if (value.isString()) {
    const std::string word = value.asString();
    for (size_t i = 0; i < words.size(); ++i)
      if (words[i] == word) return i;
    expected(value, what, quoted_list(words) + did_you_mean(word, words));
  } else {
    expected(value, what, quoted_list(words));
  }
  return 0;
}

bool JsonReader::numbers(const Json::Value& value, std::string_view what, const Range& range,
                         std::span<double> out) const {
  if (!value.isArray() || value.size() != out.size()) {
    expected(value, what, fmt::format("an array of {} numbers", out.size()));
    return false;
  }
  const size_t errors_before = diagnostics_.error_count();
  std::array<double, 16> found;
  assert(out.size() <= found.size());
  for (Json::ArrayIndex i = 0; i < value.size(); ++i)
    found[i] = number(value[i], fmt::format("{}[{}]", what, i), range, 0);
  if (diagnostics_.error_count() != errors_before) return false;
  std::copy_n(found.begin(), out.size(), out.begin());
  return true;
}

glm::dvec3 JsonReader::vector(const Json::Value& value, std::string_view what, const glm::dvec3& fallback) const {
  std::array<double, 3> xyz{fallback.x, fallback.y, fallback.z};
  numbers(value, what, any_number, xyz);
  return {xyz[0], xyz[1], xyz[2]};
}

bool JsonReader::array(const Json::Value& value, std::string_view what, std::string_view of) const {
  if (value.isArray()) return true;
  expected(value, what, fmt::format("an array of {}", of));
  return false;
}

JsonObject::JsonObject(const JsonReader& reader, const Json::Value& value, const ObjectSpec& spec,
                       std::string_view what)
    : reader_(reader), value_(value) {
  if (!value.isObject()) {
    reader.expected(value, what, "an object");
    return;
  }
  spec_ = &spec;
  check_keys(what);
}

JsonObject::JsonObject(const JsonReader& reader, const Json::Value& value, std::string_view family)
    : reader_(reader), value_(value) {
  std::vector<std::string_view> types;
  for (const ObjectSpec& spec : all_object_specs())
    if (spec.name.starts_with(family) && spec.name.substr(family.size()).starts_with('.'))
      types.push_back(spec.name.substr(family.size() + 1));
  if (!value.isObject()) {
    reader.expected(value, family, fmt::format("an object with a 'type' of {}", quoted_list(types)));
    return;
  }
  const Json::Value* type = find_member(value, "type");
  if (type == nullptr) {
    reader.error(value, fmt::format("'{}' has no 'type'; expected {}", family, quoted_list(types)));
    return;
  }
  const size_t errors_before = reader.diagnostics().error_count();
  const size_t chosen = reader.choice(*type, "type", types);
  if (reader.diagnostics().error_count() != errors_before) return;
  spec_ = find_object_spec(fmt::format("{}.{}", family, types[chosen]));
  check_keys(fmt::format("{} of type '{}'", family, types[chosen]));
}

void JsonObject::check_keys(std::string_view what) const {
  std::vector<std::string_view> known;
  for (const KeySpec& key : spec_->keys) known.push_back(key.name);
  for (auto it = value_.begin(); it != value_.end(); ++it) {
    const std::string key = it.name();
    if (is_repeated_key(key)) continue;
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string hint = did_you_mean(key, known);
    reader_.diagnostics().error(reader_.document().at_key(*it),
                                fmt::format("unknown key '{}' in {}{}", printable_text(key), what,
                                            hint.empty() ? fmt::format("; it may have {}", quoted_list(known)) : hint));
  }
  for (const KeySpec& key : spec_->keys)
    if (key.is_required && find_member(value_, key.name) == nullptr)
      reader_.error(value_, fmt::format("{} lacks the required key '{}'", what, key.name));
}

std::string_view JsonObject::type() const { return spec_->name.substr(spec_->name.find('.') + 1); }

bool JsonObject::knows(std::string_view key) const {
  return spec_ != nullptr &&
         std::any_of(spec_->keys.begin(), spec_->keys.end(), [&](const KeySpec& k) { return k.name == key; });
}

const Json::Value* JsonObject::find(std::string_view key) const {
  if (spec_ == nullptr) return nullptr;
  assert(knows(key));
  return find_member(value_, key);
}

std::string_view JsonObject::one_of(std::span<const std::string_view> keys) const {
  std::string_view found;
  for (const std::string_view key : keys) {
    if (!has(key)) continue;
    if (!found.empty()) {
      reader_.error(*find(key), fmt::format("'{}' and '{}' exclude each other", found, key));
      return {};
    }
    found = key;
  }
  if (found.empty() && is_valid()) reader_.error(value_, fmt::format("expected {}", quoted_list(keys)));
  return found;
}

double JsonObject::number(std::string_view key, const Range& range, double fallback) const {
  const Json::Value* found = find(key);
  return found == nullptr ? fallback : reader_.number(*found, key, range, fallback);
}

uint32_t JsonObject::integer(std::string_view key, uint32_t low, uint32_t high, uint32_t fallback) const {
  const Json::Value* found = find(key);
  return found == nullptr ? fallback : reader_.integer(*found, key, low, high, fallback);
}

bool JsonObject::boolean(std::string_view key, bool fallback) const {
  const Json::Value* found = find(key);
  return found == nullptr ? fallback : reader_.boolean(*found, key, fallback);
}

size_t JsonObject::choice(std::string_view key, std::span<const std::string_view> words, size_t fallback) const {
  const Json::Value* found = find(key);
  return found == nullptr ? fallback : reader_.choice(*found, key, words);
}

}  // namespace metamer
