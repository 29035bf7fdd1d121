// Files compressed by gzip (RFC 1952), told by their first two bytes whatever they are called.
#pragma once
#include <span>
#include <string>

#include "engine/diagnostics.h"
#include "scenes/file_bytes.h"

namespace metamer {

// The most bytes that so many compressed ones may become: no mesh or scene shrinks to less than a 32nd, and 256 MiB are
// nothing. Files made to fill the memory ("bombs") reach a 1000th.
constexpr size_t most_unpacked_bytes(size_t compressed) { return (size_t{256} << 20) + 32 * compressed; }

// As read_file, and unpacks the file if it begins as gzip files do. Errors at `named_at` name the file: it is cut
// short, damaged, has bytes behind its end, or unpacks to more than the above.
bool read_packed_file(const std::string& path, const SourceLocation& named_at, FileBytes& bytes,
                      Diagnostics& diagnostics);

// Unpacks data in the zlib format (RFC 1950) that fills `out` exactly; false otherwise.
bool inflate_zlib(std::string_view packed, std::span<char> out);

// The file's extension, as file_extension; of "x.ply.gz" it is "ply".
std::string packed_file_extension(const std::string& path);

}  // namespace metamer
