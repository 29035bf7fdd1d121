// The words, strings and brackets of a pbrt file.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "engine/diagnostics.h"

namespace metamer::pbrt {

enum class TokenKind : uint8_t { end, word, string, open_bracket, close_bracket };

struct Token {
  TokenKind kind = TokenKind::end;
  uint32_t line = 0;
  std::string_view text;  // a string without its quotes and escapes
};

// Reads tokens one by one; mistakes (an unterminated string, an unknown escape) go to `diagnostics` and reading goes
// on. `text` and `diagnostics` must outlive the tokenizer, the tokenizer its tokens.
class Tokenizer {
 public:
  Tokenizer(std::string_view text, std::string file, Diagnostics& diagnostics);

  const Token& peek();
  Token next();
  // Skips to the next word that starts with a capital letter, as all directives do, or to the end.
  void skip_to_directive();
  const std::string& file() const { return file_; }
  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  Token scan();
  Token scan_string();

  std::string_view text_;
  std::string file_;
  Diagnostics& diagnostics_;
  size_t position_ = 0;
  uint32_t line_ = 1;
  std::optional<Token> peeked_;
  std::deque<std::string> unescaped_;  // strings that had escapes; their addresses stay
};

// Whether a token can be the start of a directive: an unquoted word with a capital letter in front.
bool looks_like_directive(const Token& token);

// How a message shows a token: 'word', "string", '[' or "the end of the file".
std::string show(const Token& token);

// A finite decimal number; nothing for anything else, nan, inf and 1e999 included.
std::optional<double> parse_number(std::string_view word);

}  // namespace metamer::pbrt
