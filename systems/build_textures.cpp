#include <fmt/format.h>

#include <algorithm>

#include "systems/build_texture_images.h"

namespace metamer {
namespace {

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

TextureOp make_op(const TextureImages& images, const Texture& t) {
  TextureOp op = t;
  if (t.kind == TextureKind::image)
    op.image = t.is_number != 0 ? images.number_rows.at({t.image, t.channel}) : images.spectrum_rows.at(t.image);
  if (t.kind == TextureKind::marble) op.image = images.marble_row;
  return op;
}

// Operands are programs already made, as textures refer to earlier ones only.
void append_program(const TextureImages& images, const Texture& t, TextureSet& set) {
  const auto begin = static_cast<uint32_t>(set.ops.size());
  const auto operand = [&](TextureId id) {
    const TextureProgram program = set.programs[id];
    for (uint32_t i = program.begin; i < program.end; ++i) set.ops.push_back(TextureOp(set.ops[i]));
  };
  const TextureId operands[] = {t.a, t.b, t.amount};
  for (uint32_t i = 0; i < operand_count(t.kind); ++i) operand(operands[i]);
  set.ops.push_back(make_op(images, t));
  set.programs.push_back({begin, static_cast<uint32_t>(set.ops.size())});
}

}  // namespace

void build_textures(const Scene& scene, Scene* disposable, World& world, Diagnostics& diagnostics) {
  world.textures.has_coefficients = scene.settings.color != ColorMode::spectral;
  TextureImages images{scene, world.textures, {}, {}};
  if (!add_texture_images(images, disposable, diagnostics)) return;
  for (const Texture& t : scene.textures)
    world.has_mips = world.has_mips || (t.kind == TextureKind::image && uses_levels(t.filter));
  std::vector<uint32_t> depths;
  for (TextureId id = 0; id < scene.textures.size(); ++id) {
    depths.push_back(stack_depth(scene.textures, depths, id));
    if (depths.back() > deepest_texture_stack)
      return diagnostics.error(
          {}, fmt::format("textures made of textures are nested more than {} deep", deepest_texture_stack));
    append_program(images, scene.textures[id], world.textures);
  }
}

}  // namespace metamer
