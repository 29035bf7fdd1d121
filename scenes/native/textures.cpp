// The file's "textures", and the components' parameters that may be one.
#include <fmt/format.h>

#include "scenes/images/read_image.h"
#include "scenes/native/components.h"
#include "scenes/native/spectra.h"
#include "scenes/native/varying.h"

namespace metamer {
namespace {

// In the order of the enumerations.
constexpr std::string_view wrap_names[] = {"repeat", "clamp", "black", "octahedral"};
constexpr std::string_view filter_names[] = {"linear", "nearest", "trilinear", "anisotropic"};
constexpr uint32_t most_texture_octaves = 64;  // beyond, a cell of the noise is smaller than a float can tell
constexpr Range at_least_one{1, largest_float};
constexpr std::string_view axis_names[] = {"u", "v", "w"};

// Functions of the place without operands.
struct Pattern {
  std::string_view type;
  TextureKind kind;
};
constexpr Pattern patterns[] = {{"coordinate", TextureKind::coordinate},
                                {"facing", TextureKind::facing},
                                {"dots", TextureKind::dots},
                                {"fbm", TextureKind::fbm},
                                {"wrinkled", TextureKind::wrinkled},
                                {"windy", TextureKind::windy},
                                {"marble", TextureKind::marble}};
constexpr std::string_view channel_names[] = {"average", "red", "green", "blue", "alpha"};

TextureId add_texture(SceneContext& context, const Texture& texture) {
  context.scene.textures.push_back(texture);
  return static_cast<TextureId>(context.scene.textures.size() - 1);
}

std::optional<TextureId> named_texture(SceneContext& context, const Json::Value& value) {
  const std::string name = context.reader.text(value, "texture");
  if (name.empty()) return std::nullopt;
  const auto known = context.textures.find(name);
  if (known != context.textures.end()) return known->second;
  const bool is_own = context.texture_being_read == name;
  context.reader.error(value,
                       fmt::format("{} texture '{}'{}", is_own ? "a texture cannot be part of itself:" : "unknown",
                                   printable_text(name), did_you_mean_key(name, context.textures)));
  return std::nullopt;
}

class TextureReader {
 public:
  TextureReader(SceneContext& context, const JsonObject& object)
      : context_(context), reader_(context.reader), object_(object) {}

  TextureId read() {
    for (const Pattern& known : patterns)
      if (object_.type() == known.type) return pattern(known.kind);
    texture_.is_number = object_.knows("number") && object_.boolean("number", false) ? 1 : 0;
    if (object_.type() == "constant") {
      value();
    } else if (object_.type() == "image") {
      image();
    } else if (object_.type() == "checkerboard") {
      texture_.kind = TextureKind::checkerboard;
      texture_.a = operand("a", texture_.is_number != 0, 1);
      texture_.b = operand("b", texture_.is_number != 0, 0);
      mapping();
    } else if (object_.type() == "square_root") {
      texture_.kind = TextureKind::square_root;
      texture_.is_number = 1;
      texture_.a = operand("a", true, 0);
    } else if (object_.type() == "scale") {
      texture_.kind = TextureKind::scale;
      texture_.a = operand("a", texture_.is_number != 0, 1);
      texture_.b = operand("b", true, 1);
    } else {
      texture_.kind = TextureKind::mix;
      texture_.a = operand("a", texture_.is_number != 0, 0);
      texture_.b = operand("b", texture_.is_number != 0, 1);
      texture_.amount = operand("amount", true, 0.5);
    }
    return add_texture(context_, texture_);
  }

 private:
  void value() {
    if (!object_.has("value")) return;  // reported
    if (texture_.is_number != 0)
      texture_.value = object_.number_f("value", any_number, 0);
    else
      texture_.spectrum = read_spectrum(context_, *object_.find("value"), "value", Quantity::reflectance);
  }

  // A texture by {"texture": name}, or a value that is the same everywhere.
  TextureId operand(std::string_view key, bool is_number, double fallback) {
    Texture constant;
    constant.is_number = is_number ? 1 : 0;
    const Json::Value* given = object_.find(key);
    if (given != nullptr && is_texture(*given)) {
      if (const auto id = read_texture_reference(context_, *given, is_number)) return *id;
    } else if (is_number) {
      constant.value = object_.number_f(key, any_number, static_cast<float>(fallback));
    } else {
      constant.spectrum = given != nullptr ? read_spectrum(context_, *given, key, Quantity::reflectance)
                                           : context_.scene.spectra.add_constant(fallback).id;
    }
    return add_texture(context_, constant);
  }

  TextureId pattern(TextureKind kind) {
    using Kind = TextureMapping::Kind;
    texture_.kind = kind;
    texture_.is_number = kind != TextureKind::marble;
    const bool has_coordinates = kind == TextureKind::coordinate || kind == TextureKind::dots;
    texture_.mapping.kind = has_coordinates || kind == TextureKind::facing ? Kind::uv : Kind::point;
    if (kind == TextureKind::facing) {
      numbers("direction", any_number, texture_.axis_direction);
      return add_texture(context_, texture_);
    }
    mapping();
    if (kind == TextureKind::coordinate) texture_.axis = static_cast<uint32_t>(object_.choice("axis", axis_names, 0));
    if (kind == TextureKind::fbm || kind == TextureKind::wrinkled || kind == TextureKind::marble) {
      texture_.octaves = object_.integer("octaves", 0, most_texture_octaves, texture_.octaves);
      texture_.roughness = object_.number_f("roughness", any_number, texture_.roughness);
    }
    if (kind == TextureKind::marble) {
      texture_.scale = object_.number_f("scale", any_number, texture_.scale);
      texture_.variation = object_.number_f("variation", any_number, texture_.variation);
    }
    return add_texture(context_, texture_);
  }

  template <size_t N>
  static void store(const std::array<double, N>& from, float* to) {
    for (size_t i = 0; i < N; ++i) to[i] = static_cast<float>(from[i]);
  }
  void numbers(std::string_view key, const Range& range, float (&out)[3]) {
    std::array<double, 3> read{out[0], out[1], out[2]};
    if (object_.has(key) && reader_.numbers(*object_.find(key), key, range, read)) store(read, out);
  }

  void mapping() {
    using Kind = TextureMapping::Kind;
    const Json::Value* value = object_.find("mapping");
    if (value == nullptr) return;
    const JsonObject object(reader_, *value, "mapping");
    if (!object.is_valid()) return;
    TextureMapping mapping;
    mapping.kind = object.type() == "uv"            ? Kind::uv
                   : object.type() == "spherical"   ? Kind::spherical
                   : object.type() == "cylindrical" ? Kind::cylindrical
                   : object.type() == "planar"      ? Kind::planar
                                                    : Kind::point;
    const auto pair = [&](std::string_view key, float& u, float& v) {
      std::array<double, 2> read{u, v};
      if (object.has(key) && reader_.numbers(*object.find(key), key, any_number, read)) {
        u = static_cast<float>(read[0]);
        v = static_cast<float>(read[1]);
      }
    };
    const auto axis = [&](std::string_view key, float(&out)[3]) {
      std::array<double, 3> read{};
      if (object.has(key) && reader_.numbers(*object.find(key), key, any_number, read)) store(read, out);
    };
    const bool is_uv = mapping.kind == Kind::uv, is_planar = mapping.kind == Kind::planar;
    if (is_uv) pair("scale", mapping.u_scale, mapping.v_scale);
    if (is_uv || is_planar) pair("offset", mapping.u_offset, mapping.v_offset);
    if (is_planar) axis("u_axis", mapping.u_axis);
    if (is_planar) axis("v_axis", mapping.v_axis);
    if (!is_uv && object.has("to_texture")) rows(*object.find("to_texture"), mapping.to_texture);
    texture_.mapping = mapping;
  }

  void rows(const Json::Value& value, float (&matrix)[12]) {
    if (!value.isArray() || value.size() != 3)
      return reader_.expected(value, "to_texture", "three rows of four numbers");
    for (Json::ArrayIndex row = 0; row < 3; ++row) {
      std::array<double, 4> read{};
      if (reader_.numbers(value[row], "to_texture", any_number, read)) store(read, matrix + 4 * row);
    }
  }

  void image() {
    texture_.kind = TextureKind::image;
    texture_.wrap = static_cast<TextureWrap>(object_.choice("wrap", wrap_names, 0));
    texture_.filter = static_cast<TextureFilter>(
        object_.choice("filter", filter_names, static_cast<size_t>(TextureFilter::anisotropic)));
    texture_.most_anisotropy = object_.number_f("anisotropy", at_least_one, 8);
    if (object_.has("anisotropy") && texture_.filter != TextureFilter::anisotropic)
      reader_.error(*object_.find("anisotropy"), "'anisotropy' goes with the filter 'anisotropic' only");
    texture_.channel = static_cast<TextureChannel>(object_.choice("channel", channel_names, 0));
    if (object_.has("channel") && texture_.is_number == 0)
      reader_.error(*object_.find("channel"), "'channel' goes with 'number' only: reflectances have all colours");
    texture_.invert = object_.boolean("invert", false) ? 1 : 0;
    texture_.scale = object_.number_f("scale", any_number, 1);
    mapping();
    texture_.image = shared_image().value_or(0);
  }

  // 0: sRGB, else the exponent.
  double gamma() {
    double gamma = 0;
    const Json::Value* value = object_.find("encoding");
    if (value == nullptr) return gamma;
    if (value->isNumeric() && !value->isBool()) {
      gamma = reader_.number(*value, "encoding", positive, 1);
    } else if (value->isString() && value->asString() == "linear") {
      gamma = 1;
    } else if (!value->isString() || value->asString() != "srgb") {
      reader_.expected(*value, "encoding", "'srgb', 'linear' or the exponent of a power");
    }
    return gamma;
  }

  std::optional<ImageId> shared_image() {
    const double exponent = gamma();
    std::optional<ColorSpace> space;  // the file's own where it is not given
    if (object_.has("space")) space = static_cast<ColorSpace>(object_.choice("space", color_space_names(), 0));
    if (!object_.has("image")) return std::nullopt;  // reported
    const auto id = read_shared_image(context_, *object_.find("image"), "image", exponent, space);
    if (id && texture_.channel == TextureChannel::alpha && !context_.scene.images[*id].file_has_alpha)
      reader_.error(*object_.find("channel"), "the image has no alpha, or one that is 1 everywhere");
    return id;
  }

  SceneContext& context_;
  const JsonReader& reader_;
  const JsonObject& object_;
  Texture texture_;
};

}  // namespace

bool is_texture(const Json::Value& value) { return value.isObject() && value.isMember("texture"); }

std::optional<TextureId> read_texture_reference(SceneContext& context, const Json::Value& value, bool is_number) {
  const JsonObject object(context.reader, value, *find_object_spec("texture_reference"), "a texture's name");
  if (!object.is_valid() || !object.has("texture")) return std::nullopt;
  const auto id = named_texture(context, *object.find("texture"));
  if (!id || (context.scene.textures[*id].is_number != 0) == is_number) return id;
  context.reader.error(*object.find("texture"), fmt::format("the texture is one of {}; expected one of {}",
                                                            is_number ? "reflectances" : "numbers",
                                                            is_number ? "numbers ('number')" : "reflectances"));
  return std::nullopt;
}

void read_textures(SceneContext& context, const Json::Value& textures) {
  if (!textures.isObject()) {
    context.reader.expected(textures, "textures", "an object of named textures");
    return;
  }
  for (const auto& [name, value] : members_in_order(textures)) {
    const JsonObject object(context.reader, *value, "texture");
    if (!object.is_valid()) continue;
    context.texture_being_read = name;
    const TextureId id = TextureReader(context, object).read();
    context.textures[name] = id;
  }
  context.texture_being_read.clear();
}

}  // namespace metamer
