// OpenEXR files, see docs/output.md. Part 0 is the picture that every viewer opens: 32-bit float R G B, with a channel
// per band of a spectral film. The part `film`, where there is one, holds the film's exact sums, which makes the file a
// checkpoint; those of its bands are in the part `bands`.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/files/atomic_file.h"
#include "engine/film/film.h"
#include "engine/film/picture.h"

namespace metamer {

// Where a picture lies in its whole frame, pixels. full_width 0: it is the whole.
struct FrameWindow {
  uint32_t x = 0, y = 0, full_width = 0, full_height = 0;
};

// What a file says about its frame. Nothing here may depend on when, where or on how many threads it was made.
struct FrameHeader {
  Chromaticities chromaticities;
  float white_luminance = 1;  // cd/m^2 of R = G = B = 1
  std::string software;       // "metamer <version>"
  std::string scene;          // its name
  uint64_t seed = 0;
  FrameWindow window;
  std::vector<std::pair<std::string, std::string>> settings;  // written as `metamer:<name>`, in any order
};

// Writes `picture`; where `checkpoint` is not null also the film it was developed from, where `spectral` is not null
// the means of that film's bands. Equal arguments give equal bytes. `samples` goes into the header unless it is of
// none.
FileError write_exr(const std::string& path, const Picture& picture, const FrameHeader& header,
                    const SampleTotals& samples, const Film* checkpoint, const Film* spectral = nullptr);

// Reads the picture of part 0, which must have 32-bit float R, G and B, how many samples it has, and the header with
// its settings in the order of their names. An error where there is none, or any part of the file is damaged or cut
// short; then nothing is changed.
FileError read_picture(const std::string& path, Picture& picture, FrameHeader& header, SampleTotals& samples);

// Reads the film out of a checkpoint, and the header with its settings in the order of their names. The sums of its
// bands, many times larger, can be left where they are: the film then has none. An error where there is no film in the
// file, it is damaged, cut short or does not fit in memory; then `film` and `header` are as they were.
enum class FilmBands { read, left_out };
FileError read_film(const std::string& path, Film& film, FrameHeader& header, FilmBands bands = FilmBands::read);

}  // namespace metamer
