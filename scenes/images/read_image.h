// Pictures as input: environment maps and, later, textures.
#pragma once
#include <string>

#include "engine/ecs/scene.h"

namespace metamer {

// How the images of textures are read: they may be negative, and as in pbrt the alpha of PNG files is encoded.
ImageEncoding texture_encoding(const std::string& path);

// Reads EXR, HDR, PFM, PNG, JPEG, TGA and what else OpenImageIO knows as linear RGB from the top row down. Formats of 8
// or 16 bits an integer channel are decoded, by default from sRGB (IEC 61966-2-1); floating-point ones are linear.
// Alpha is kept where it is not 1 everywhere; grey fills all three channels. The colour space is the one whose
// chromaticities an EXR file names. False after reporting what is wrong: at
// `named_at` if the file cannot be read, else at the file itself, also where a pixel is not finite, or negative and
// should not be.
enum class Pixels : uint8_t { kept, left_in_file };  // the latter are read and checked all the same
bool read_image(const std::string& path, const SourceLocation& named_at, Image& image, Diagnostics& diagnostics,
                const ImageEncoding& encoding = {}, Pixels pixels = Pixels::kept);

}  // namespace metamer
