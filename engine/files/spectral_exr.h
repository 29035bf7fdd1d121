// Spectral pictures in OpenEXR files, ours and others': channels S0.<wavelength> in the layout of Fichet, Pacanowski
// and Wilkie 2021.
#pragma once
#include <string>

#include "engine/files/exr_file.h"

namespace metamer {

// What there is in a file to develop.
struct ExrContents {
  bool has_film = false;   // a part `film`
  bool has_bands = false;  // channels of emitted radiance
};
FileError look_into_exr(const std::string& path, ExrContents& contents);

// Reads the first part that has emissive channels S0: mean radiances of bands or, from others, radiances at
// wavelengths, which are taken for the means of bands whose edges lie half-way between them. W.m^-2.sr^-1.nm^-1,
// W.m^-2.sr^-1 (the layout's own word for the same numbers) and no unit are accepted. FLOAT, HALF and UINT; R, G, B and
// other Stokes components are not read. `header` gets what the file has of it. An error where there are no such
// channels, two on one wavelength, another unit, or damage; then `picture` and `header` are as they were.
FileError read_spectral_picture(const std::string& path, SpectralPicture& picture, FrameHeader& header);

}  // namespace metamer
