#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "systems/freeze.h"
#include "systems/image_cache.h"
#include "systems/image_levels.h"
#include "systems/image_texels.h"
#include "systems/texture_memory.h"

namespace metamer {
namespace {

constexpr size_t most_texels = (size_t{1} << 29) - (1 << 12);  // kernels count floats in 31 bits; marble takes some

uint32_t operand_count(TextureKind kind) {
  switch (kind) {
    case TextureKind::square_root: return 1;
    case TextureKind::scale:
    case TextureKind::checkerboard: return 2;
    case TextureKind::mix: return 3;
    default: return 0;
  }
}

// How deep the stack grows while a texture is computed, its operands in their order.
uint32_t stack_depth(const std::vector<Texture>& textures, const std::vector<uint32_t>& depths, TextureId id) {
  const Texture& t = textures[id];
  uint32_t deepest = 1;
  const TextureId operands[] = {t.a, t.b, t.amount};
  for (uint32_t i = 0; i < operand_count(t.kind); ++i) deepest = std::max(deepest, depths[operands[i]] + i);
  return deepest;
}

// The first rows of TextureSet::images of what programs look up, each image once.
struct Builder {
  const Scene& scene;
  TextureSet& set;
  std::map<ImageId, uint32_t> spectrum_rows;
  std::map<std::pair<ImageId, TextureChannel>, uint32_t> number_rows;
  uint32_t marble_row = no_index;  // of marble's colours
};

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

uint32_t add_number_image(Builder& b, ImageId id, TextureChannel channel, bool has_levels) {
  TextureSet& set = b.set;
  const Image& image = b.scene.images[id];
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
  constexpr uint32_t segments = 6, steps = 512;
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

void append_texels(Builder& b, const Image& image) {
  const Column<float> texels = image_texels(image, RgbKind::albedo, b.scene.settings.color);
  const size_t begin = b.set.texels.size();
  b.set.texels.resize(begin + texels.size());
  std::copy(texels.begin(), texels.end(), b.set.texels.begin() + static_cast<ptrdiff_t>(begin));
}

uint32_t add_image(Builder& b, const Image& image, bool has_levels) {
  const auto row = static_cast<uint32_t>(b.set.images.size());
  add_rows(b.set, b.set.texels.size() / 4, image.width, image.height, has_levels);
  append_texels(b, image);
  if (has_levels)
    for (const Image& level : reflectance_levels(image)) append_texels(b, level);
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
  set.texels.reserve(4 * spectrum_texels);
  set.numbers.reserve(number_texels);
  return true;
}

// The pixels of an image are given back after its last use, unless something else needs them.
void give_back(Scene* disposable, const ImageUses& uses, const std::vector<bool>& is_kept, ImageId id) {
  if (disposable == nullptr || is_kept[id]) return;
  const auto next = uses.numbers.lower_bound({id, TextureChannel::average});
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

bool add_images(Builder& b, Scene* disposable, Diagnostics& diagnostics) {
  const ImageUses uses = image_uses(b.scene);
  if (!reserve_texels(b.scene, uses, b.set, diagnostics)) return false;
  const std::vector<bool> is_kept = images_of_others(b.scene);
  for (const auto& [id, has_levels] : uses.spectra) {
    const Image& image = b.scene.images[id];
    b.spectrum_rows[id] =
        image.is_in_file
            ? add_cached_rows(b.set, image,
                              cache_spectra(*b.set.cache, image, has_levels, b.scene.settings.color, diagnostics))
            : add_image(b, image, has_levels);
    give_back(disposable, uses, is_kept, id);
  }
  for (const auto& [key, has_levels] : uses.numbers) {
    const Image& image = b.scene.images[key.first];
    b.number_rows[key] =
        image.is_in_file
            ? add_cached_rows(b.set, image, cache_numbers(*b.set.cache, image, key.second, has_levels, diagnostics))
            : add_number_image(b, key.first, key.second, has_levels);
  }
  return true;
}

TextureOp make_op(Builder& b, const Texture& t) {
  TextureOp op = t;
  if (t.kind == TextureKind::image)
    op.image = t.is_number != 0 ? b.number_rows.at({t.image, t.channel}) : b.spectrum_rows.at(t.image);
  if (t.kind == TextureKind::marble) {
    if (b.marble_row == no_index) b.marble_row = add_image(b, marble_colors(), false);
    op.image = b.marble_row;
  }
  return op;
}

// Operands are programs already made, as textures refer to earlier ones only.
void append_program(Builder& b, const Texture& t) {
  const auto begin = static_cast<uint32_t>(b.set.ops.size());
  const auto operand = [&](TextureId id) {
    const TextureProgram program = b.set.programs[id];
    for (uint32_t i = program.begin; i < program.end; ++i) b.set.ops.push_back(TextureOp(b.set.ops[i]));
  };
  const TextureId operands[] = {t.a, t.b, t.amount};
  for (uint32_t i = 0; i < operand_count(t.kind); ++i) operand(operands[i]);
  b.set.ops.push_back(make_op(b, t));
  b.set.programs.push_back({begin, static_cast<uint32_t>(b.set.ops.size())});
}

}  // namespace

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

void build_textures(const Scene& scene, Scene* disposable, World& world, Diagnostics& diagnostics) {
  world.textures.has_coefficients = scene.settings.color != ColorMode::spectral;
  Builder b{scene, world.textures, {}, {}};
  const bool has_files =
      std::any_of(scene.images.begin(), scene.images.end(), [](const Image& image) { return image.is_in_file; });
  if (has_files && !open_image_cache(world.textures, cache_bytes(scene), diagnostics)) return;
  if (!add_images(b, disposable, diagnostics)) return;
  for (const Texture& t : scene.textures)
    world.has_mips = world.has_mips || (t.kind == TextureKind::image && uses_levels(t.filter));
  std::vector<uint32_t> depths;
  for (TextureId id = 0; id < scene.textures.size(); ++id) {
    depths.push_back(stack_depth(scene.textures, depths, id));
    if (depths.back() > deepest_texture_stack)
      return diagnostics.error(
          {}, fmt::format("textures made of textures are nested more than {} deep", deepest_texture_stack));
    append_program(b, scene.textures[id]);
  }
}

}  // namespace metamer
