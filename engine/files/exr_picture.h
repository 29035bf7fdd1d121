// The picture of an OpenEXR file, whoever wrote it.
#pragma once
#include <optional>
#include <string>

#include "engine/files/atomic_file.h"
#include "engine/film/picture.h"

namespace metamer {

struct ExrPicture {
  Picture picture;
  Chromaticities chromaticities;        // those of sRGB where the file names none, as the format defines
  std::optional<float> exposure_stops;  // of the PNG that metamer render wrote beside it
  std::string color;                    // metamer's mode, or empty
};

// Reads channels R, G, B of the first part that has them, within its data window. An error where there is none, or the
// file is missing, damaged, of another kind or larger than memory allows; then `read` is as it was.
FileError read_exr_picture(const std::string& path, ExrPicture& read);

}  // namespace metamer
