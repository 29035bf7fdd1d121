// The images that textures look up, as texels in memory or as files of the cache.
#pragma once
#include <map>

#include "systems/freeze.h"

namespace metamer {

// The first rows of TextureSet::images of what programs look up, each image once.
struct TextureImages {
  const Scene& scene;
  TextureSet& set;
  std::map<ImageId, uint32_t> spectrum_rows;
  std::map<std::pair<ImageId, TextureChannel>, uint32_t> number_rows;
  uint32_t marble_row = no_index;  // of marble's colours, if some texture is marble
};

// Of all textures of the scene; levels are made of images that some texture chooses levels of. Pixels of `disposable`,
// unless it is null, are given back as soon as nothing needs them any more. False after an error.
bool add_texture_images(TextureImages& images, Scene* disposable, Diagnostics& diagnostics);

}  // namespace metamer
