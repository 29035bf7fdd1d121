// The file's "textures", and the components' parameters that may be one.
#include <fmt/format.h>

#include "scenes/images/read_image.h"
#include "scenes/native/components.h"
#include "scenes/native/spectra.h"

namespace metamer {
namespace {

// In the order of the enumerations.
constexpr std::string_view wrap_names[] = {"repeat", "clamp", "black"};
constexpr std::string_view filter_names[] = {"linear", "nearest"};

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
    texture_.is_number = object_.boolean("number", false) ? 1 : 0;
    if (object_.type() == "constant") {
      value();
    } else if (object_.type() == "image") {
      image();
    } else if (object_.type() == "checkerboard") {
      texture_.kind = TextureKind::checkerboard;
      texture_.a = operand("a", texture_.is_number != 0, 1);
      texture_.b = operand("b", texture_.is_number != 0, 0);
      mapping();
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

  void mapping() {
    const Json::Value* value = object_.find("uv");
    if (value == nullptr) return;
    const JsonObject uv(reader_, *value, *find_object_spec("uv"), "uv");
    std::array<double, 2> scale{1, 1}, offset{0, 0};
    if (uv.has("scale")) reader_.numbers(*uv.find("scale"), "scale", any_number, scale);
    if (uv.has("offset")) reader_.numbers(*uv.find("offset"), "offset", any_number, offset);
    texture_.mapping = {static_cast<float>(scale[0]), static_cast<float>(scale[1]), static_cast<float>(offset[0]),
                        static_cast<float>(offset[1])};
  }

  void image() {
    texture_.kind = TextureKind::image;
    texture_.wrap = static_cast<TextureWrap>(object_.choice("wrap", wrap_names, 0));
    texture_.nearest = static_cast<uint32_t>(object_.choice("filter", filter_names, 0));
    texture_.invert = object_.boolean("invert", false) ? 1 : 0;
    texture_.scale = object_.number_f("scale", any_number, 1);
    mapping();
    texture_.image = shared_image().value_or(0);
  }

  // 0: sRGB, else the exponent.
  ImageEncoding encoding() {
    ImageEncoding encoding;
    const Json::Value* value = object_.find("encoding");
    if (value == nullptr) return encoding;
    if (value->isNumeric() && !value->isBool()) {
      encoding.gamma = reader_.number(*value, "encoding", positive, 1);
    } else if (value->isString() && value->asString() == "linear") {
      encoding.gamma = 1;
    } else if (!value->isString() || value->asString() != "srgb") {
      reader_.expected(*value, "encoding", "'srgb', 'linear' or the exponent of a power");
    }
    return encoding;
  }

  // Decoded once for each encoding and colour space.
  std::optional<ImageId> shared_image() {
    const ImageEncoding decoded = encoding();
    const auto space = static_cast<ColorSpace>(object_.choice("space", color_space_names(), 0));
    if (!object_.has("image")) return std::nullopt;  // reported
    const Json::Value& value = *object_.find("image");
    const std::string file = reader_.text(value, "image");
    if (file.empty()) return std::nullopt;
    const std::string path = resolve_path(file, reader_.document().path());
    const auto [known, is_new] = context_.images.try_emplace({path, decoded.gamma, space}, std::nullopt);
    if (!is_new) return known->second;
    Image image;
    if (!read_image(path, reader_.document().at(value), image, reader_.diagnostics(), decoded)) return std::nullopt;
    image.color_space = space;
    context_.scene.images.push_back(std::move(image));
    return known->second = static_cast<ImageId>(context_.scene.images.size() - 1);
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
