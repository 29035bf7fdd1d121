#include "scenes/images/write_image.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

namespace metamer {

FileError write_image(const std::string& path, const Image& image) {
  const auto output = OIIO::ImageOutput::create("exr");
  if (!output) return fmt::format("{}: {}", path, OIIO::geterror());
  const size_t channels = image.alpha.empty() ? 3 : 4;
  OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), static_cast<int>(channels),
                       OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  std::vector<float> pixels;
  if (channels == 4) {
    for (size_t pixel = 0; pixel < image.alpha.size(); ++pixel) {
      pixels.insert(pixels.end(), image.rgb.begin() + static_cast<ptrdiff_t>(3 * pixel),
                    image.rgb.begin() + static_cast<ptrdiff_t>(3 * pixel + 3));
      pixels.push_back(image.alpha[pixel]);
    }
  }
  const float* values = channels == 4 ? pixels.data() : image.rgb.data();
  if (!output->open(path, spec) || !output->write_image(OIIO::TypeDesc::FLOAT, values) || !output->close())
    return fmt::format("{}: {}", path, output->geterror());
  return std::nullopt;
}

}  // namespace metamer
