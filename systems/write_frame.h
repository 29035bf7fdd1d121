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
#include "systems/ocio_view.h"
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
  float reinhard_white = default_reinhard_white;  // of ToneCurve::reinhard_extended
  bool aces = false;                              // instead of `curve`
  std::optional<OcioView> view;                   // resolved; instead of `curve` and the display's encoding
  uint32_t threads = 0;                           // 0: all; changes no pixel
};

struct WriteSettings {
  std::string exr_path;  // empty: none
  std::string png_path;  // empty: none
  FrameHeader header;    // of the EXR, which has the means of the film's bands; its chromaticities are set to those of
                         // `primaries`
  ColorSpace primaries = ColorSpace::srgb;  // of the EXR, which is linear, neither adapted nor exposed
  Look look;                                // of the PNG
  bool checkpoint = true;                   // the EXR holds the film too; false is --preview-only
};

// The film as an observer sees it: its exact XYZ for cie1931, else the integral over its bands, which it must have.
XyzPicture observe(const Film& film, Observer observer, uint32_t threads);

// Means in linear colour, pixels without samples black; white of 1 cd/m^2 becomes R = G = B = 1 where the
// matrix is a display's.
Picture develop(const XyzPicture& xyz, const ColourMatrix& xyz_to_rgb);

// The same in linear sRGB: what part 0 of an EXR holds, and what the looks of the 1931 observer start from.
Picture develop(const XyzPicture& xyz);

// A picture as the look has it: in the colour of its display and adapted to its white. The rest is what is left to do.
struct Developed {
  Picture picture;  // see display_to_xyz
  ToneSettings tone;
  bool aces = false;
  std::optional<OcioView> view;
};
// `picture` is linear sRGB.
Developed develop(const Picture& picture, const Look& look);
// XYZ that the look's observer saw. On lamps the three numbers of Stiles & Burch are those that the observer gave, but
// for rounding, unless they are adapted to a white.
Developed develop(const XyzPicture& xyz, const Look& look);
// A film, and its picture in linear sRGB, as the look's observer sees it.
Developed develop(const Film& film, const Picture& picture, const Look& look);

// Writes codes of the look's display, with a profile that names it; of an OpenColorIO view without any, as only the
// configuration knows what they mean. The whole file or nothing.
FileError write_developed_png(const std::string& path, Developed developed, const std::string& software);

// Writes linear colour after exposure and tone curve, or the values of a view, without the film. The header's
// chromaticities and luminance of white are set to the display's.
FileError write_developed_exr(const std::string& path, Developed developed, FrameHeader header,
                              const SampleTotals& samples);

// Writes the files named, each whole or not at all. Both are tried; the errors are joined by newlines.
FileError write_frame(const Film& film, const WriteSettings& settings);

}  // namespace metamer
