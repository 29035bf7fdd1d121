#include "systems/texture_memory.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "systems/image_levels.h"

namespace metamer {
namespace {

uint64_t texels_of(const Image& image, bool has_levels) {
  uint64_t count = 0;
  for (const auto& [width, height] : level_sizes(image.width, image.height)) {
    count += uint64_t{width} * height;
    if (!has_levels) break;
  }
  return count;
}

}  // namespace

std::vector<uint64_t> texture_bytes(const Scene& scene) {
  constexpr uint64_t spectrum_bytes = 4 * sizeof(float), number_bytes = sizeof(float), normal_bytes = 3 * sizeof(float);
  // Once as spectra, once for each channel that is a number; and whether with levels.
  std::map<std::pair<ImageId, int>, bool> uses;
  for (const Texture& t : scene.textures) {
    if (t.kind != TextureKind::image) continue;
    bool& has_levels = uses[{t.image, t.is_number != 0 ? static_cast<int>(t.channel) : -1}];
    has_levels = has_levels || uses_levels(t.filter);
  }
  std::vector<uint64_t> bytes(scene.images.size());
  for (const auto& [use, has_levels] : uses) {
    const auto& [id, channel] = use;
    bytes[id] += texels_of(scene.images[id], has_levels) * (channel < 0 ? spectrum_bytes : number_bytes);
  }
  std::vector<bool> is_normal_map(scene.images.size());
  scene.registry.each<Material>([&](Entity entity, uint32_t) {
    const ImageId map = scene.registry.get<Material>(entity).normal_map;
    if (map != no_index) is_normal_map[map] = true;
  });
  for (size_t id = 0; id < bytes.size(); ++id)
    if (is_normal_map[id]) bytes[id] += texels_of(scene.images[id], false) * normal_bytes;
  return bytes;
}

std::vector<bool> images_that_fit(const Scene& scene) {
  const std::vector<uint64_t> bytes = texture_bytes(scene);
  std::vector<bool> fits(bytes.size(), true);
  uint64_t total = std::accumulate(bytes.begin(), bytes.end(), uint64_t{0});
  if (total <= scene.texture_memory) return fits;
  std::vector<ImageId> largest_first(bytes.size());
  std::iota(largest_first.begin(), largest_first.end(), 0u);
  std::stable_sort(largest_first.begin(), largest_first.end(),
                   [&](ImageId a, ImageId b) { return bytes[a] > bytes[b]; });
  for (const ImageId id : largest_first) {
    if (total <= scene.texture_memory / 4 * 3) break;
    fits[id] = false;
    total -= bytes[id];
  }
  return fits;
}

uint64_t cache_bytes(const Scene& scene) {
  const std::vector<uint64_t> bytes = texture_bytes(scene);
  uint64_t in_memory = 0;
  for (size_t id = 0; id < bytes.size(); ++id)
    if (!scene.images[id].is_in_file) in_memory += bytes[id];
  return std::max(scene.texture_memory - std::min(in_memory, scene.texture_memory), least_cache_bytes);
}

}  // namespace metamer
