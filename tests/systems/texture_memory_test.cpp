// Textures that do not fit in memory: which, and that nobody sees it.
#include "systems/texture_memory.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "engine/files/image_rows.h"
#include "systems/image_cache.h"
#include "tests/systems/support/textured_scene.h"

namespace metamer {
namespace {

struct Folder {
  std::filesystem::path path;
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "metamer-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error(name);
    path = name;
  }
  ~Folder() { std::filesystem::remove_all(path); }
};

// Colours (and alpha) that look like noise.
std::string write_noise(const std::filesystem::path& path, int width, int height, int channels) {
  const auto file = OIIO::ImageOutput::create(path.string());
  const OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  std::vector<uint8_t> pixels(static_cast<size_t>(width) * static_cast<size_t>(height) * static_cast<size_t>(channels));
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<uint8_t>(i * 2654435761u >> 13);
  EXPECT_TRUE(file && file->open(path.string(), spec) && file->write_image(OIIO::TypeDesc::UINT8, pixels.data()) &&
              file->close());
  return path.string();
}

ImageId add_file(Scene& scene, const std::string& path, bool in_file, double gamma = 0) {
  Image image;
  image.name = path;
  image.encoding.gamma = gamma;
  image.is_in_file = in_file;
  ImageRows rows;
  EXPECT_TRUE(rows.open(path, image.encoding)) << rows.error();
  image.width = rows.width();
  image.height = rows.height();
  if (!in_file) {
    image.rgb.resize(size_t{3} * image.width * image.height);
    if (rows.has_alpha()) image.alpha.resize(size_t{image.width} * image.height);
    for (size_t y = 0; y < image.height; ++y)
      EXPECT_TRUE(rows.next(image.rgb.data() + 3 * y * image.width,
                            rows.has_alpha() ? image.alpha.data() + y * image.width : nullptr));
  }
  scene.images.push_back(image);
  return static_cast<ImageId>(scene.images.size() - 1);
}

Image sized(uint32_t width, uint32_t height) {
  Image image;
  image.width = width;
  image.height = height;
  image.is_in_file = true;
  return image;
}

TEST(TextureMemory, CountsWhatTexturesMakeOfAnImage) {
  Scene scene;
  scene.images = {sized(8, 4), sized(8, 4), sized(4, 4), sized(100, 100)};
  Texture texture;
  texture.kind = TextureKind::image;
  scene.textures.push_back(texture);  // spectra of image 0
  texture.image = 1;
  texture.filter = TextureFilter::trilinear;
  scene.textures.push_back(texture);  // with levels 8x4, 4x2, 2x1, 1x1
  texture.is_number = 1;
  texture.filter = TextureFilter::linear;
  scene.textures.push_back(texture);  // and as numbers
  Material material;
  material.normal_map = 2;
  scene.registry.set(scene.registry.create(), material);
  EXPECT_THAT(texture_bytes(scene), testing::ElementsAre(32 * 16, (32 + 8 + 2 + 1) * 16 + 32 * 4, 16 * 12, 0));
}

TEST(TextureMemory, LeavesTheLargestInTheirFiles) {
  Scene scene;
  scene.images = {sized(64, 64), sized(256, 256), sized(128, 128), sized(64, 64)};
  for (ImageId id = 0; id < 4; ++id) {
    Texture texture;
    texture.kind = TextureKind::image;
    texture.image = id;
    scene.textures.push_back(texture);
  }
  constexpr uint64_t unit = 64 * 64 * 16;  // in all 1 + 16 + 4 + 1 of them
  scene.texture_memory = 22 * unit;
  EXPECT_THAT(images_that_fit(scene), testing::ElementsAre(true, true, true, true));
  scene.texture_memory = 21 * unit;
  EXPECT_THAT(images_that_fit(scene), testing::ElementsAre(true, false, true, true));
  scene.texture_memory = 8 * unit;
  EXPECT_THAT(images_that_fit(scene), testing::ElementsAre(true, false, true, true));
  scene.texture_memory = 7 * unit;  // three quarters of it are less than 6
  EXPECT_THAT(images_that_fit(scene), testing::ElementsAre(true, false, false, true));
}

// A square with everything that looks images up: colours by all filters, roughness, alpha, displacement, a normal map.
std::vector<PathRadiance> seen(const std::string& colours, bool in_file, ColorMode color) {
  TexturedScene s;
  s.b.scene.settings.width = s.b.scene.settings.height = 32;
  s.b.scene.settings.color = color;
  s.b.scene.texture_memory = 1 << 20;
  const ImageId image = add_file(s.b.scene, colours, in_file);
  const auto add = [&](TextureFilter filter, TextureWrap wrap) {
    Texture texture;
    texture.kind = TextureKind::image;
    texture.image = image;
    texture.filter = filter;
    texture.wrap = wrap;
    return texture;
  };
  const TextureId a = s.add(add(TextureFilter::linear, TextureWrap::black));
  const TextureId b = s.add(add(TextureFilter::anisotropic, TextureWrap::repeat));
  Texture amount = add(TextureFilter::trilinear, TextureWrap::clamp);
  amount.is_number = 1;
  amount.channel = TextureChannel::green;
  Material material = s.b.diffuse(0.123);
  material.reflectance_texture = s.add(s.combination(TextureKind::mix, a, b, s.add(amount)));
  material.normal_map = add_file(s.b.scene, colours, in_file, 1);
  Geometry square = rectangle(1, 1);
  Texture alpha = add(TextureFilter::nearest, TextureWrap::repeat);
  alpha.is_number = 1;
  alpha.channel = TextureChannel::alpha;
  square.alpha_texture = s.add(alpha);
  s.b.add(square, material);
  Material metal = s.b.conductor(s.b.constant(1.5), s.b.constant(3));
  Texture roughness = add(TextureFilter::trilinear, TextureWrap::repeat);
  roughness.is_number = 1;
  metal.alpha_x_texture = metal.alpha_y_texture = s.add(roughness);
  Texture bumps = roughness;
  bumps.scale = 0.001f;
  metal.displacement = s.add(bumps);
  s.b.add(sphere(0.3f), metal);
  s.b.light(LightKind::directional, s.b.constant(pi), 1);
  s.b.look_at({0.2, -0.3, 1}, {0, 0, 0}, perspective(60));
  return trace_radiances(*s.b.freeze());
}

TEST(TextureMemory, LookupsInFilesFindTheSameBits) {
  const Folder folder;
  for (const int channels : {3, 4}) {
    const std::string file = write_noise(folder.path / "noise.png", 150, 70, channels);
    for (const ColorMode color : {ColorMode::spectral, ColorMode::rgb}) {
      const auto here = seen(file, false, color), there = seen(file, true, color);
      ASSERT_EQ(here.size(), there.size());
      size_t different = 0, lit = 0;
      for (size_t i = 0; i < here.size(); ++i) {
        different += here[i].radiance != there[i].radiance ? 1 : 0;
        lit += here[i].radiance[0] > 0 ? 1 : 0;
      }
      EXPECT_EQ(different, 0u) << channels;
      EXPECT_GT(lit, here.size() / 8);
    }
  }
}

TEST(TextureMemory, TheCacheHoldsNoMoreThanItMay) {
  const Folder folder;
  TexturedScene s;
  s.b.scene.settings.width = s.b.scene.settings.height = 128;
  s.b.scene.texture_memory = 1;  // the cache gets what it needs at least
  const TextureId texture = [&] {
    Texture image;
    image.kind = TextureKind::image;
    image.image = add_file(s.b.scene, write_noise(folder.path / "large.png", 1600, 1600, 3), true);
    image.filter = TextureFilter::linear;
    return s.add(image);
  }();
  Material material = s.b.diffuse(0.123);
  material.reflectance_texture = texture;
  s.b.add(rectangle(1, 1), material);
  s.b.light(LightKind::directional, s.b.constant(pi), 1);
  s.b.look_at({0, 0, 1}, {0, 0, 0}, orthographic(1));
  const auto world = s.b.freeze();
  std::filesystem::path spool;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::temp_directory_path()))
    if (entry.path().filename().string().starts_with("metamer-textures-")) spool = entry.path();
  EXPECT_FALSE(spool.empty());
  const Film film = render_film(*world);
  const ImageCacheStats stats = image_cache_stats(world->textures);
  EXPECT_EQ(stats.limit_bytes, least_cache_bytes);
  EXPECT_EQ(stats.file_bytes, 1600u * 1600 * 16);
  EXPECT_EQ(stats.failed_lookups, 0u);
  EXPECT_GT(stats.tiles_read * 64 * 64 * 16, least_cache_bytes);  // tiles had to go
  // Each thread may keep some tiles that the cache has dropped.
  EXPECT_LT(stats.held_bytes, least_cache_bytes + (uint64_t{4} << 20));
  EXPECT_EQ(film.invalid_samples(), 0u);
}

TEST(TextureMemory, WhatCannotBeReadAgainIsAnError) {
  TexturedScene s;
  s.b.scene.texture_memory = 1;
  s.b.scene.images.push_back(sized(4, 4));
  s.b.scene.images[0].name = "/nowhere/at-all.png";
  Texture image;
  image.kind = TextureKind::image;
  s.add(image);
  s.b.look_at({0, 0, 1}, {0, 0, 0}, orthographic(1));
  Diagnostics diagnostics;
  EXPECT_EQ(freeze(s.b.scene, diagnostics), nullptr);
  EXPECT_THAT(format_diagnostics(diagnostics), testing::HasSubstr("/nowhere/at-all.png: error: cannot read it again"));
}

}  // namespace
}  // namespace metamer
