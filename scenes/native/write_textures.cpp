#include <fmt/format.h>

#include "scenes/native/write_parts.h"

namespace metamer {
namespace {

std::string_view wrap_name(TextureWrap wrap) {
  switch (wrap) {
    case TextureWrap::repeat: return "repeat";
    case TextureWrap::clamp: return "clamp";
    case TextureWrap::black: return "black";
  }
  return {};
}

class TextureWriter {
 public:
  TextureWriter(WriteContext& context, const Texture& texture) : context_(context), texture_(texture) {}

  JsonText write() {
    switch (texture_.kind) {
      case TextureKind::constant:
        type("constant");
        object_.add("value", constant(texture_));
        break;
      case TextureKind::image: image(); break;
      case TextureKind::scale:
        type("scale");
        operand("a", texture_.a);
        operand("b", texture_.b);
        break;
      case TextureKind::mix:
        type("mix");
        operand("a", texture_.a);
        operand("b", texture_.b);
        operand("amount", texture_.amount);
        break;
      case TextureKind::checkerboard:
        type("checkerboard");
        operand("a", texture_.a);
        operand("b", texture_.b);
        mapping();
        break;
    }
    if (texture_.is_number != 0) object_.add("number", JsonText::boolean(true));
    return object_;
  }

 private:
  void type(std::string_view name) { object_.add("type", JsonText::string(name)); }

  JsonText constant(const Texture& texture) {
    return texture.is_number != 0 ? JsonText::number(texture.value)
                                  : context_.spectra.write_reflectance(texture.spectrum);
  }

  void operand(std::string_view key, TextureId id) {
    const Texture& texture = context_.scene.textures[id];
    object_.add(key, texture.kind == TextureKind::constant ? constant(texture) : context_.texture(id));
  }

  void image() {
    type("image");
    const ImageFile file = context_.image_file(texture_.image);
    object_.add("image", JsonText::string(context_.folder + "/" + file.name));
    if (file.is_linear) object_.add("encoding", JsonText::string("linear"));
    const ColorSpace space = context_.scene.images[texture_.image].color_space;
    if (space != ColorSpace::srgb) object_.add("space", JsonText::string(color_space_name(space)));
    if (texture_.wrap != TextureWrap::repeat) object_.add("wrap", JsonText::string(wrap_name(texture_.wrap)));
    if (texture_.nearest != 0) object_.add("filter", JsonText::string("nearest"));
    if (texture_.scale != 1) object_.add("scale", JsonText::number(texture_.scale));
    if (texture_.invert != 0) object_.add("invert", JsonText::boolean(true));
    mapping();
  }

  void mapping() {
    const UvMapping &uv = texture_.mapping, usual;
    JsonText object = JsonText::object();
    if (uv.u_scale != usual.u_scale || uv.v_scale != usual.v_scale)
      object.add("scale", JsonText::numbers(std::array{uv.u_scale, uv.v_scale}));
    if (uv.u_offset != usual.u_offset || uv.v_offset != usual.v_offset)
      object.add("offset", JsonText::numbers(std::array{uv.u_offset, uv.v_offset}));
    if (!object.empty()) object_.add("uv", std::move(object));
  }

  WriteContext& context_;
  const Texture& texture_;
  JsonText object_ = JsonText::object();
};

}  // namespace

// Its parts come before it: a file's textures refer to earlier ones.
JsonText WriteContext::texture(TextureId id) {
  const auto known = texture_names.find(id);
  if (known != texture_names.end()) return JsonText::object().add("texture", JsonText::string(known->second));
  JsonText definition = TextureWriter(*this, scene.textures[id]).write();
  const std::string name = fmt::format("texture {}", texture_names.size() + 1);
  texture_names[id] = name;
  texture_definitions.add(name, std::move(definition));
  return JsonText::object().add("texture", JsonText::string(name));
}

}  // namespace metamer
