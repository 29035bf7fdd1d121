#include "systems/image_cache.h"

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <atomic>
#include <filesystem>

#include "engine/files/image_rows.h"
#include "systems/image_levels.h"
#include "systems/image_texels.h"

namespace metamer {

constexpr int tile_side = 64;

struct TextureCache {
  OIIO::ImageCache* tiles = nullptr;
  std::filesystem::path folder;
  std::vector<OIIO::ImageCache::ImageHandle*> files;
  uint64_t limit_bytes = 0, file_bytes = 0;
  mutable std::atomic<uint64_t> failed_lookups{0};

  ~TextureCache() {
    if (tiles != nullptr) OIIO::ImageCache::destroy(tiles);
    std::error_code ignored;
    if (!folder.empty()) std::filesystem::remove_all(folder, ignored);
  }
};

namespace {

// A tiled file of floats, written row by row.
class TileFile {
 public:
  bool open(const std::string& path, LevelSize size, uint32_t channels) {
    path_ = path;
    size_ = size;
    channels_ = channels;
    file_ = OIIO::ImageOutput::create(path);
    OIIO::ImageSpec spec(static_cast<int>(size.width), static_cast<int>(size.height), static_cast<int>(channels),
                         OIIO::TypeDesc::FLOAT);
    spec.tile_width = spec.tile_height = tile_side;
    spec.tile_depth = 1;
    spec.alpha_channel = -1;
    spec.attribute("compression", "none");
    return file_ && file_->open(path, spec);
  }
  // Rows must come from the top down; so many at a time that all but the last times a row of tiles is full.
  bool write(uint32_t first_row, uint32_t rows, const float* values) {
    return file_->write_tiles(0, static_cast<int>(size_.width), static_cast<int>(first_row),
                              static_cast<int>(first_row + rows), 0, 1, OIIO::TypeDesc::FLOAT, values);
  }
  bool close() { return file_->close(); }
  std::string error() const { return file_ ? file_->geterror() : OIIO::geterror(); }
  const std::string& path() const { return path_; }
  LevelSize size() const { return size_; }
  uint32_t channels() const { return channels_; }

 private:
  std::string path_;
  std::unique_ptr<OIIO::ImageOutput> file_;
  LevelSize size_{};
  uint32_t channels_ = 1;
};

// What becomes of an image's rows, level by level: collected until a row of tiles is full, then turned into texels and
// written.
struct Spool {
  const Image* image;
  ColorMode color;
  bool is_spectrum;
  uint32_t in_channels;  // of the rows; spectra are rgb
  struct Level {
    TileFile file;
    Image strip;  // of spectra, in rgb; else the numbers themselves
    uint32_t first_row = 0, rows = 0;
  };
  std::vector<Level> levels;
  std::string error;

  void flush(Level& level) {
    if (level.rows == 0 || !error.empty()) return;
    const float* values = level.strip.rgb.data();
    Column<float> texels;
    if (is_spectrum) {
      level.strip.height = level.rows;
      texels = image_texels(level.strip, RgbKind::albedo, color);
      values = texels.data();
    }
    if (!level.file.write(level.first_row, level.rows, values))
      error = fmt::format("cannot write '{}': {}", level.file.path(), level.file.error());
    level.first_row += level.rows;
    level.rows = 0;
  }
  void add(uint32_t nth, const float* row) {
    Level& level = levels[nth];
    const size_t length = size_t{in_channels} * level.strip.width;
    std::copy_n(row, length, level.strip.rgb.begin() + static_cast<ptrdiff_t>(level.rows * length));
    if (++level.rows == tile_side) flush(level);
  }
  static void take(void* context, uint32_t level, const float* row) { static_cast<Spool*>(context)->add(level, row); }
};

bool open_levels(TextureCache& cache, bool has_levels, Spool& spool) {
  std::vector<LevelSize> sizes = level_sizes(spool.image->width, spool.image->height);
  if (!has_levels) sizes.resize(1);
  spool.levels.resize(sizes.size());
  for (size_t nth = 0; nth < sizes.size(); ++nth) {
    Spool::Level& level = spool.levels[nth];
    level.strip.width = sizes[nth].width;
    level.strip.color_space = spool.image->color_space;
    level.strip.rgb.resize(size_t{spool.in_channels} * sizes[nth].width * tile_side);
    const std::string path = (cache.folder / fmt::format("{}.tif", cache.files.size() + nth)).string();
    if (level.file.open(path, sizes[nth], spool.is_spectrum ? 4 : spool.in_channels)) continue;
    spool.error = fmt::format("cannot write '{}': {}", path, level.file.error());
    return false;
  }
  return true;
}

std::vector<uint32_t> close_levels(TextureCache& cache, Spool& spool) {
  std::vector<uint32_t> places;
  for (Spool::Level& level : spool.levels) {
    spool.flush(level);
    if (spool.error.empty() && !level.file.close())
      spool.error = fmt::format("cannot write '{}': {}", level.file.path(), level.file.error());
    places.push_back(static_cast<uint32_t>(cache.files.size()));
    cache.files.push_back(cache.tiles->get_image_handle(OIIO::ustring(level.file.path())));
    const LevelSize size = level.file.size();
    cache.file_bytes += uint64_t{size.width} * size.height * level.file.channels() * sizeof(float);
  }
  return places;
}

// `prepare(rgb, alpha, row)` makes of a pixel row what the spool takes as the row of level 0; `limited(row)` what the
// other levels are made of.
template <class Prepare>
std::vector<uint32_t> cache_image(TextureCache& cache, const Image& image, Spool& spool, bool has_levels,
                                  Diagnostics& diagnostics, const Prepare& prepare) {
  ImageRows rows;
  const auto fail = [&](const std::string& why) {
    diagnostics.error({image.name, 0}, why);
    return std::vector<uint32_t>();
  };
  if (!rows.open(image.name, image.encoding)) return fail(fmt::format("cannot read it again: {}", rows.error()));
  if (!open_levels(cache, has_levels, spool)) return fail(spool.error);
  LevelRows levels(image.width, image.height, spool.in_channels, Spool::take, &spool);
  const size_t width = image.width;
  std::vector<float> rgb(3 * width), alpha(width, 1.0f), row(spool.in_channels * width);
  for (uint32_t y = 0; y < image.height && spool.error.empty(); ++y) {
    if (!rows.next(rgb.data(), alpha.data())) return fail(fmt::format("cannot read it again: {}", rows.error()));
    prepare(rgb.data(), alpha.data(), row.data());
    spool.add(0, row.data());
    if (!has_levels) continue;
    // What surfaces reflect is from 0 to 1, so means are of that.
    if (spool.is_spectrum)
      for (float& value : row) value = std::clamp(value, 0.0f, 1.0f);
    levels.add(row.data());
  }
  std::vector<uint32_t> places = close_levels(cache, spool);
  return spool.error.empty() ? places : fail(spool.error);
}

}  // namespace

bool open_image_cache(TextureSet& set, uint64_t bytes, Diagnostics& diagnostics) {
  auto* cache = new TextureCache;
  set.cache = {cache, [](TextureCache* c) { delete c; }};
  std::error_code code;
  std::string name = (std::filesystem::temp_directory_path(code) / "metamer-textures-XXXXXX").string();
  if (code || mkdtemp(name.data()) == nullptr) {
    diagnostics.error({}, fmt::format("no folder '{}' can be made for textures that do not fit in memory", name));
    return false;
  }
  cache->folder = name;
  cache->limit_bytes = bytes;
  cache->tiles = OIIO::ImageCache::create(false);
  cache->tiles->attribute("max_memory_MB", static_cast<float>(static_cast<double>(bytes) / (1 << 20)));
  cache->tiles->attribute("autotile", 0);
  cache->tiles->attribute("automip", 0);
  cache->tiles->attribute("forcefloat", 1);
  cache->tiles->attribute("unassociatedalpha", 1);  // the fourth number is no alpha
  return true;
}

std::vector<uint32_t> cache_spectra(TextureCache& cache, const Image& image, bool has_levels, ColorMode color,
                                    Diagnostics& diagnostics) {
  Spool spool{&image, color, true, 3, {}, {}};
  return cache_image(cache, image, spool, has_levels, diagnostics,
                     [&](const float* rgb, const float*, float* row) { std::copy_n(rgb, 3 * image.width, row); });
}

std::vector<uint32_t> cache_numbers(TextureCache& cache, const Image& image, TextureChannel channel, bool has_levels,
                                    Diagnostics& diagnostics) {
  Spool spool{&image, ColorMode::spectral, false, 1, {}, {}};
  return cache_image(cache, image, spool, has_levels, diagnostics,
                     [&](const float* rgb, const float* alpha, float* row) {
                       for (size_t x = 0; x < image.width; ++x) row[x] = pixel_number(rgb + 3 * x, alpha[x], channel);
                     });
}

std::vector<uint32_t> cache_normals(TextureCache& cache, const Image& image, Diagnostics& diagnostics) {
  Spool spool{&image, ColorMode::spectral, false, 3, {}, {}};
  return cache_image(cache, image, spool, false, diagnostics,
                     [&](const float* rgb, const float*, float* row) { std::copy_n(rgb, 3 * image.width, row); });
}

void fetch_texels(const TextureCache& cache, const uint32_t* files, const int32_t* columns, const int32_t* rows,
                  uint32_t count, uint32_t channels, float* out) {
  OIIO::ImageCache::Perthread* thread = cache.tiles->get_perthread_info();
  for (uint32_t lane = 0; lane < count; ++lane) {
    OIIO::ImageCache::Tile* tile =
        cache.tiles->get_tile(cache.files[files[lane]], thread, 0, 0, columns[lane], rows[lane], 0);
    OIIO::TypeDesc type;
    const auto* pixels = tile == nullptr ? nullptr : static_cast<const float*>(cache.tiles->tile_pixels(tile, type));
    if (pixels == nullptr) cache.failed_lookups.fetch_add(1, std::memory_order_relaxed);
    const auto at = static_cast<size_t>((rows[lane] % tile_side) * tile_side + columns[lane] % tile_side);
    for (uint32_t c = 0; c < channels; ++c) out[c * count + lane] = pixels == nullptr ? 0 : pixels[at * channels + c];
    if (tile != nullptr) cache.tiles->release_tile(tile);
  }
}

ImageCacheStats image_cache_stats(const TextureSet& set) {
  ImageCacheStats stats;
  if (!set.cache) return stats;
  const TextureCache& cache = *set.cache;
  const auto number = [&](const char* name) {
    int64_t value = 0;
    cache.tiles->getattribute(name, OIIO::TypeDesc::INT64, &value);
    return static_cast<uint64_t>(std::max<int64_t>(value, 0));
  };
  stats.files = cache.files.size();
  stats.file_bytes = cache.file_bytes;
  stats.limit_bytes = cache.limit_bytes;
  stats.held_bytes = number("stat:cache_memory_used");
  stats.read_bytes = number("stat:bytes_read");
  int created = 0;
  cache.tiles->getattribute("stat:tiles_created", created);
  stats.tiles_read = static_cast<uint64_t>(std::max(created, 0));
  stats.failed_lookups = cache.failed_lookups.load();
  return stats;
}

}  // namespace metamer
