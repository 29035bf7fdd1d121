// The last stage: the film is developed and written, as linear EXR and as PNG.
#pragma once
#include <string>

#include "engine/files/exr_file.h"
#include "engine/film/film.h"
#include "engine/film/picture.h"
#include "systems/colour_match.h"
#include "systems/tone_map.h"

namespace metamer {

struct WriteSettings {
  std::string exr_path;  // empty: none
  std::string png_path;  // empty: none
  // From the film's XYZ to the linear colour of the display that header.chromaticities describe; white of
  // 1 cd/m^2 becomes R = G = B = 1.
  ColourMatrix xyz_to_rgb = {};
  FrameHeader header;
  ToneSettings tone;       // of the PNG
  bool checkpoint = true;  // the EXR holds the film too; false is --preview-only
};

// The film's means in the display's linear colour, pixels without samples black.
Picture develop(const Film& film, const ColourMatrix& xyz_to_rgb);

// Writes the files named, each whole or not at all. Both are tried; the errors are joined by newlines.
FileError write_frame(const Film& film, const WriteSettings& settings);

}  // namespace metamer
