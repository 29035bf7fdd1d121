// PNG: 8 bits a channel, with an sRGB chunk or an ICC profile.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/files/atomic_file.h"
#include "engine/film/picture.h"

namespace metamer {

// What the codes mean, where no profile says it: sRGB, by a chunk that says so, or what the file does not tell.
enum class PngColours : uint8_t { srgb, unknown };

// Writes display-encoded codes. Equal arguments give equal bytes: no time, no host.
FileError write_png(const std::string& path, const CodedPicture& picture, const std::string& software,
                    PngColours colours = PngColours::srgb);
// With the colours of an ICC profile.
FileError write_png(const std::string& path, const CodedPicture& picture, const std::string& software,
                    const std::vector<uint8_t>& icc);

}  // namespace metamer
