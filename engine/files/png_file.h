// PNG: 8 bits a channel, with an sRGB chunk.
#pragma once
#include <string>

#include "engine/files/atomic_file.h"
#include "engine/film/picture.h"

namespace metamer {

// Writes sRGB-encoded codes, with a chunk that says so. Equal pictures and texts give equal bytes: no time, no host.
FileError write_png(const std::string& path, const CodedPicture& picture, const std::string& software);

}  // namespace metamer
