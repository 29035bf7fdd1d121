// OpenColorIO: its built-in ACES output, and the views of a configuration that the user names. Its arithmetic is its
// own and that of the C library, so here pixels are the same for any number of threads, but not on every machine.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "engine/film/picture.h"
#include "engine/spectrum/color.h"

namespace metamer {

// What is wrong, in one line, or nothing.
using OcioError = std::optional<std::string>;

// A display and one of its views in a configuration file.
struct OcioView {
  std::string config;         // path of config.ocio
  std::string display, view;  // empty: the configuration's default ones
  bool operator==(const OcioView&) const = default;
};

// Fills in the defaults. An error where the file is none, or has not the display or the view: then the names that there
// are, and the nearest.
OcioError resolve(OcioView& view);

// ACES 1.x for a display of 100 cd/m^2 in a dim surround, the style "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 -
// SDR-VIDEO_1.0". From linear colour of `display`, 1 its white, to linear colour of the same display, [0, 1] within its
// gamut. Bradford takes D65 to the white of ACES.
OcioError apply_aces(Picture& picture, ColorSpace display, uint32_t threads);

// From linear colour of `display` to what the view makes of it, for most views codes from 0 to 1. The colour enters as
// ACES2065-1 where the configuration has the role `aces_interchange` or a colour space of that name, else by its role
// `scene_linear`, which is then taken to be linear Rec. 709: configurations of version 1 do not say what it is.
OcioError apply_view(Picture& picture, ColorSpace display, const OcioView& view, uint32_t threads);

}  // namespace metamer
