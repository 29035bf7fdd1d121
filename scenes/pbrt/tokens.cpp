#include "scenes/pbrt/tokens.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace metamer::pbrt {
namespace {

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }
bool ends_word(char c) { return is_space(c) || c == '"' || c == '[' || c == ']'; }

std::optional<char> unescape(char c) {
  switch (c) {
    case 'b': return '\b';
    case 'f': return '\f';
    case 'n': return '\n';
    case 'r': return '\r';
    case 't': return '\t';
    case '\\':
    case '\'':
    case '"': return c;
    default: return std::nullopt;
  }
}

// Garbage in a message: short, and without bytes that would upset a terminal.
std::string printable(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += (c >= ' ' && c <= '~') ? c : '?';
  if (text.size() > 40) out += "...";
  return out;
}

}  // namespace

Tokenizer::Tokenizer(std::string_view text, std::string file, Diagnostics& diagnostics)
    : text_(text), file_(std::move(file)), diagnostics_(diagnostics) {
  if (text_.starts_with("\xef\xbb\xbf")) position_ = 3;  // UTF-8 byte order mark
}

const Token& Tokenizer::peek() {
  if (!peeked_) peeked_ = scan();
  return *peeked_;
}

Token Tokenizer::next() {
  if (peeked_) return *std::exchange(peeked_, std::nullopt);
  return scan();
}

void Tokenizer::skip_to_directive() {
  while (peek().kind != TokenKind::end && !looks_like_directive(peek())) next();
}

Token Tokenizer::scan() {
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (c == '\n') ++line_;
    if (is_space(c)) {
      ++position_;
    } else if (c == '#') {
      while (position_ < text_.size() && text_[position_] != '\n') ++position_;
    } else if (c == '"') {
      return scan_string();
    } else if (c == '[' || c == ']') {
      ++position_;
      return {c == '[' ? TokenKind::open_bracket : TokenKind::close_bracket, line_, text_.substr(position_ - 1, 1)};
    } else {
      const size_t begin = position_;
      while (position_ < text_.size() && !ends_word(text_[position_])) ++position_;
      return {TokenKind::word, line_, text_.substr(begin, position_ - begin)};
    }
  }
  return {TokenKind::end, line_, {}};
}

Token Tokenizer::scan_string() {
  const size_t begin = ++position_;
  bool escaped = false;
  while (position_ < text_.size() && text_[position_] != '"' && text_[position_] != '\n') {
    if (text_[position_] == '\\') {
      escaped = true;
      if (position_ + 1 < text_.size() && text_[position_ + 1] != '\n') ++position_;
    }
    ++position_;
  }
  Token token{TokenKind::string, line_, text_.substr(begin, position_ - begin)};
  if (position_ < text_.size() && text_[position_] == '"') {
    ++position_;
  } else {
    diagnostics_.error({file_, line_}, "the string is not closed by '\"' on its line");
  }
  if (!escaped) return token;

  std::string& plain = unescaped_.emplace_back();
  for (size_t i = 0; i < token.text.size(); ++i) {
    if (token.text[i] != '\\') {
      plain += token.text[i];
      continue;
    }
    const std::optional<char> meant = i + 1 < token.text.size() ? unescape(token.text[i + 1]) : std::nullopt;
    if (meant) {
      plain += *meant;
      ++i;
    } else {
      diagnostics_.error({file_, line_}, "unknown escape in a string; known are \\b \\f \\n \\r \\t \\\\ \\' \\\"");
      plain += '\\';
    }
  }
  token.text = plain;
  return token;
}

bool looks_like_directive(const Token& token) {
  if (token.kind != TokenKind::word || token.text[0] < 'A' || token.text[0] > 'Z') return false;
  // Values as other programs write them.
  constexpr std::string_view values[] = {"True", "TRUE", "False", "FALSE", "NaN", "NAN", "Inf", "INF", "Infinity"};
  return std::find(std::begin(values), std::end(values), token.text) == std::end(values);
}

std::string show(const Token& token) {
  switch (token.kind) {
    case TokenKind::end: return "the end of the file";
    case TokenKind::string: return '"' + printable(token.text) + '"';
    default: return '\'' + printable(token.text) + '\'';
  }
}

std::optional<double> parse_number(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const char* end = word.data() + word.size();
  const auto [stop, status] = std::from_chars(word.data(), end, value);
  if (stop != end || word.empty()) return std::nullopt;
  if (status == std::errc::result_out_of_range) {
    // Too small is zero; too large is no number. from_chars does not say which, but the exponent does.
    const size_t exponent = word.find_first_of("eE");
    if (exponent != std::string_view::npos && word.substr(exponent + 1).starts_with('-')) return 0.0;
    return std::nullopt;
  }
  if (status != std::errc{} || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace metamer::pbrt
