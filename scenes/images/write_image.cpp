#include "scenes/images/write_image.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

namespace metamer {

FileError write_image(const std::string& path, const Image& image) {
  const auto output = OIIO::ImageOutput::create("exr");
  if (!output) return fmt::format("{}: {}", path, OIIO::geterror());
  OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), 3, OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  if (!output->open(path, spec) || !output->write_image(OIIO::TypeDesc::FLOAT, image.rgb.data()) || !output->close())
    return fmt::format("{}: {}", path, output->geterror());
  return std::nullopt;
}

}  // namespace metamer
