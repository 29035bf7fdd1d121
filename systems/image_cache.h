// Texels that stay in files: tiles of them come into memory as lookups need them, by OpenImageIO's cache. The files are
// made while the world is built, in a folder of their own that goes with the cache: spectral coefficients or numbers as
// they would be in memory, so lookups find the same bits either way.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/ecs/scene.h"
#include "engine/ecs/texture.h"

namespace metamer {

// Gives the set a cache of so many bytes. Error: no folder can be made.
bool open_image_cache(TextureSet& set, uint64_t bytes, Diagnostics& diagnostics);

// The places in the cache of the image as spectra of what it reflects, of its levels, too; as one channel; and as the
// three channels of a normal map. Nothing after an error.
std::vector<uint32_t> cache_spectra(TextureCache& cache, const Image& image, bool has_levels, ColorMode color,
                                    Diagnostics& diagnostics);
std::vector<uint32_t> cache_numbers(TextureCache& cache, const Image& image, TextureChannel channel, bool has_levels,
                                    Diagnostics& diagnostics);
std::vector<uint32_t> cache_normals(TextureCache& cache, const Image& image, Diagnostics& diagnostics);

// Texels of `count` lanes: place in the cache, column and row; `channels` numbers each, one channel after the other.
// From any thread. Texels that cannot be read any more are 0 and counted.
inline constexpr uint32_t most_cached_lanes = 16;
void fetch_texels(const TextureCache& cache, const uint32_t* files, const int32_t* columns, const int32_t* rows,
                  uint32_t count, uint32_t channels, float* out);

struct ImageCacheStats {
  uint64_t files = 0, file_bytes = 0;  // images with levels are several
  uint64_t limit_bytes = 0, held_bytes = 0, read_bytes = 0, tiles_read = 0;
  uint64_t failed_lookups = 0;
};
ImageCacheStats image_cache_stats(const TextureSet& set);

}  // namespace metamer
