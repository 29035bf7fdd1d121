#include "scenes/images/write_image.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

namespace metamer {

FileError write_image(const std::string& path, const Image& image) {
  const auto output = OIIO::ImageOutput::create("exr");
  if (!output) return fmt::format("{}: {}", path, OIIO::geterror());
  const bool has_alpha = !image.alpha.empty();
  std::vector<float> rgba;
  for (size_t pixel = 0; pixel < image.alpha.size(); ++pixel) {
    rgba.insert(rgba.end(), image.rgb.data() + 3 * pixel, image.rgb.data() + 3 * pixel + 3);
    rgba.push_back(image.alpha[pixel]);
  }
  OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), has_alpha ? 4 : 3,
                       OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  if (!output->open(path, spec) ||
      !output->write_image(OIIO::TypeDesc::FLOAT, has_alpha ? rgba.data() : image.rgb.data()) || !output->close())
    return fmt::format("{}: {}", path, output->geterror());
  return std::nullopt;
}

}  // namespace metamer
