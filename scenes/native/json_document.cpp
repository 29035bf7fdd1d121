#include "scenes/native/json_document.h"

#include <fmt/format.h>
#include <json/reader.h>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace metamer {
namespace {

constexpr int deepest_nesting = 100;
constexpr int most_repairs = 100;

// One mistake as JsonCpp words it: "* Line 3, Column 5\n  What is wrong\n".
struct ParseError {
  uint32_t line = 0, column = 0;
  std::string message;
};

ParseError first_error(const std::string& text) {
  ParseError error;
  int consumed = 0;
  if (std::sscanf(text.c_str(), "* Line %u, Column %u\n  %n", &error.line, &error.column, &consumed) >= 2) {
    const size_t end = std::min(text.find('\n', static_cast<size_t>(consumed)), text.size());
    error.message = text.substr(static_cast<size_t>(consumed), end - static_cast<size_t>(consumed));
  } else {
    error.message = text;
  }
  return error;
}

std::unique_ptr<Json::CharReader> make_reader() {
  Json::CharReaderBuilder builder;
  Json::CharReaderBuilder::strictMode(&builder.settings_);
  builder["allowComments"] = true;
  builder["collectComments"] = false;
  builder["strictRoot"] = false;
  builder["stackLimit"] = deepest_nesting + 1;
  return std::unique_ptr<Json::CharReader>(builder.newCharReader());
}

// The offset at which brackets nest too deep, or npos. Strings and comments are passed over.
size_t too_deep_at(std::string_view text) {
  int depth = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      for (++i; i < text.size() && text[i] != '"'; ++i)
        if (text[i] == '\\') ++i;
    } else if (text.substr(i, 2) == "//") {
      i = std::min(text.find_first_of("\r\n", i), text.size());
    } else if (text.substr(i, 2) == "/*") {
      i = std::min(text.find("*/", i + 2), text.size());
    } else if (c == '[' || c == '{') {
      if (++depth > deepest_nesting) return i;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return std::string_view::npos;
}

}  // namespace

bool JsonDocument::load(const std::string& path, FileBytes bytes, Diagnostics& diagnostics) {
  path_ = path;
  bytes_ = std::move(bytes);
  begin_ = bytes_.text().starts_with("\xef\xbb\xbf") ? 3 : 0;
  const std::string_view text = bytes_.text().substr(begin_);
  line_starts_ = {0};
  for (size_t i = 0; i < text.size(); ++i) {
    // "\n", "\r\n" and "\r" end lines, as JsonCpp counts them.
    if (text[i] == '\n' || (text[i] == '\r' && (i + 1 >= text.size() || text[i + 1] != '\n')))
      line_starts_.push_back(i + 1);
  }
  return check_text(diagnostics) && parse(diagnostics);
}

bool JsonDocument::check_text(Diagnostics& diagnostics) const {
  const std::string_view text = bytes_.text().substr(begin_);
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    diagnostics.error({path_, 1}, "the file is empty; expected a scene: { \"metamer\": 1, \"entities\": [ ... ] }");
    return false;
  }
  const size_t zero = text.find('\0');
  if (zero != std::string_view::npos) {
    diagnostics.error(at_offset(zero), "a zero byte; expected a scene in JSON, encoded as UTF-8");
    return false;
  }
  const size_t deep = too_deep_at(text);
  if (deep != std::string_view::npos) {
    diagnostics.error(at_offset(deep), fmt::format("brackets nest deeper than {}", deepest_nesting));
    return false;
  }
  return true;
}

// JsonCpp leaves an object at its first repeated key or unrepresentable number. Both are repaired in memory after they
// are reported, and the text is parsed again for what else there is.
bool JsonDocument::parse(Diagnostics& diagnostics) {
  const auto reader = make_reader();
  char* const begin = bytes_.data.get() + begin_;
  char* const end = bytes_.data.get() + bytes_.size;
  for (int repairs = 0; repairs <= most_repairs; ++repairs) {
    std::string errors;
    try {
      if (reader->parse(begin, end, &root_, &errors)) {
        is_readable_ = true;
        return repairs == 0;
      }
    } catch (const Json::Exception& exception) {
      diagnostics.error({path_, 0}, fmt::format("not JSON: {}", exception.what()));
      return false;
    }
    const ParseError error = first_error(errors);
    const bool is_known = error.line >= 1 && error.line <= line_starts_.size() && error.column >= 1;
    const size_t offset = is_known ? line_starts_[error.line - 1] + error.column - 1 : 0;
    char* const at = begin + std::min(offset, static_cast<size_t>(end - begin));
    if (is_known && error.message.ends_with("is not a number.") && at != end &&
        (*at == '-' || (*at >= '0' && *at <= '9'))) {
      char* const number_end = std::find_if(at, end, [](char c) {
        return !((c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E');
      });
      diagnostics.error({path_, error.line},
                        fmt::format("the number {} is malformed, or beyond what double precision holds",
                                    printable_text({at, number_end})));
      std::fill(at, number_end, ' ');
      *at = '1';
    } else if (is_known && error.message.starts_with("Duplicate key") && end - at > 2 && at[1] != '"') {
      diagnostics.error({path_, error.line},
                        fmt::format("the key {} stands twice in one object", printable_text(error.message.substr(15))));
      at[1] = repeated_key_mark;
    } else {
      diagnostics.error({path_, error.line}, fmt::format("not JSON: {}", printable_text(error.message)));
      return false;
    }
  }
  return false;
}

SourceLocation JsonDocument::at_offset(size_t offset) const {
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  return {path_, static_cast<uint32_t>(after - line_starts_.begin())};
}

SourceLocation JsonDocument::at(const Json::Value& value) const {
  return at_offset(static_cast<size_t>(std::max<ptrdiff_t>(value.getOffsetStart(), 0)));
}

SourceLocation JsonDocument::at_key(const Json::Value& value) const {
  const std::string_view text = bytes_.text().substr(begin_);
  const auto begin = static_cast<size_t>(std::max<ptrdiff_t>(value.getOffsetStart(), 0));
  const auto last_before = [&](size_t limit) {
    return limit == 0 ? std::string_view::npos : text.find_last_not_of(" \t\r\n", limit - 1);
  };
  const size_t colon = last_before(begin);
  if (colon == std::string_view::npos || text[colon] != ':') return at_offset(begin);
  const size_t quote = last_before(colon);
  return at_offset(quote == std::string_view::npos || text[quote] != '"' ? begin : quote);
}

std::string printable_text(const std::string& text) {
  constexpr size_t longest = 60;
  std::string shown = text.substr(0, longest);
  // A character of several bytes is not cut in half.
  while (text.size() > longest && !shown.empty() && (static_cast<unsigned char>(text[shown.size()]) & 0xc0) == 0x80)
    shown.pop_back();
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return text.size() > longest ? shown + "..." : shown;
}

std::vector<JsonMember> members_in_order(const Json::Value& object) {
  std::vector<JsonMember> members;
  for (auto it = object.begin(); it != object.end(); ++it)
    if (!is_repeated_key(it.name())) members.push_back({it.name(), &*it});
  std::sort(members.begin(), members.end(), [](const JsonMember& a, const JsonMember& b) {
    return a.value->getOffsetStart() < b.value->getOffsetStart();
  });
  return members;
}

std::string describe_value(const Json::Value& value) {
  switch (value.type()) {
    case Json::nullValue: return "null";
    case Json::booleanValue: return value.asBool() ? "true" : "false";
    case Json::intValue:
    case Json::uintValue:
    case Json::realValue: return fmt::format("the number {}", value.asDouble());
    case Json::stringValue: return fmt::format("the string \"{}\"", printable_text(value.asString()));
    case Json::arrayValue: return fmt::format("an array of {}", value.size());
    case Json::objectValue: return "an object";
  }
  return "unknown";
}

}  // namespace metamer
