#include "tests/scenes/support/texture_text.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace metamer {
namespace {

std::string spectrum(const Scene& scene, SpectrumId id) {
  std::string text[3];
  for (int i = 0; i < 3; ++i) text[i] = fmt::format("{:.4g}", scene.spectra.value(id, 450 + 100 * i));
  return text[0] == text[1] && text[1] == text[2] ? text[0] : fmt::format("({} {} {})", text[0], text[1], text[2]);
}

std::string mapping_text(const TextureMapping& m) {
  using Kind = TextureMapping::Kind;
  constexpr std::array names = {"", " spherical", " cylindrical", " planar", " point"};
  std::string text = names[static_cast<size_t>(m.kind)];
  if (m.kind == Kind::uv && (m.u_scale != 1 || m.v_scale != 1))
    text += fmt::format(" uv times {:.4g} {:.4g}", m.u_scale, m.v_scale);
  if (m.kind == Kind::planar)
    text += fmt::format(" along ({:.4g} {:.4g} {:.4g}) ({:.4g} {:.4g} {:.4g})", m.u_axis[0], m.u_axis[1], m.u_axis[2],
                        m.v_axis[0], m.v_axis[1], m.v_axis[2]);
  if (m.u_offset != 0 || m.v_offset != 0) text += fmt::format(" plus {:.4g} {:.4g}", m.u_offset, m.v_offset);
  const TextureMapping usual;
  if (m.kind == Kind::uv || std::equal(m.to_texture, m.to_texture + 12, usual.to_texture)) return text;
  text += " of [";
  for (int i = 0; i < 12; ++i)
    text += fmt::format("{}{:.4g}",
                        i == 0       ? ""
                        : i % 4 == 0 ? " | "
                                     : " ",
                        std::abs(m.to_texture[i]) < 1e-9f ? 0 : m.to_texture[i]);
  return text + "]";
}

std::string image_text(const Scene& scene, const Texture& t) {
  constexpr std::array filters = {" linear", " nearest", " trilinear", " anisotropic"};
  constexpr std::array wraps = {"", " clamped", " black outside", " octahedral"};
  constexpr std::array channels = {" mean", " red", " green", " blue", " alpha"};
  const Image& image = scene.images[t.image];
  std::string text = fmt::format("image {} x {}", image.width, image.height);
  if (t.is_number != 0) text += channels[static_cast<size_t>(t.channel)];
  if (!image.rgb.empty())
    text += fmt::format(" of ({:.3g} {:.3g} {:.3g}) first", image.rgb[0], image.rgb[1], image.rgb[2]);
  text += filters[static_cast<size_t>(t.filter)];
  if (t.filter == TextureFilter::anisotropic) text += fmt::format(" {:.4g}", t.most_anisotropy);
  text += wraps[static_cast<size_t>(t.wrap)];
  if (t.scale != 1) text += fmt::format(" times {:.4g}", t.scale);
  if (t.invert != 0) text += " inverted";
  return text + mapping_text(t.mapping);
}

}  // namespace

std::string texture_text(const Scene& scene, TextureId id) {
  const Texture& t = scene.textures[id];
  const auto operand = [&](TextureId nth) { return "[" + texture_text(scene, nth) + "]"; };
  const auto noise = [&](const char* name) {
    return fmt::format("{} octaves {} roughness {:.4g}{}", name, t.octaves, t.roughness, mapping_text(t.mapping));
  };
  switch (t.kind) {
    case TextureKind::constant: return t.is_number != 0 ? fmt::format("{:.4g}", t.value) : spectrum(scene, t.spectrum);
    case TextureKind::image: return image_text(scene, t);
    case TextureKind::scale: return operand(t.a) + " times " + operand(t.b);
    case TextureKind::mix: return fmt::format("{} to {} by {}", operand(t.a), operand(t.b), operand(t.amount));
    case TextureKind::checkerboard:
      return fmt::format("board of {} and {}{}", operand(t.a), operand(t.b), mapping_text(t.mapping));
    case TextureKind::coordinate: return fmt::format("coordinate {}{}", t.axis, mapping_text(t.mapping));
    case TextureKind::facing:
      return fmt::format("facing ({:.4g} {:.4g} {:.4g})", t.axis_direction[0], t.axis_direction[1],
                         t.axis_direction[2]);
    case TextureKind::dots: return "dots" + mapping_text(t.mapping);
    case TextureKind::fbm: return noise("fbm");
    case TextureKind::wrinkled: return noise("wrinkled");
    case TextureKind::windy: return "windy" + mapping_text(t.mapping);
    case TextureKind::marble:
      return noise("marble") + fmt::format(" scale {:.4g} variation {:.4g}", t.scale, t.variation);
    case TextureKind::square_root: return "root of " + operand(t.a);
  }
  return "?";
}

}  // namespace metamer
