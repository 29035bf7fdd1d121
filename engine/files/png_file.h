// PNG: 8 bits a channel, with an sRGB chunk or an ICC profile.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/files/atomic_file.h"
#include "engine/film/picture.h"

namespace metamer {

// Writes display-encoded codes with a chunk that says what they are: sRGB where `icc` is empty, else the colours of
// this ICC profile. Equal arguments give equal bytes: no time, no host.
FileError write_png(const std::string& path, const CodedPicture& picture, const std::string& software,
                    const std::vector<uint8_t>& icc = {});

}  // namespace metamer
