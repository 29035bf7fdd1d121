// Textures: values that vary over a surface. As the author makes them (Texture, a node that refers to other nodes), and
// as kernels run them (TextureSet: programs in postfix order over one stack, and all texels in one column).
#pragma once
#include <cstdint>
#include <vector>

#include "engine/simd/column.h"

namespace metamer {

using TextureId = uint32_t;  // an index into Scene::textures

// constant      `spectrum`, or `value` where the texture is a plain number
// image         `image` at (u, v) by `mapping`, v = 0 being the lower edge; `scale` times it, then, if `invert`, 1 - it
// scale         a times b
// mix           (1 - amount) a + amount b
// checkerboard  a where floor(u) + floor(v) is even, else b
enum class TextureKind : uint32_t { constant, image, scale, mix, checkerboard };
enum class TextureWrap : uint32_t { repeat, clamp, black };

// u' = u_scale u + u_offset, v' alike.
struct UvMapping {
  float u_scale = 1, v_scale = 1, u_offset = 0, v_offset = 0;
};

struct Texture {
  TextureKind kind = TextureKind::constant;
  uint32_t spectrum = 0;  // SpectrumId
  float value = 0;
  uint32_t is_number = 0;  // 1: a number (roughness, amount), 0: a reflectance
  uint32_t image = 0;      // ImageId
  TextureWrap wrap = TextureWrap::repeat;
  uint32_t nearest = 0;  // 1: the nearest texel, 0: linear between texels
  uint32_t invert = 0;
  float scale = 1;
  UvMapping mapping;
  TextureId a = 0, b = 0, amount = 0;  // earlier textures
};

enum class TextureOpcode : uint32_t { spectrum, number, image, multiply, mix, checkerboard };

// Takes its operands from the stack (none, two or three of them, in the order a, b, amount) and leaves its value there.
struct TextureOp {
  TextureOpcode code = TextureOpcode::number;
  uint32_t spectrum = 0;
  float number = 0;
  uint32_t image = 0;  // row of TextureSet::images
  TextureWrap wrap = TextureWrap::repeat;
  uint32_t nearest = 0, invert = 0;
  UvMapping mapping;
};
inline constexpr uint32_t deepest_texture_stack = 16;

struct TextureProgram {
  uint32_t begin = 0, end = 0;  // of TextureSet::ops
};
struct TextureImage {
  uint32_t first_texel = 0;
  uint32_t width = 0, height = 0;
};

struct TextureSet {
  std::vector<TextureOp> ops;
  std::vector<TextureProgram> programs;
  std::vector<TextureImage> images;
  Column<float> texels;           // four per texel: the sigmoid's c0 c1 c2, and a factor on it; or as below
  bool has_coefficients = false;  // RGB mode: the texel's three coefficients and 0
  size_t bytes() const { return ops.size() * sizeof(TextureOp) + texels.bytes(); }
};

}  // namespace metamer
