// Textures: values that vary over a surface. As the author makes them (Texture, a node that refers to other nodes), and
// as kernels run them (TextureSet: programs in postfix order over one stack, and all texels in one column).
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/simd/column.h"

namespace metamer {

using TextureId = uint32_t;  // an index into Scene::textures

// constant      `spectrum`, or `value` where the texture is a plain number
// image         `image` at (u, v) by `mapping`, v = 0 being the lower edge; `scale` times it, then, if `invert`, 1 - it
// scale         a times b
// mix           (1 - amount) a + amount b
// checkerboard  a where floor(u) + floor(v) is even, else b; with three coordinates where all three make an even sum
// and plain numbers, functions of the place alone, without operands:
// coordinate    that of the mapping which `axis` counts
// facing        |cosine| between the geometric normal and `axis_direction` (in the world)
// dots          1 in dots of radius 0.35 around some integer points, else 0
// fbm wrinkled  `octaves` of noise with weights roughness^i, and of its magnitude
// windy         waves
// square_root   of a, a number; 0 where that is negative
// and marble    a reflectance: layers along y, `scale` of them, bent by noise of amplitude `variation`
enum class TextureKind : uint32_t {
  constant,
  image,
  scale,
  mix,
  checkerboard,
  coordinate,
  facing,
  dots,
  fbm,
  wrinkled,
  windy,
  marble,
  square_root,
};
// What of a pixel a number is.
enum class TextureChannel : uint32_t { average, red, green, blue, alpha };
// Between the texels of an image, and which of its levels, each half as wide and high as the one before (level 0 is the
// file): linear and nearest level 0; trilinear and anisotropic levels whose texels are as large as what a lookup stands
// for (systems/footprint-inl.h), by its longest diameter or by its shortest one, but at least the longest one over
// `most_anisotropy`.
enum class TextureFilter : uint32_t { linear, nearest, trilinear, anisotropic };
constexpr bool uses_levels(TextureFilter filter) { return filter >= TextureFilter::trilinear; }
// octahedral: over the edge of a square that is an unfolded sphere, to where its faces touch.
enum class TextureWrap : uint32_t { repeat, clamp, black, octahedral };

// Where on a texture a point of a surface lies.
struct TextureMapping {
  enum class Kind : uint32_t {
    uv,           // u_scale u + u_offset, v alike
    spherical,    // polar angle over pi, azimuth over 2 pi
    cylindrical,  // azimuth over 2 pi plus a half, z
    planar,       // along u_axis plus u_offset, v alike
    point,        // all three coordinates
  };
  Kind kind = Kind::uv;
  float u_scale = 1, v_scale = 1, u_offset = 0, v_offset = 0;
  float to_texture[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  // from the world, row-major 3x4; not for uv
  float u_axis[3] = {1, 0, 0}, v_axis[3] = {0, 1, 0};
};

// What a texture is, but for its operands.
struct TextureOp {
  TextureKind kind = TextureKind::constant;
  uint32_t spectrum = 0;  // SpectrumId
  float value = 0;
  uint32_t is_number = 0;                            // 1: a number (roughness, amount), 0: a reflectance
  uint32_t image = 0;                                // ImageId; in programs a row of TextureSet::images
  TextureChannel channel = TextureChannel::average;  // of a number
  TextureWrap wrap = TextureWrap::repeat;
  TextureFilter filter = TextureFilter::linear;
  float most_anisotropy = 8;  // at least 1
  uint32_t invert = 0;
  float scale = 1;
  TextureMapping mapping;
  uint32_t axis = 0;  // 0 to 2
  float axis_direction[3] = {0, 1, 0};
  uint32_t octaves = 8;
  float roughness = 0.5f, variation = 0.2f;
};

// A node. As an operation of a program it takes its operands (none to three) from the stack, in the order a, b, amount,
// and leaves its value there.
struct Texture : TextureOp {
  TextureId a = 0, b = 0, amount = 0;  // earlier textures
};
inline constexpr uint32_t deepest_texture_stack = 16;

struct TextureProgram {
  uint32_t begin = 0, end = 0;  // of TextureSet::ops
};
// An image or a level of one. The levels of an image follow it, row by row.
struct TextureImage {
  uint32_t first_texel = 0;  // of spectra in `texels`, of numbers and normals in `numbers`
  uint32_t width = 0, height = 0;
  uint32_t levels = 1;  // from this row on
};
static_assert(sizeof(TextureImage) == 4 * sizeof(uint32_t));

// Texels that stay in files: OpenImageIO's cache. Known to systems/texture_cache.* only.
struct TextureCache;

struct TextureSet {
  std::vector<TextureOp> ops;
  std::vector<TextureProgram> programs;
  std::vector<TextureImage> images;
  std::vector<TextureImage> normal_maps;    // three numbers per texel: the file's red, green, blue
  std::vector<uint32_t> normal_map_images;  // their ImageId
  Column<float> texels;                     // four per texel: the sigmoid's c0 c1 c2, and a factor on it; or as below
  bool has_coefficients = false;            // RGB mode: the texel's three coefficients and 0
  Column<float> numbers;                    // one per texel
  // Levels whose texels are looked up in the cache: by row of images and of normal_maps its place there, or no_index.
  // Empty where there are none.
  std::vector<uint32_t> image_files, normal_map_files;
  std::unique_ptr<TextureCache, void (*)(TextureCache*)> cache{nullptr, nullptr};
  size_t bytes() const { return ops.size() * sizeof(TextureOp) + texels.bytes() + numbers.bytes(); }
};

}  // namespace metamer
