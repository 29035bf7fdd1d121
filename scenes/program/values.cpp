#include "scenes/program/values.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "engine/diagnostics.h"

namespace metamer {
namespace {

// All of the text as one number, or nothing.
template <class T>
std::optional<T> number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool is_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace

std::optional<uint32_t> parse_count(std::string_view flag, std::string_view text, uint32_t least, uint32_t most,
                                    Mistakes& mistakes) {
  const std::optional<uint32_t> value = number<uint32_t>(text);
  if (value && *value >= least && *value <= most) return value;
  mistakes.push_back(fmt::format("{}: expected a whole number from {} to {}, not '{}'", flag, least, most, text));
  return std::nullopt;
}

std::optional<uint64_t> parse_bytes(std::string_view flag, std::string_view text, uint64_t least, Mistakes& mistakes) {
  constexpr std::pair<std::string_view, int> units[] = {{"k", 10}, {"m", 20}, {"g", 30}, {"t", 40}};
  const std::string lower = in_lower_case(text);
  std::string_view digits = lower;
  if (digits.ends_with("ib")) digits.remove_suffix(2);
  int shift = 0;
  for (const auto& [unit, bits] : units)
    if (shift == 0 && digits.ends_with(unit)) {
      digits.remove_suffix(1);
      shift = bits;
    }
  const std::optional<uint64_t> value = number<uint64_t>(digits);
  if (value && *value <= (~uint64_t{0} >> shift) && (digits.size() == lower.size() || shift > 0) &&
      (*value << shift) >= least)
    return *value << shift;
  mistakes.push_back(
      fmt::format("{}: expected bytes, such as 512M or 2G, of at least {}M, not '{}'", flag, least >> 20, text));
  return std::nullopt;
}

std::optional<float> parse_real(std::string_view flag, std::string_view text, float least, float most,
                                Mistakes& mistakes, std::string_view or_else) {
  std::string_view digits = text;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  const std::optional<float> value = number<float>(digits);
  if (value && *value >= least && *value <= most) return value;  // false for not-a-number
  mistakes.push_back(fmt::format("{}: expected a number from {} to {}{}, not '{}'", flag, least, most, or_else, text));
  return std::nullopt;
}

std::optional<size_t> parse_name(std::string_view flag, std::string_view text, std::span<const std::string_view> names,
                                 Mistakes& mistakes) {
  const std::string word = in_lower_case(text);
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == word) return i;
  mistakes.push_back(fmt::format("{}: unknown name '{}'{}; there are {}", flag, text, did_you_mean(word, names),
                                 fmt::join(names, ", ")));
  return std::nullopt;
}

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::optional<std::pair<uint32_t, uint32_t>> parse_size(std::string_view flag, std::string_view text,
                                                        Mistakes& mistakes) {
  const size_t x = text.find_first_of("xX");
  const std::string_view width_text = text.substr(0, x);
  const std::string_view height_text = x == std::string_view::npos ? "" : text.substr(x + 1);
  if (!is_digits(width_text) || !is_digits(height_text)) {
    mistakes.push_back(fmt::format("{}: expected WIDTHxHEIGHT in pixels, such as 640x360, not '{}'", flag, text));
    return std::nullopt;
  }
  const std::optional<uint32_t> width = number<uint32_t>(width_text), height = number<uint32_t>(height_text);
  if (!width || !height) {
    mistakes.push_back(fmt::format("{}: a frame of {} is too large", flag, text));
    return std::nullopt;
  }
  if (*width == 0 || *height == 0) {
    mistakes.push_back(fmt::format("{}: a frame of {} has no pixels", flag, text));
    return std::nullopt;
  }
  return std::pair(*width, *height);
}

}  // namespace metamer
