// A JSON file in memory whose values know their lines.
#pragma once
#include <json/value.h>

#include <string>
#include <vector>

#include "engine/diagnostics.h"
#include "scenes/file_bytes.h"

namespace metamer {

class JsonDocument {
 public:
  // Parses the bytes of the file; comments are allowed. Mistakes of the syntax, repeated keys, numbers beyond double
  // precision and nesting deeper than 100 are reported with their lines. Then false, but where only keys and numbers
  // were wrong `root` can still be read, so that its other mistakes are found too.
  bool load(const std::string& path, FileBytes bytes, Diagnostics& diagnostics);

  bool is_readable() const { return is_readable_; }
  const std::string& path() const { return path_; }
  const Json::Value& root() const { return root_; }

  // Where a value of this document begins, and where its key stands (the value itself in an array).
  SourceLocation at(const Json::Value& value) const;
  SourceLocation at_key(const Json::Value& value) const;

 private:
  bool check_text(Diagnostics& diagnostics) const;
  bool parse(Diagnostics& diagnostics);
  SourceLocation at_offset(size_t offset) const;

  std::string path_;
  FileBytes bytes_;
  size_t begin_ = 0;                 // after a byte order mark
  std::vector<size_t> line_starts_;  // relative to begin_, as are the offsets of values
  Json::Value root_;
  bool is_readable_ = false;
};

// After loading, keys that repeat an earlier one of the same object are marked so: they have been reported.
inline constexpr char repeated_key_mark = '\x01';
inline bool is_repeated_key(const std::string& key) { return !key.empty() && key[0] == repeated_key_mark; }

// The members of an object in the order of the text, without repeated ones.
struct JsonMember {
  std::string name;
  const Json::Value* value;
};
std::vector<JsonMember> members_in_order(const Json::Value& object);

// "the number 3", "an array of 4", ... for messages.
std::string describe_value(const Json::Value& value);

// Text from a file as it may be printed: shortened, without control characters.
std::string printable_text(const std::string& text);

}  // namespace metamer
