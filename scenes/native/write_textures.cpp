#include <fmt/format.h>

#include "scenes/native/write_parts.h"

namespace metamer {
namespace {

std::string_view wrap_name(TextureWrap wrap) {
  switch (wrap) {
    case TextureWrap::repeat: return "repeat";
    case TextureWrap::clamp: return "clamp";
    case TextureWrap::black: return "black";
    case TextureWrap::octahedral: return "octahedral";
  }
  return {};
}

std::string_view filter_name(TextureFilter filter) {
  switch (filter) {
    case TextureFilter::linear: return "linear";
    case TextureFilter::nearest: return "nearest";
    case TextureFilter::trilinear: return "trilinear";
    case TextureFilter::anisotropic: return "anisotropic";
  }
  return {};
}

std::string_view channel_name(TextureChannel channel) {
  switch (channel) {
    case TextureChannel::average: return "average";
    case TextureChannel::red: return "red";
    case TextureChannel::green: return "green";
    case TextureChannel::blue: return "blue";
    case TextureChannel::alpha: return "alpha";
  }
  return {};
}

JsonText write_mapping(const TextureMapping& mapping) {
  using Kind = TextureMapping::Kind;
  JsonText object = JsonText::object();
  const auto type = [&](std::string_view name) { object.add("type", JsonText::string(name)); };
  const auto offset = [&] {
    if (mapping.u_offset != 0 || mapping.v_offset != 0)
      object.add("offset", JsonText::numbers(std::array{mapping.u_offset, mapping.v_offset}));
  };
  const auto space = [&] {
    JsonText rows = JsonText::array();
    for (size_t row = 0; row < 3; ++row) rows.add(JsonText::numbers(std::span(mapping.to_texture).subspan(4 * row, 4)));
    object.add("to_texture", std::move(rows));
  };
  switch (mapping.kind) {
    case Kind::uv:
      type("uv");
      if (mapping.u_scale != 1 || mapping.v_scale != 1)
        object.add("scale", JsonText::numbers(std::array{mapping.u_scale, mapping.v_scale}));
      offset();
      break;
    case Kind::spherical:
      type("spherical");
      space();
      break;
    case Kind::cylindrical:
      type("cylindrical");
      space();
      break;
    case Kind::planar:
      type("planar");
      space();
      object.add("u_axis", JsonText::numbers(mapping.u_axis));
      object.add("v_axis", JsonText::numbers(mapping.v_axis));
      offset();
      break;
    case Kind::point:
      type("point");
      space();
      break;
  }
  return object;
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
      case TextureKind::coordinate: {
        constexpr std::string_view axes[] = {"u", "v", "w"};
        type("coordinate");
        object_.add("axis", JsonText::string(axes[texture_.axis]));
        mapping();
        return object_;
      }
      case TextureKind::facing:
        type("facing");
        object_.add("direction", JsonText::numbers(texture_.axis_direction));
        return object_;
      case TextureKind::dots: return pattern("dots");
      case TextureKind::fbm: return pattern("fbm");
      case TextureKind::wrinkled: return pattern("wrinkled");
      case TextureKind::windy: return pattern("windy");
      case TextureKind::marble: return pattern("marble");
      case TextureKind::square_root:
        type("square_root");
        operand("a", texture_.a);
        return object_;
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
    const ImageFile file = context_.texture_image_file(texture_.image);
    object_.add("image", JsonText::string(context_.folder + "/" + file.name));
    if (file.is_linear) object_.add("encoding", JsonText::string("linear"));
    // Without it the file's own counts.
    object_.add("space", JsonText::string(color_space_name(context_.scene.images[texture_.image].color_space)));
    if (texture_.wrap != TextureWrap::repeat) object_.add("wrap", JsonText::string(wrap_name(texture_.wrap)));
    if (texture_.filter != TextureFilter::anisotropic)
      object_.add("filter", JsonText::string(filter_name(texture_.filter)));
    else if (texture_.most_anisotropy != 8)
      object_.add("anisotropy", JsonText::number(texture_.most_anisotropy));
    if (texture_.scale != 1) object_.add("scale", JsonText::number(texture_.scale));
    if (texture_.invert != 0) object_.add("invert", JsonText::boolean(true));
    if (texture_.channel != TextureChannel::average)
      object_.add("channel", JsonText::string(channel_name(texture_.channel)));
    mapping();
  }

  JsonText pattern(std::string_view name) {
    type(name);
    if (texture_.kind == TextureKind::marble) {
      object_.add("scale", JsonText::number(texture_.scale));
      object_.add("variation", JsonText::number(texture_.variation));
    }
    if (texture_.kind != TextureKind::dots && texture_.kind != TextureKind::windy) {
      object_.add("octaves", JsonText::integer(texture_.octaves));
      object_.add("roughness", JsonText::number(texture_.roughness));
    }
    mapping();
    return object_;
  }

  void mapping() {
    const TextureMapping& m = texture_.mapping;
    const bool is_usual =
        m.kind == TextureMapping::Kind::uv && m.u_scale == 1 && m.v_scale == 1 && m.u_offset == 0 && m.v_offset == 0;
    if (!is_usual) object_.add("mapping", write_mapping(m));
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
