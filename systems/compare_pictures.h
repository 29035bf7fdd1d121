// How different two pictures look, pixel by pixel.
#pragma once
#include <optional>

#include "engine/film/film.h"
#include "engine/film/picture.h"
#include "engine/spectrum/color.h"

namespace metamer {

// A picture's colours as XYZ.
XyzPicture xyz_of(const Picture& picture, const Chromaticities& chromaticities);
// The film's means; of one half of its samples (replicates 0 and 1, or 2 and 3) where `half` says which.
XyzPicture xyz_of(const Film& film, std::optional<int> half = std::nullopt);

struct CompareSettings {
  double exposure_stops = 0;  // both pictures times 2^stops
  uint32_t threads = 0;       // 0: all; changes nothing in the result
};

struct PictureDifference {
  Column<float> delta_e;    // per pixel; NaN where a colour is not finite
  uint64_t not_finite = 0;  // pixels that the numbers below leave out
  double mean = 0, median = 0, percentile_95 = 0, largest = 0;
  size_t largest_pixel = 0;
};

// CIEDE2000 beside the white of sRGB (D65) of luminance 1. A colour brighter than that white is taken at white's
// luminance: no display would show more of it. Sizes must agree.
PictureDifference compare_pictures(const XyzPicture& a, const XyzPicture& b, const CompareSettings& settings);

// Linear sRGB: black is 0, white `scale` and more, in between CIELAB lightness rises evenly from violet over red and
// orange, so that equal steps of difference look equal. Pixels that are not finite are green, which is nowhere else.
Picture difference_map(const PictureDifference& difference, uint32_t width, uint32_t height, double scale);

}  // namespace metamer
