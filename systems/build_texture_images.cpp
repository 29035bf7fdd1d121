#include "systems/build_texture_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "systems/image_cache.h"
#include "systems/image_levels.h"
#include "systems/image_texels.h"
#include "systems/texture_memory.h"

namespace metamer {
namespace {

constexpr uint32_t marble_texels = 6 * 512;
constexpr size_t most_texels = (size_t{1} << 29) - marble_texels;  // kernels count floats in 31 bits

// Rows for an image whose texels begin at `first`, and for its levels, if it has any. Returns the number of texels.
size_t add_rows(TextureSet& set, size_t first, uint32_t width, uint32_t height, bool has_levels) {
  const std::vector<LevelSize> sizes =
      has_levels ? level_sizes(width, height) : std::vector<LevelSize>{{width, height}};
  size_t count = 0;
  for (size_t level = 0; level < sizes.size(); ++level) {
    set.images.push_back({static_cast<uint32_t>(first + count), sizes[level].width, sizes[level].height,
                          static_cast<uint32_t>(sizes.size() - level)});
    count += size_t{sizes[level].width} * sizes[level].height;
  }
  return count;
}

// Where the rows of levels go: from each level's own place on.
struct LevelStore {
  std::vector<float*> next;        // by level
  std::vector<size_t> row_length;  // floats
  static void take(void* context, uint32_t level, const float* row) {
    LevelStore& store = *static_cast<LevelStore*>(context);
    store.next[level] = std::copy_n(row, store.row_length[level], store.next[level]);
  }
};

uint32_t add_number_image(const Image& image, TextureChannel channel, bool has_levels, TextureSet& set) {
  const size_t first = set.numbers.size();
  const auto row = static_cast<uint32_t>(set.images.size());
  set.numbers.resize(first + add_rows(set, first, image.width, image.height, has_levels));
  float* numbers = set.numbers.data() + first;
  for (size_t pixel = 0; pixel < size_t{image.width} * image.height; ++pixel)
    numbers[pixel] = pixel_number(image.rgb.data() + 3 * pixel, image.alpha.empty() ? 1 : image.alpha[pixel], channel);
  if (!has_levels) return row;
  LevelStore store;
  for (size_t nth = row; nth < set.images.size(); ++nth) {
    store.next.push_back(set.numbers.data() + set.images[nth].first_texel);
    store.row_length.push_back(set.images[nth].width);
  }
  LevelRows levels(image.width, image.height, 1, LevelStore::take, &store);
  for (size_t y = 0; y < image.height; ++y) levels.add(numbers + y * image.width);
  return row;
}

// The levels from 1 on. What surfaces reflect is from 0 to 1, so means are of that.
std::vector<Image> reflectance_levels(const Image& image) {
  std::vector<Image> levels;
  LevelStore store{{nullptr}, {0}};
  const std::vector<LevelSize> sizes = level_sizes(image.width, image.height);
  levels.reserve(sizes.size());
  for (size_t nth = 1; nth < sizes.size(); ++nth) {
    Image& level = levels.emplace_back();
    level.width = sizes[nth].width;
    level.height = sizes[nth].height;
    level.color_space = image.color_space;
    level.rgb.resize(size_t{3} * level.width * level.height);
    store.next.push_back(level.rgb.data());
    store.row_length.push_back(size_t{3} * level.width);
  }
  LevelRows rows(image.width, image.height, 3, LevelStore::take, &store);
  std::vector<float> row(size_t{3} * image.width);
  for (size_t y = 0; y < image.height; ++y) {
    for (size_t k = 0; k < row.size(); ++k) row[k] = std::clamp(image.rgb[y * row.size() + k], 0.0f, 1.0f);
    rows.add(row.data());
  }
  return levels;
}

// pbrt-v4's colours of marble (linear sRGB): cubic Bezier curves over each four neighbours of nine, times 1.5.
Image marble_colors() {
  constexpr double knots[9][3] = {{.58, .58, .6}, {.58, .58, .6}, {.58, .58, .6}, {.5, .5, .5},  {.6, .59, .58},
                                  {.58, .58, .6}, {.58, .58, .6}, {.2, .2, .33},  {.58, .58, .6}};
  constexpr uint32_t segments = 6, steps = marble_texels / segments;
  Image image;
  image.width = segments * steps;
  image.height = 1;
  for (uint32_t i = 0; i < image.width; ++i) {
    const uint32_t first = i / steps;
    const double t = (i % steps + 0.5) / steps, s = 1 - t;
    const double weights[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
    for (int c = 0; c < 3; ++c) {
      double sum = 0;
      for (uint32_t k = 0; k < 4; ++k) sum += weights[k] * knots[first + k][c];
      image.rgb.push_back(static_cast<float>(1.5 * sum));
    }
  }
  return image;
}

void append_texels(const Image& image, ColorMode color, TextureSet& set) {
  const Column<float> texels = image_texels(image, RgbKind::albedo, color);
  const size_t begin = set.texels.size();
  set.texels.resize(begin + texels.size());
  std::copy(texels.begin(), texels.end(), set.texels.begin() + static_cast<ptrdiff_t>(begin));
}

uint32_t add_image(const Image& image, bool has_levels, ColorMode color, TextureSet& set) {
  const auto row = static_cast<uint32_t>(set.images.size());
  add_rows(set, set.texels.size() / 4, image.width, image.height, has_levels);
  append_texels(image, color, set);
  if (has_levels)
    for (const Image& level : reflectance_levels(image)) append_texels(level, color, set);
  return row;
}

// Rows for an image that is looked up in the cache, and what they are there.
uint32_t add_cached_rows(TextureSet& set, const Image& image, const std::vector<uint32_t>& files) {
  const auto row = static_cast<uint32_t>(set.images.size());
  add_rows(set, 0, image.width, image.height, files.size() > 1);
  set.image_files.resize(row, no_index);
  set.image_files.insert(set.image_files.end(), files.begin(), files.end());
  set.image_files.resize(set.images.size(), no_index);  // shorter after an error only
  return row;
}

// Images by what they are used for, and whether some texture chooses levels of them.
struct ImageUses {
  std::map<ImageId, bool> spectra;
  std::map<std::pair<ImageId, TextureChannel>, bool> numbers;
};
ImageUses image_uses(const Scene& scene) {
  ImageUses uses;
  for (const Texture& t : scene.textures) {
    if (t.kind != TextureKind::image) continue;
    bool& has_levels = t.is_number != 0 ? uses.numbers[{t.image, t.channel}] : uses.spectra[t.image];
    has_levels = has_levels || uses_levels(t.filter);
  }
  return uses;
}

bool has_marble(const Scene& scene) {
  const auto is_marble = [](const Texture& t) { return t.kind == TextureKind::marble; };
  return std::any_of(scene.textures.begin(), scene.textures.end(), is_marble);
}

// Makes room for all texels that are in memory. False where kernels could not count them.
bool reserve_texels(const Scene& scene, const ImageUses& uses, TextureSet& set, Diagnostics& diagnostics) {
  const auto texels_of = [&](ImageId id, bool has_levels) {
    size_t count = 0;
    const Image& image = scene.images[id];
    for (const auto& [width, height] : level_sizes(image.width, image.height)) {
      if (!image.is_in_file) count += size_t{width} * height;
      if (!has_levels) break;
    }
    return count;
  };
  size_t spectrum_texels = 0, number_texels = 0;
  for (const auto& [id, has_levels] : uses.spectra) spectrum_texels += texels_of(id, has_levels);
  for (const auto& [key, has_levels] : uses.numbers) number_texels += texels_of(key.first, has_levels);
  if (std::max(spectrum_texels, number_texels) > most_texels) {
    diagnostics.error({}, fmt::format("the images of all textures have {} texels together; at most {} fit, or less "
                                      "memory for them by --texture-memory",
                                      std::max(spectrum_texels, number_texels), most_texels));
    return false;
  }
  if (has_marble(scene)) spectrum_texels += marble_texels;
  set.texels.reserve(4 * spectrum_texels);
  set.numbers.reserve(number_texels);
  return true;
}

// The pixels of an image are given back after its last use, unless something else needs them.
void give_back(Scene* disposable, const ImageUses& uses, const std::vector<bool>& is_kept, ImageId id,
               std::optional<TextureChannel> channel) {
  if (disposable == nullptr || is_kept[id]) return;
  const auto next = channel ? uses.numbers.upper_bound({id, *channel}) : uses.numbers.lower_bound({id, {}});
  if (next != uses.numbers.end() && next->first.first == id) return;
  std::vector<float>().swap(disposable->images[id].rgb);
}

std::vector<bool> images_of_others(const Scene& scene) {
  std::vector<bool> is_kept(scene.images.size());
  const auto keep = [&](ImageId id) {
    if (id != no_index) is_kept[id] = true;
  };
  scene.registry.each<Material>(
      [&](Entity entity, uint32_t) { keep(scene.registry.get<Material>(entity).normal_map); });
  scene.registry.each<Light>([&](Entity entity, uint32_t) { keep(scene.registry.get<Light>(entity).image); });
  return is_kept;
}

}  // namespace

bool add_texture_images(TextureImages& images, Scene* disposable, Diagnostics& diagnostics) {
  const Scene& scene = images.scene;
  TextureSet& set = images.set;
  const ColorMode color = scene.settings.color;
  const ImageUses uses = image_uses(scene);
  const bool has_files =
      std::any_of(scene.images.begin(), scene.images.end(), [](const Image& image) { return image.is_in_file; });
  if (has_files && !open_image_cache(set, cache_bytes(scene), diagnostics)) return false;
  if (!reserve_texels(scene, uses, set, diagnostics)) return false;
  const size_t errors_before = diagnostics.error_count();
  const std::vector<bool> is_kept = images_of_others(scene);
  for (const auto& [id, has_levels] : uses.spectra) {
    const Image& image = scene.images[id];
    images.spectrum_rows[id] =
        image.is_in_file ? add_cached_rows(set, image, cache_spectra(*set.cache, image, has_levels, color, diagnostics))
                         : add_image(image, has_levels, color, set);
    give_back(disposable, uses, is_kept, id, std::nullopt);
  }
  for (const auto& [key, has_levels] : uses.numbers) {
    const auto& [id, channel] = key;
    const Image& image = scene.images[id];
    images.number_rows[key] =
        image.is_in_file
            ? add_cached_rows(set, image, cache_numbers(*set.cache, image, channel, has_levels, diagnostics))
            : add_number_image(image, channel, has_levels, set);
    give_back(disposable, uses, is_kept, id, channel);
  }
  if (has_marble(scene)) images.marble_row = add_image(marble_colors(), false, color, set);
  return diagnostics.error_count() == errors_before;
}

uint32_t add_normal_map(const Image& image, ImageId id, TextureSet& set, Diagnostics& diagnostics) {
  const auto known = std::find(set.normal_map_images.begin(), set.normal_map_images.end(), id);
  if (known != set.normal_map_images.end()) return static_cast<uint32_t>(known - set.normal_map_images.begin());
  const size_t first = set.numbers.size();
  set.normal_map_images.push_back(id);
  set.normal_maps.push_back({static_cast<uint32_t>(first), image.width, image.height});
  const auto row = static_cast<uint32_t>(set.normal_maps.size() - 1);
  if (image.is_in_file) {
    const std::vector<uint32_t> files = cache_normals(*set.cache, image, diagnostics);
    set.normal_map_files.resize(row, no_index);
    set.normal_map_files.push_back(files.empty() ? no_index : files[0]);
    return row;
  }
  set.numbers.resize(first + image.rgb.size());
  std::copy(image.rgb.begin(), image.rgb.end(), set.numbers.begin() + static_cast<ptrdiff_t>(first));
  return row;
}

}  // namespace metamer
