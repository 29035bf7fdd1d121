#include "systems/write_frame.h"

#include "engine/files/png_file.h"

namespace metamer {

Picture develop(const Film& film, const ColourMatrix& xyz_to_rgb) {
  Picture picture{film.width(), film.height(), {}, {}, {}};
  Column<float> X, Y, Z;
  mean_xyz(film, X, Y, Z);
  colour_match(xyz_to_rgb, X, Y, Z, picture.r, picture.g, picture.b);
  return picture;
}

FileError write_frame(const Film& film, const WriteSettings& settings) {
  const Picture picture = develop(film, settings.xyz_to_rgb);
  FileError errors;
  const auto note = [&errors](const FileError& error) {
    if (error) errors = errors ? *errors + "\n" + *error : *error;
  };
  if (!settings.exr_path.empty())
    note(write_exr(settings.exr_path, picture, settings.header, sample_totals(film),
                   settings.checkpoint ? &film : nullptr));
  if (!settings.png_path.empty())
    note(write_png(settings.png_path, tone_map(picture, settings.tone), settings.header.software));
  return errors;
}

}  // namespace metamer
