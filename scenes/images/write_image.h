// Images to files.
#pragma once
#include <string>

#include "engine/ecs/scene.h"
#include "engine/files/atomic_file.h"

namespace metamer {

// An EXR file of 32-bit floats, losslessly compressed: read_image gives the same numbers back.
FileError write_image(const std::string& path, const Image& image);

}  // namespace metamer
