// Pictures as input: environment maps and, later, textures.
#pragma once
#include <string>

#include "engine/ecs/scene.h"

namespace metamer {

// Reads EXR, HDR, PFM, PNG, JPEG, TGA and what else OpenImageIO knows as linear RGB from the top row down. Formats of 8
// or 16 bits an integer channel are taken as sRGB-encoded and decoded (IEC 61966-2-1); floating-point ones are linear.
// Alpha is dropped, grey fills all three channels. False after reporting what is wrong: at `named_at` if the file
// cannot be read, else at the file itself, also where a pixel is negative or not finite.
bool read_image(const std::string& path, const SourceLocation& named_at, Image& image, Diagnostics& diagnostics);

}  // namespace metamer
