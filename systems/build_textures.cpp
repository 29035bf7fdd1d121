#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "systems/freeze.h"
#include "systems/image_texels.h"

namespace metamer {
namespace {

constexpr size_t most_texels = size_t{1} << 29;  // kernels count floats in 31 bits

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

struct Builder {
  const Scene& scene;
  TextureSet& set;
  std::vector<uint32_t> image_rows;  // by ImageId: row of TextureSet::images, or no_index
  uint32_t marble_row = no_index;    // the same of marble's colours
  std::map<std::pair<ImageId, TextureChannel>, uint32_t> number_rows;  // the same of images as numbers
};

// A pixel as one number.
float number_of(const Image& image, size_t pixel, TextureChannel channel) {
  const float* rgb = image.rgb.data() + 3 * pixel;
  switch (channel) {
    case TextureChannel::red: return rgb[0];
    case TextureChannel::green: return rgb[1];
    case TextureChannel::blue: return rgb[2];
    case TextureChannel::alpha: return image.alpha.empty() ? 1 : image.alpha[pixel];
    case TextureChannel::average: break;
  }
  return (rgb[0] + rgb[1] + rgb[2]) / 3;
}

uint32_t add_number_image(Builder& b, ImageId id, TextureChannel channel) {
  const auto [known, is_new] = b.number_rows.try_emplace({id, channel}, static_cast<uint32_t>(b.set.images.size()));
  if (!is_new) return known->second;
  const Image& image = b.scene.images[id];
  const size_t count = size_t{image.width} * image.height, first = b.set.numbers.size();
  b.set.images.push_back({static_cast<uint32_t>(first), image.width, image.height});
  b.set.numbers.resize(first + count);
  for (size_t pixel = 0; pixel < count; ++pixel) b.set.numbers[first + pixel] = number_of(image, pixel, channel);
  return known->second;
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

void add_image(Builder& b, const Image& image, uint32_t& row) {
  if (row != no_index) return;
  row = static_cast<uint32_t>(b.set.images.size());
  b.set.images.push_back({static_cast<uint32_t>(b.set.texels.size() / 4), image.width, image.height});
  const Column<float> texels = image_texels(image, RgbKind::albedo, b.scene.settings.color);
  const size_t begin = b.set.texels.size();
  b.set.texels.resize(begin + texels.size());
  std::copy(texels.begin(), texels.end(), b.set.texels.begin() + static_cast<ptrdiff_t>(begin));
}

TextureOp make_op(Builder& b, const Texture& t) {
  TextureOp op = t;
  if (t.kind == TextureKind::image && t.is_number != 0) op.image = add_number_image(b, t.image, t.channel);
  if (t.kind == TextureKind::image && t.is_number == 0) {
    add_image(b, b.scene.images[t.image], b.image_rows[t.image]);
    op.image = b.image_rows[t.image];
  }
  if (t.kind == TextureKind::marble) {
    add_image(b, marble_colors(), b.marble_row);
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

uint32_t add_normal_map(const Image& image, ImageId id, TextureSet& set) {
  const auto known = std::find(set.normal_map_images.begin(), set.normal_map_images.end(), id);
  if (known != set.normal_map_images.end()) return static_cast<uint32_t>(known - set.normal_map_images.begin());
  const size_t first = set.numbers.size();
  set.normal_map_images.push_back(id);
  set.normal_maps.push_back({static_cast<uint32_t>(first), image.width, image.height});
  set.numbers.resize(first + image.rgb.size());
  std::copy(image.rgb.begin(), image.rgb.end(), set.numbers.begin() + static_cast<ptrdiff_t>(first));
  return static_cast<uint32_t>(set.normal_maps.size() - 1);
}

void build_textures(const Scene& scene, World& world, Diagnostics& diagnostics) {
  size_t texels = 0;
  for (const Image& image : scene.images) texels += size_t{image.width} * image.height;
  if (texels > most_texels)
    return diagnostics.error(
        {}, fmt::format("the images of all textures have {} pixels together; at most {} fit", texels, most_texels));
  world.textures.has_coefficients = scene.settings.color != ColorMode::spectral;
  Builder b{scene, world.textures, std::vector<uint32_t>(scene.images.size(), no_index), no_index, {}};
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
