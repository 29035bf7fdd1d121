// Images that textures only name and that may be left in their files.
#pragma once
#include "scenes/images/read_image.h"

namespace metamer {

// How a reader reads the images of textures: without keeping their pixels where memory is limited, until all are known.
inline Pixels pixels_of_textures(const Scene& scene) {
  return scene.texture_memory == std::numeric_limits<uint64_t>::max() ? Pixels::kept : Pixels::left_in_file;
}
// Once all textures are known: reads those whose pixels fit into the memory that textures may take, on all threads.
void read_images_that_fit(Scene& scene, Diagnostics& diagnostics);

}  // namespace metamer
