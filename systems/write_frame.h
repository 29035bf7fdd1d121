// The last stage: the film is developed and written, as linear EXR and as PNG.
#pragma once
#include <optional>
#include <string>

#include "engine/files/exr_file.h"
#include "engine/film/film.h"
#include "engine/film/picture.h"
#include "engine/spectrum/color.h"
#include "engine/spectrum/observers.h"
#include "systems/colour_match.h"
#include "systems/tone_map.h"

namespace metamer {

// What a film should look like on a display. None of it changes the film.
struct Look {
  Observer observer = Observer::cie1931;  // another one needs a film with bands
  ColorSpace display = ColorSpace::srgb;
  std::optional<Color3> white;  // XYZ, Y = 1, of what shall be neutral; nothing: no adaptation
  Adaptation adaptation = Adaptation::cat16;
  std::optional<float> exposure_stops = 0.0f;  // nothing: automatic_exposure_stops
  ToneCurve curve = ToneCurve::linear;
  uint32_t threads = 0;  // 0: all; changes no pixel
};

struct WriteSettings {
  std::string exr_path;  // empty: none
  std::string png_path;  // empty: none
  FrameHeader
      header;  // of the EXR, which has the means of the film's bands; its chromaticities are set to the display's
  Look look;   // of the PNG; the EXR is linear sRGB, neither adapted nor exposed
  bool checkpoint = true;  // the EXR holds the film too; false is --preview-only
};

// The film as an observer sees it: its exact XYZ for cie1931, else the integral over its bands, which it must have.
XyzPicture observe(const Film& film, Observer observer, uint32_t threads);

// Means in linear colour, pixels without samples black; white of 1 cd/m^2 becomes R = G = B = 1 where the
// matrix is a display's.
Picture develop(const XyzPicture& xyz, const ColourMatrix& xyz_to_rgb);

// XYZ, observed already, as the look has it: developed for its display and white; `tone` is what is left to do to it.
struct Developed {
  Picture picture;
  ToneSettings tone;
};
Developed develop(const XyzPicture& xyz, const Look& look);
// Observed by the look's observer.
Developed develop(const Film& film, const Look& look);

// Writes codes of the look's display, with a profile that names it. The whole file or nothing.
FileError write_developed_png(const std::string& path, const Developed& developed, const std::string& software);

// Writes linear colour after exposure and tone curve, without the film. header.chromaticities are set to the display's.
FileError write_developed_exr(const std::string& path, Developed developed, FrameHeader header,
                              const SampleTotals& samples);

// Writes the files named, each whole or not at all. Both are tried; the errors are joined by newlines.
FileError write_frame(const Film& film, const WriteSettings& settings);

}  // namespace metamer
