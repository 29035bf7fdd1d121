#include "scenes/native/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace metamer {
namespace {

constexpr size_t line_width = 120;

// The length of the UTF-8 sequence at the start, or 0 where there is none.
size_t utf8_length(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  const size_t length = lead < 0x80 ? 1 : lead < 0xc2 ? 0 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : lead < 0xf5 ? 4 : 0;
  if (length == 0 || text.size() < length) return 0;
  for (size_t i = 1; i < length; ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) return 0;
  return length;
}

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      out += fmt::format("\\u{:04x}", byte);
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

bool reads_back(const std::string& text, float value) {
  double read = 0;
  std::from_chars(text.data(), text.data() + text.size(), read);
  return static_cast<float>(read) == value;
}

}  // namespace

std::string valid_text(std::string_view text) {
  std::string out;
  for (size_t i = 0; i < text.size();) {
    const size_t length = utf8_length(text.substr(i));
    const auto byte = static_cast<unsigned char>(text[i]);
    if (length == 0) {
      out += static_cast<char>(0xc0 | byte >> 6);
      out += static_cast<char>(0x80 | (byte & 0x3f));
    } else if (byte < 0x20 || byte == 0x7f) {
      out += '?';
    } else {
      out += text.substr(i, length);
    }
    i += std::max<size_t>(length, 1);
  }
  return out;
}

std::string number_text(float value) {
  std::string text = fmt::format("{}", value);
  // A short number may lie so near the middle between two floats that rounding it twice ends at the other one.
  if (!reads_back(text, value)) text = fmt::format("{}", double{value});
  return text == "-0" ? "-0.0" : text;  // an integer has no negative zero
}

JsonText JsonText::string(std::string_view text) { return {Kind::scalar, quoted(text)}; }

JsonText JsonText::numbers(std::span<const float> values) {
  JsonText result = array();
  for (const float value : values) result.add(number(value));
  return result;
}

JsonText JsonText::number(double value) {
  const std::string text = fmt::format("{}", value);
  return {Kind::scalar, text == "-0" ? "-0.0" : text};
}

JsonText JsonText::numbers(std::span<const double> values) {
  JsonText result = array();
  for (const double value : values) result.add(number(value));
  return result;
}

JsonText& JsonText::add(JsonText item) {
  width_ += item.width_ + 2;
  is_broken_ = is_broken_ || item.is_broken_;
  items_.push_back(std::move(item));
  return *this;
}

JsonText& JsonText::add(std::string_view key, JsonText value) {
  keys_.push_back(quoted(key));
  width_ += keys_.back().size() + 2;
  return add(std::move(value));
}

JsonText& JsonText::break_lines() {
  is_broken_ = true;
  return *this;
}

bool JsonText::is_of_scalars() const {
  return std::all_of(items_.begin(), items_.end(), [](const JsonText& item) { return item.kind_ == Kind::scalar; });
}

void JsonText::append_in_line(std::string& out) const {
  if (kind_ == Kind::scalar) {
    out += text_;
    return;
  }
  const bool is_object = kind_ == Kind::object;
  out += is_object ? (items_.empty() ? "{" : "{ ") : "[";
  for (size_t i = 0; i < items_.size(); ++i) {
    if (i > 0) out += ", ";
    if (is_object) out += keys_[i] + ": ";
    items_[i].append_in_line(out);
  }
  out += is_object ? (items_.empty() ? "}" : " }") : "]";
}

// Many numbers: as many in a line as fit.
void JsonText::append_filled(std::string& out, size_t indent) const {
  size_t column = line_width;
  for (size_t i = 0; i < items_.size(); ++i) {
    const std::string& text = items_[i].text_;
    if (column + 2 + text.size() > line_width) {
      out += '\n';
      out.append(indent, ' ');
      column = indent;
    } else {
      out += ' ';
      ++column;
    }
    out += text;
    column += text.size() + 1;
    if (i + 1 < items_.size()) out += ',';
  }
}

void JsonText::append(std::string& out, size_t indent, size_t column) const {
  constexpr size_t brackets_and_comma = 5;
  if (kind_ == Kind::scalar || items_.empty() || (!is_broken_ && column + width_ + brackets_and_comma <= line_width))
    return append_in_line(out);
  const bool is_object = kind_ == Kind::object;
  out += is_object ? '{' : '[';
  if (!is_object && is_of_scalars()) {
    append_filled(out, indent + 2);
  } else {
    for (size_t i = 0; i < items_.size(); ++i) {
      out += i > 0 ? ",\n" : "\n";
      out.append(indent + 2, ' ');
      if (is_object) out += keys_[i] + ": ";
      items_[i].append(out, indent + 2, indent + 2 + (is_object ? keys_[i].size() + 2 : 0));
    }
  }
  out += '\n';
  out.append(indent, ' ');
  out += is_object ? '}' : ']';
}

std::string JsonText::text() const {
  std::string out;
  append(out, 0, 0);
  return out + '\n';
}

}  // namespace metamer
