// How much memory the texels of textures take, and which images are left in their files where that is too much.
#pragma once
#include "engine/ecs/scene.h"

namespace metamer {

// Bytes of the texels that the scene's textures and normal maps make of each image, by ImageId; 0: no texture uses it.
std::vector<uint64_t> texture_bytes(const Scene& scene);

// Whether an image may be in memory, by ImageId. Where all of them would take more than scene.texture_memory the
// largest are left in their files, one by one, until the others take at most three quarters of it: the rest is the
// cache's.
std::vector<bool> images_that_fit(const Scene& scene);

// What of scene.texture_memory is left for the cache, but no less than it can work with.
inline constexpr uint64_t least_cache_bytes = uint64_t{16} << 20;
uint64_t cache_bytes(const Scene& scene);

}  // namespace metamer
