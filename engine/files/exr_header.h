// What the headers of OpenEXR files say about a frame, for the files that read them.
#pragma once
#include <ImfHeader.h>

#include <string>

#include "engine/files/exr_file.h"

namespace metamer {

inline constexpr const char* film_part = "film";

// A string attribute; empty where there is none.
std::string exr_text(const Imf::Header& exr, const std::string& name);

// All that the header has, the seed 0 where it states none.
FrameHeader read_exr_header(const Imf::Header& exr);

}  // namespace metamer
