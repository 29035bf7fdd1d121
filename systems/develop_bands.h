// Colour from bands: their mean radiances and an observer become XYZ as the 1931 observer's, which every display takes.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "engine/film/film.h"
#include "engine/film/picture.h"
#include "engine/spectrum/band_weights.h"

namespace metamer {

// Rows of weights for X, Y and Z, one per band; rounded once.
using BandMatrix = std::array<std::vector<float>, 3>;

// For bands with these edges (nm, ascending) as an observer sees them, adapted to the display's white by
// observer_to_xyz(): cd/m^2 per W m^-2 sr^-1 nm^-1. The displays' white is D65.
BandMatrix band_matrix(std::span<const double> edges_nm, Observer observer);

// X[i] = sum over b of matrix[0][b] bands[b][i], and so on, from the first band on, each step rounded to float: equal
// bits on every instruction set and for every number of threads (0: all). Of a film the means are taken in blocks of
// pixels; pixels without samples are black.
XyzPicture integrate_bands(const SpectralPicture& picture, const BandMatrix& matrix, uint32_t threads);
XyzPicture integrate_bands(const Film& film, const BandMatrix& matrix, uint32_t threads);

}  // namespace metamer
