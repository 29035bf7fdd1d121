// Mistakes and remarks about the user's files, collected so that all of a file are reported in one go.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace metamer {

enum class Severity : uint8_t { note, warning, error };

// What `--strict` makes of a remark: an error, unless the picture is the same without what the remark is about.
enum class Strict : uint8_t { refuses, allows };

struct Diagnostic {
  Severity severity = Severity::error;
  std::string file;
  uint32_t line = 0;  // 1-based; 0: the whole file
  std::string message;
  Strict strict = Strict::refuses;
};

// Where in a text file a thing was said.
struct SourceLocation {
  std::string file;
  uint32_t line = 0;
};

class Diagnostics {
 public:
  void error(const SourceLocation& at, std::string message);
  void warning(const SourceLocation& at, std::string message, Strict strict = Strict::refuses);
  void note(const SourceLocation& at, std::string message, Strict strict = Strict::refuses);
  // Turns every remark that strict refuses into an error.
  void apply_strict();
  bool has_errors() const { return error_count_ > 0; }
  size_t error_count() const { return error_count_; }
  std::span<const Diagnostic> all() const { return entries_; }

 private:
  std::vector<Diagnostic> entries_;
  size_t error_count_ = 0;
};

// `file:line: error: message`, one per line, in the order of file and line. After 100 lines a count.
std::string format_diagnostics(const Diagnostics& diagnostics);

// The candidate nearest to `word` by edit distance if near enough to be a likely typo, else empty.
std::string nearest_word(std::string_view word, std::span<const std::string_view> candidates);

// " (did you mean 'x'?)" or, where nothing is near, "".
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace metamer
