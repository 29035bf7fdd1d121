// Bands in OpenEXR files, for exr_file.cpp and spectral_exr.cpp alone: their channels in the picture, and the part
// `bands` with their exact sums. Layout of channels and attributes: A. Fichet, R. Pacanowski, A. Wilkie, "An OpenEXR
// Layout for Spectral Images", JCGT 10(3), 2021.
#pragma once
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfOutputPart.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/film/film.h"
#include "engine/film/picture.h"

namespace metamer {

inline constexpr const char* bands_part = "bands";
inline constexpr const char* spectral_units = "W.m^-2.sr^-1.nm^-1";
inline constexpr const char* band_edges_attribute = "spectralBandEdges";

// "S0.385,000nm", the channel of the radiance around a wavelength.
std::string band_channel(double center_nm);

// The wavelength of a channel "S0.<number><prefix>m" or "S0.<number><prefix>Hz", nm; nothing for any other name. The
// number may have a decimal comma and an exponent.
std::optional<double> channel_wavelength_nm(std::string_view name);

// Adds the channels and attributes of a film's bands to the picture's header.
void describe_bands(Imf::Header& picture, uint32_t band_count);

// Writes R, G, B and, where there are any, the means of the film's bands, a few rows at a time.
void write_picture(Imf::OutputPart part, const Picture& picture, const Film* spectral);

// The part of the exact sums: UINT channels band<b>.radiance.limb<0..2> and band<b>.weight.limb<0..1>.
void add_band_sum_channels(Imf::Header& bands, uint32_t band_count);
void write_band_sums(Imf::OutputPart part, const Film& film);
// What is wrong, or nothing. Sums that the film's sample counts, read before, cannot reach are an error.
std::optional<std::string> read_band_sums(Imf::InputPart part, Film& film);

}  // namespace metamer
