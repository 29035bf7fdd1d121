#include <fmt/format.h>

#include <algorithm>

#include "systems/freeze.h"
#include "systems/image_texels.h"

namespace metamer {
namespace {

constexpr size_t most_texels = size_t{1} << 29;  // kernels count floats in 31 bits

// How deep the stack grows while a texture is computed, its operands in their order.
uint32_t stack_depth(const std::vector<Texture>& textures, const std::vector<uint32_t>& depths, TextureId id) {
  const Texture& t = textures[id];
  const auto depth = [&](TextureId child, uint32_t below) { return depths[child] + below; };
  switch (t.kind) {
    case TextureKind::constant:
    case TextureKind::image: return 1;
    case TextureKind::scale:
    case TextureKind::checkerboard: return std::max(depth(t.a, 0), depth(t.b, 1));
    case TextureKind::mix: return std::max({depth(t.a, 0), depth(t.b, 1), depth(t.amount, 2)});
  }
  return 1;
}

struct Builder {
  const Scene& scene;
  TextureSet& set;
  std::vector<uint32_t> image_rows;  // by ImageId: row of TextureSet::images, or no_index
};

uint32_t add_image(Builder& b, ImageId id) {
  uint32_t& row = b.image_rows[id];
  if (row != no_index) return row;
  row = static_cast<uint32_t>(b.set.images.size());
  const Image& image = b.scene.images[id];
  b.set.images.push_back({static_cast<uint32_t>(b.set.texels.size() / 4), image.width, image.height});
  const Column<float> texels = image_texels(image, RgbKind::albedo, b.scene.settings.color);
  const size_t begin = b.set.texels.size();
  b.set.texels.resize(begin + texels.size());
  std::copy(texels.begin(), texels.end(), b.set.texels.begin() + static_cast<ptrdiff_t>(begin));
  return row;
}

TextureOp make_op(Builder& b, const Texture& t) {
  TextureOp op;
  op.spectrum = t.spectrum;
  op.number = t.kind == TextureKind::image ? t.scale : t.value;
  op.wrap = t.wrap;
  op.nearest = t.nearest;
  op.invert = t.invert;
  op.mapping = t.mapping;
  switch (t.kind) {
    case TextureKind::constant: op.code = t.is_number != 0 ? TextureOpcode::number : TextureOpcode::spectrum; break;
    case TextureKind::image:
      op.code = TextureOpcode::image;
      op.image = add_image(b, t.image);
      break;
    case TextureKind::scale: op.code = TextureOpcode::multiply; break;
    case TextureKind::mix: op.code = TextureOpcode::mix; break;
    case TextureKind::checkerboard: op.code = TextureOpcode::checkerboard; break;
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
  if (t.kind != TextureKind::constant && t.kind != TextureKind::image) {
    operand(t.a);
    operand(t.b);
    if (t.kind == TextureKind::mix) operand(t.amount);
  }
  b.set.ops.push_back(make_op(b, t));
  b.set.programs.push_back({begin, static_cast<uint32_t>(b.set.ops.size())});
}

}  // namespace

void build_textures(const Scene& scene, World& world, Diagnostics& diagnostics) {
  size_t texels = 0;
  for (const Image& image : scene.images) texels += size_t{image.width} * image.height;
  if (texels > most_texels)
    return diagnostics.error(
        {}, fmt::format("the images of all textures have {} pixels together; at most {} fit", texels, most_texels));
  world.textures.has_coefficients = scene.settings.color != ColorMode::spectral;
  Builder b{scene, world.textures, std::vector<uint32_t>(scene.images.size(), no_index)};
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
