#include "systems/write_frame.h"

#include "engine/files/icc_profile.h"
#include "engine/files/png_file.h"
#include "engine/spectrum/band_weights.h"
#include "systems/develop_bands.h"
#include "systems/display_colour.h"

namespace metamer {
namespace {

std::string profile_name(ColorSpace display) {
  if (display == ColorSpace::lamps) return "Lamps of 645.16, 526.32 and 444.44 nm, sRGB curve";
  return display == ColorSpace::dci_p3 ? "Display P3" : "ITU-R BT.2020 primaries, sRGB curve";
}

// What is left to do to a picture in the colour of the look's display.
Developed with_look(Picture picture, const Look& look) {
  Developed developed;
  developed.picture = std::move(picture);
  developed.aces = look.aces;
  developed.view = look.view;
  developed.tone.reinhard_white = look.reinhard_white;
  developed.tone.exposure_stops =
      look.exposure_stops ? *look.exposure_stops : automatic_exposure_stops(developed.picture, look.display);
  developed.tone.curve = look.curve;
  developed.tone.display = look.display;
  developed.tone.threads = look.threads;
  return developed;
}

// What OpenColorIO does to the picture; then only encoding is left, or for a view nothing.
FileError apply_ocio(Developed& developed) {
  if (!developed.aces && !developed.view) return std::nullopt;
  ToneSettings& tone = developed.tone;
  tone.curve = ToneCurve::linear;
  expose(developed.picture, tone);
  tone.exposure_stops = 0;
  tone.encoded = developed.view.has_value();
  return developed.view ? apply_view(developed.picture, tone.display, *developed.view, tone.threads)
                        : apply_aces(developed.picture, tone.display, tone.threads);
}

}  // namespace

XyzPicture observe(const Film& film, Observer observer, uint32_t threads) {
  if (observer != Observer::cie1931)
    return integrate_bands(film, band_matrix(band_edges_nm(film.band_count()), observer), threads);
  XyzPicture xyz{film.width(), film.height(), {}, {}, {}};
  mean_xyz(film, xyz.X, xyz.Y, xyz.Z);
  return xyz;
}

Picture develop(const XyzPicture& xyz, const ColourMatrix& xyz_to_rgb) {
  Picture picture{xyz.width, xyz.height, {}, {}, {}};
  colour_match(xyz_to_rgb, xyz.X, xyz.Y, xyz.Z, picture.r, picture.g, picture.b);
  return picture;
}

Picture develop(const XyzPicture& xyz) {
  return develop(xyz, display_matrix(ColorSpace::srgb, std::nullopt, Adaptation::cat16));
}

Developed develop(const Picture& picture, const Look& look) {
  // What render wrote stays what it is, to the last bit.
  const bool is_unchanged =
      look.display == ColorSpace::srgb && (!look.white || *look.white == white_xyz(ColorSpace::srgb));
  if (is_unchanged) return with_look(picture, look);
  Picture result{picture.width, picture.height, {}, {}, {}};
  const Matrix3 matrix =
      multiply(exact_display_matrix(look.display, look.white, look.adaptation), rgb_to_xyz(ColorSpace::srgb));
  colour_match(rounded(matrix), picture.r, picture.g, picture.b, result.r, result.g, result.b);
  return with_look(std::move(result), look);
}

Developed develop(const XyzPicture& xyz, const Look& look) {
  Matrix3 matrix = exact_display_matrix(look.display, look.white, look.adaptation);
  if (look.display == ColorSpace::lamps && look.observer == Observer::stiles_burch1955) {
    const Matrix3 adapted = multiply(display_to_xyz(look.display), matrix);
    matrix = multiply(inverse(observer_to_xyz(look.observer, white_illuminant(look.display))), adapted);
  }
  return with_look(develop(xyz, rounded(matrix)), look);
}

FileError write_developed_png(const std::string& path, Developed developed, const std::string& software) {
  if (FileError error = apply_ocio(developed)) return error;
  const CodedPicture codes = tone_map(developed.picture, developed.tone);
  if (developed.view) return write_png(path, codes, software, PngColours::unknown);
  const ColorSpace display = developed.tone.display;
  if (display == ColorSpace::srgb) return write_png(path, codes, software, PngColours::srgb);
  return write_png(path, codes, software, icc_profile(display_chromaticities(display), profile_name(display)));
}

FileError write_developed_exr(const std::string& path, Developed developed, FrameHeader header,
                              const SampleTotals& samples) {
  if (FileError error = apply_ocio(developed)) return error;
  expose(developed.picture, developed.tone);
  header.chromaticities = linear_chromaticities(developed.tone.display);
  header.white_luminance = linear_white_luminance(developed.tone.display);
  return write_exr(path, developed.picture, header, samples, nullptr);
}

Developed develop(const Film& film, const Picture& picture, const Look& look) {
  if (look.observer == Observer::cie1931) return develop(picture, look);
  return develop(observe(film, look.observer, look.threads), look);
}

FileError write_frame(const Film& film, const WriteSettings& settings) {
  FileError errors;
  const auto note = [&errors](const FileError& error) {
    if (error) errors = errors ? *errors + "\n" + *error : *error;
  };
  const XyzPicture xyz = observe(film, Observer::cie1931, settings.look.threads);
  const Picture picture = develop(xyz);
  if (!settings.exr_path.empty()) {
    FrameHeader header = settings.header;
    header.chromaticities = display_chromaticities(settings.primaries);
    const bool is_srgb = settings.primaries == ColorSpace::srgb;
    const Picture other =
        is_srgb ? Picture() : develop(xyz, display_matrix(settings.primaries, std::nullopt, Adaptation::cat16));
    note(write_exr(settings.exr_path, is_srgb ? picture : other, header, sample_totals(film),
                   settings.checkpoint ? &film : nullptr, &film));
  }
  if (!settings.png_path.empty())
    note(write_developed_png(settings.png_path, develop(film, picture, settings.look), settings.header.software));
  return errors;
}

}  // namespace metamer
