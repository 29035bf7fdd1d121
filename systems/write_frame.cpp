#include "systems/write_frame.h"

#include "engine/files/icc_profile.h"
#include "engine/files/png_file.h"
#include "systems/develop_bands.h"
#include "systems/display_colour.h"

namespace metamer {
namespace {

std::string profile_name(ColorSpace display) {
  return display == ColorSpace::dci_p3 ? "Display P3" : "ITU-R BT.2020 primaries, sRGB curve";
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

Developed develop(const XyzPicture& xyz, const Look& look) {
  Developed developed;
  developed.picture = develop(xyz, display_matrix(look.display, look.white, look.adaptation));
  developed.tone.exposure_stops =
      look.exposure_stops ? *look.exposure_stops : automatic_exposure_stops(developed.picture, look.display);
  developed.tone.curve = look.curve;
  developed.tone.display = look.display;
  developed.tone.threads = look.threads;
  return developed;
}

Developed develop(const Film& film, const Look& look) {
  return develop(observe(film, look.observer, look.threads), look);
}

FileError write_developed_png(const std::string& path, const Developed& developed, const std::string& software) {
  const ColorSpace display = developed.tone.display;
  std::vector<uint8_t> icc;
  if (display != ColorSpace::srgb) icc = icc_profile(display_chromaticities(display), profile_name(display));
  return write_png(path, tone_map(developed.picture, developed.tone), software, icc);
}

FileError write_developed_exr(const std::string& path, Developed developed, FrameHeader header,
                              const SampleTotals& samples) {
  expose(developed.picture, developed.tone);
  header.chromaticities = display_chromaticities(developed.tone.display);
  return write_exr(path, developed.picture, header, samples, nullptr);
}

FileError write_frame(const Film& film, const WriteSettings& settings) {
  FileError errors;
  const auto note = [&errors](const FileError& error) {
    if (error) errors = errors ? *errors + "\n" + *error : *error;
  };
  if (!settings.exr_path.empty()) {
    FrameHeader header = settings.header;
    header.chromaticities = display_chromaticities(ColorSpace::srgb);
    const Picture picture = develop(observe(film, Observer::cie1931, settings.look.threads),
                                    display_matrix(ColorSpace::srgb, std::nullopt, Adaptation::cat16));
    note(write_exr(settings.exr_path, picture, header, sample_totals(film), settings.checkpoint ? &film : nullptr,
                   &film));
  }
  if (!settings.png_path.empty())
    note(write_developed_png(settings.png_path, develop(film, settings.look), settings.header.software));
  return errors;
}

}  // namespace metamer
