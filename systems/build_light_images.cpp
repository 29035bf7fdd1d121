#include "systems/build_light_images.h"

#include <algorithm>

#include "engine/spectrum/color_mode.h"
#include "systems/image_texels.h"
#include "systems/light_rows.h"

namespace metamer {
namespace {

constexpr size_t most_texels = size_t{1} << 29;  // what a kernel's gathers reach

ImageLookup lookup_of(const Light& light, const Image& image) {
  if (light.kind == LightKind::area) return ImageLookup::linear;
  if (light.kind == LightKind::projection) return ImageLookup::nearest;
  return image.mapping == ImageMapping::equal_area ? ImageLookup::nearest : ImageLookup::linear_around;
}

}  // namespace

std::optional<uint32_t> add_light_image(const Scene& scene, const Light& light, World& world) {
  LightImages& images = world.light_images;
  const Image& image = scene.images[light.image];
  LightImage row;
  row.width = image.width;
  row.height = image.height;
  row.lookup = static_cast<uint32_t>(lookup_of(light, image));
  row.source = light.image;
  row.weight = static_cast<float>(image_weight(light, image));
  const size_t used = images.texels.size() / 4;
  row.first_texel = static_cast<uint32_t>(used);
  const auto same = std::find_if(images.rows.begin(), images.rows.end(),
                                 [&](const LightImage& known) { return known.source == light.image; });
  if (same != images.rows.end()) {
    row.first_texel = same->first_texel;
  } else {
    const size_t count = size_t{image.width} * image.height;
    if (used + count > most_texels) return std::nullopt;
    const Column<float> texels = image_texels(image, RgbKind::unbounded, world.settings.color);
    images.has_coefficients = world.settings.color != ColorMode::spectral;
    images.texels.resize(4 * (used + count));
    std::copy(texels.begin(), texels.end(), images.texels.begin() + 4 * used);
  }
  images.rows.push_back(row);
  return static_cast<uint32_t>(images.rows.size() - 1);
}

}  // namespace metamer
