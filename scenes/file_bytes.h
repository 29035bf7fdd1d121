// A whole file in memory, and what can go wrong on the way there.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "engine/diagnostics.h"

namespace metamer {

struct FileBytes {
  std::unique_ptr<char[]> data;
  size_t size = 0;
  std::string_view text() const { return {data.get(), size}; }
};

FileBytes copy_bytes(std::string_view text);

// Reads a regular file. Where that fails (missing, a folder, a device, not readable), an error at `named_at`, the place
// that asked for the file, and false.
bool read_file(const std::string& path, const SourceLocation& named_at, FileBytes& bytes, Diagnostics& diagnostics);

// Whether that would work, without reading; for files that a library opens itself.
bool check_readable(const std::string& path, const SourceLocation& named_at, Diagnostics& diagnostics);

// `path` as said in `named_in`: relative ones start at the folder of that file.
std::string resolve_path(const std::string& path, const std::string& named_in);

// The part after the last dot of the file's name in lower case, without the dot.
std::string file_extension(const std::string& path);

}  // namespace metamer
