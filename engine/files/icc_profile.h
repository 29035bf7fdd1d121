// ICC profiles, which tell other programs what the codes of a picture mean.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/film/picture.h"

namespace metamer {

// A matrix profile (ICC.1:2010, version 4) of an RGB display with these primaries and white and the sRGB curve of IEC
// 61966-2-1. Equal arguments give equal bytes: its date is 1 January 2000. Throws std::runtime_error where the
// colours are no display (a zero y, or primaries in one line).
std::vector<uint8_t> icc_profile(const Chromaticities& display, const std::string& description);

}  // namespace metamer
